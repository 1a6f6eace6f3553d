#include <momenta/dae/chain/closed_chain_inside.h>
#include <momenta/dae/dense_blocks.h>

#include <array>

namespace momenta {

void ClosedChain::momenta(double t, const ConstVectorRef& q, const ConstVectorRef& u, VectorRef p) {
  expect_sizes("momenta", {{"q", q.size()}, {"u", u.size()}, {"p", p.size()}}, {nq(), nv(), nv()});
  expect_given_finite("momenta", inside_->failure, t, {"q", q}, {"u", u});
  inside_->place(t, q, u);
  inside_->e->momenta(nullptr, p.data());
  expect_found_finite("momenta", inside_->failure, p);
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
  expect_given_finite("joint_forces", inside_->failure, t, {"q", q}, {"u", u}, {"udot", udot},
                      {"lambda", lambda});
  inside_->place(t, q, u);
  inside_->e->joint_forces(q.data(), u.data(), udot.data(), m() > 0 ? lambda.data() : nullptr,
                           tau.data());
  expect_found_finite("joint_forces", inside_->failure, tau);
}

void ClosedChain::constraints(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                              VectorRef phi, VectorRef phidot) {
  expect_sizes("constraints",
               {{"q", q.size()}, {"u", u.size()}, {"phi", phi.size()}, {"phidot", phidot.size()}},
               {nq(), nv(), m(), m()});
  expect_given_finite("constraints", inside_->failure, t, {"q", q}, {"u", u});
  inside_->place(t, q, u);
  inside_->e->positions(phi.data());
  inside_->e->velocities(phidot.data());
  expect_found_finite("constraints", inside_->failure, phi, phidot);
}

Eigen::MatrixXd ClosedChain::jacobian(double t, const ConstVectorRef& q) {
  expect_size("jacobian", "q", q.size(), nq());
  expect_given_finite("jacobian", inside_->failure, t, {"q", q});
  inside_->e->place(t, q.data());
  Eigen::MatrixXd found = dense_constraints(inside_->mechanism, *inside_->e);
  expect_found_finite("jacobian", inside_->failure, found);
  return found;
}

Eigen::MatrixXd ClosedChain::mass_matrix(double t, const ConstVectorRef& q) {
  expect_size("mass_matrix", "q", q.size(), nq());
  expect_given_finite("mass_matrix", inside_->failure, t, {"q", q});
  inside_->e->place(t, q.data());
  Eigen::MatrixXd found = dense_mass(inside_->mechanism, *inside_->e);
  expect_found_finite("mass_matrix", inside_->failure, found);
  return found;
}

Energies ClosedChain::energies(double t, const ConstVectorRef& q, const ConstVectorRef& u) {
  Inside& in = *inside_;
  momenta(t, q, u, in.u);
  Energies all;
  all.kinetic = in.e->kinetic();
  all.potential = in.e->potential(q.data());
  all.hamiltonian = in.u.dot(u) - all.kinetic + all.potential;
  const std::array found{all.kinetic, all.potential, all.hamiltonian};
  expect_found_finite("energies", in.failure, found);
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
  expect_given_finite("coordinate_rates", inside_->failure, t, {"q", q}, {"u", u});
  inside_->rates_of_coordinates(t, q.data(), u.data(), qdot.data());
  expect_found_finite("coordinate_rates", inside_->failure, qdot);
}

}  // namespace momenta
