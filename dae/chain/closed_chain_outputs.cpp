#include <momenta/dae/chain/closed_chain_inside.h>
#include <momenta/dae/dense_blocks.h>

namespace momenta {

void ClosedChain::momenta(double t, const ConstVectorRef& q, const ConstVectorRef& u, VectorRef p) {
  expect_sizes("momenta", {{"q", q.size()}, {"u", u.size()}, {"p", p.size()}}, {nq(), nv(), nv()});
  inside_->expect_finite("momenta", t, q, "u", u);
  inside_->place(t, q, u);
  inside_->e->momenta(nullptr, p.data());
  inside_->expect_found_finite("momenta", p.data(), p.size());
}

void ClosedChain::joint_forces(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                               const ConstVectorRef& udot, const ConstVectorRef& lambda,
                               VectorRef tau) {
  expect_sizes("joint_forces",
               {{"q", q.size()},
                {"u", u.size()},
                {"udot", udot.size()},
                {"lambda", lambda.size()},
                {"tau", tau.size()}},
               {nq(), nv(), nv(), m(), nv()});
  inside_->expect_finite("joint_forces", t, q, "u", u);
  if (!inside_->finite("udot", udot) || !inside_->finite("lambda", lambda))
    throw std::invalid_argument("joint_forces: " + failure());
  inside_->place(t, q, u);
  inside_->e->joint_forces(q.data(), u.data(), udot.data(), m() > 0 ? lambda.data() : nullptr,
                           tau.data());
  inside_->expect_found_finite("joint_forces", tau.data(), tau.size());
}

void ClosedChain::constraints(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                              VectorRef phi, VectorRef phidot) {
  expect_sizes("constraints",
               {{"q", q.size()}, {"u", u.size()}, {"phi", phi.size()}, {"phidot", phidot.size()}},
               {nq(), nv(), m(), m()});
  inside_->expect_finite("constraints", t, q, "u", u);
  inside_->place(t, q, u);
  inside_->e->positions(phi.data());
  inside_->e->velocities(phidot.data());
  inside_->expect_found_finite("constraints", phi.data(), m());
  inside_->expect_found_finite("constraints", phidot.data(), m());
}

Eigen::MatrixXd ClosedChain::jacobian(double t, const ConstVectorRef& q) {
  expect_size("jacobian", "q", q.size(), nq());
  inside_->expect_finite("jacobian", t, q, "q", q);
  inside_->e->place(t, q.data());
  Eigen::MatrixXd found = dense_constraints(inside_->mechanism, *inside_->e);
  inside_->expect_found_finite("jacobian", found.data(), found.size());
  return found;
}

Eigen::MatrixXd ClosedChain::mass_matrix(double t, const ConstVectorRef& q) {
  expect_size("mass_matrix", "q", q.size(), nq());
  inside_->expect_finite("mass_matrix", t, q, "q", q);
  inside_->e->place(t, q.data());
  Eigen::MatrixXd found = dense_mass(inside_->mechanism, *inside_->e);
  inside_->expect_found_finite("mass_matrix", found.data(), found.size());
  return found;
}

Energies ClosedChain::energies(double t, const ConstVectorRef& q, const ConstVectorRef& u) {
  Inside& in = *inside_;
  momenta(t, q, u, in.u);
  Energies all;
  all.kinetic = in.e->kinetic();
  all.potential = in.e->potential(q.data());
  all.hamiltonian = in.u.dot(u) - all.kinetic + all.potential;
  const double found[] = {all.kinetic, all.potential, all.hamiltonian};
  in.expect_found_finite("energies", found, 3);
  return all;
}

Reactions ClosedChain::reactions(double t, const ConstVectorRef& q, const ConstVectorRef& u) {
  Eigen::VectorXd udot(nv()), lambda(m());
  if (!accelerations(t, q, u, udot, lambda)) throw std::runtime_error("reactions: " + failure());
  return momenta::reactions(inside_->mechanism, t, q, u, udot, lambda);
}

void ClosedChain::coordinate_rates(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                                   VectorRef qdot) {
  expect_sizes("coordinate_rates", {{"q", q.size()}, {"u", u.size()}, {"qdot", qdot.size()}},
               {nq(), nv(), nq()});
  inside_->expect_finite("coordinate_rates", t, q, "u", u);
  inside_->rates_of_coordinates(t, q.data(), u.data(), qdot.data());
  inside_->expect_found_finite("coordinate_rates", qdot.data(), qdot.size());
}

}  // namespace momenta
