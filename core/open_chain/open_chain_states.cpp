// Many states at once: in lanes of vector registers, shared among threads, or one by one.

#include <momenta/core/kernel/accelerations.h>
#include <momenta/core/kernel/mass_matrix.h>
#include <momenta/core/kernel/place_links.h>
#include <momenta/core/open_chain/open_chain_impl.h>

#include <array>
#include <limits>
#include <stdexcept>

namespace momenta {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

void check_threads(int threads) {
  if (threads < 1)
    throw std::invalid_argument("found " + std::to_string(threads) +
                                " threads for a batch of states, expected 1 or more");
}

}  // namespace

bool OpenChain::rates_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& p,
                                StatesRef qdot, StatesRef pdot, int threads) {
  check_threads(threads);
  expect_size("rates_of_states", "a column of q", q.rows(), nq());
  expect_size("rates_of_states", "a column of p", p.rows(), nv());
  expect_size("rates_of_states", "a column of qdot", qdot.rows(), nq());
  expect_size("rates_of_states", "a column of pdot", pdot.rows(), nv());
  expect_size("rates_of_states", "a row of p", p.cols(), q.cols());
  expect_size("rates_of_states", "a row of qdot", qdot.cols(), q.cols());
  expect_size("rates_of_states", "a row of pdot", pdot.cols(), q.cols());
  if (!std::isfinite(t)) throw std::invalid_argument("rates_of_states: t is not finite");
  const bool all = impl_->visit([&](auto& kernel) {
    const auto stride = q.outerStride();
    if (!kernel.model->has_body_forces() && stride == p.outerStride() &&
        stride == qdot.outerStride() && stride == pdot.outerStride())
      return impl_->batch(
          kernel, t, threads,
          {q.data(), p.data(), qdot.data(), pdot.data(), stride,
           static_cast<std::size_t>(q.cols())},
          [t](BatchSweeps& sweeps, const States& part) { return sweeps.momentum(t, part); });
    Eigen::VectorXd one_qdot(nq()), one_pdot(nv());
    return impl_->one_by_one(q.cols(), [&](Eigen::Index i) {
      const bool ok = rates(t, q.col(i), p.col(i), one_qdot, one_pdot);
      qdot.col(i) = ok ? one_qdot : one_qdot.setConstant(nothing);
      pdot.col(i) = ok ? one_pdot : one_pdot.setConstant(nothing);
      return ok;
    });
  });
  return impl_->told_of_state(all, q, "p", p);
}

bool OpenChain::rates_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& p,
                                const ConstStatesRef& tau, StatesRef qdot, StatesRef pdot,
                                int threads) {
  expect_size("rates_of_states", "a column of tau", tau.rows(), nv());
  expect_size("rates_of_states", "a row of tau", tau.cols(), q.cols());
  if (rates_of_states(t, q, p, qdot, pdot, threads)) {
    pdot += tau;  // u follows from p alone
    if (pdot.allFinite()) return true;
  }
  Eigen::VectorXd one_qdot(nq()), one_pdot(nv());
  const bool all = impl_->one_by_one(q.cols(), [&](Eigen::Index i) {
    const bool ok = rates(t, q.col(i), p.col(i), tau.col(i), one_qdot, one_pdot);
    qdot.col(i) = ok ? one_qdot : one_qdot.setConstant(nothing);
    pdot.col(i) = ok ? one_pdot : one_pdot.setConstant(nothing);
    return ok;
  });
  return impl_->told_of_state(all, q, "p", p, "tau", tau);
}

/// `tau` may be null.
bool OpenChain::Impl::accelerations_of_states(OpenChain& chain, double t, const ConstStatesRef& q,
                                              const ConstStatesRef& rates,
                                              const ConstStatesRef* tau, StatesRef udot,
                                              int threads) {
  const char* call = "accelerations_of_states";
  const int nq = tree.nq, nv = tree.nv;
  check_threads(threads);
  expect_size(call, "a column of q", q.rows(), nq);
  expect_size(call, "a column of u", rates.rows(), nv);
  expect_size(call, "a column of udot", udot.rows(), nv);
  expect_size(call, "a row of u", rates.cols(), q.cols());
  expect_size(call, "a row of udot", udot.cols(), q.cols());
  if (tau) {
    expect_size(call, "a column of tau", tau->rows(), nv);
    expect_size(call, "a row of tau", tau->cols(), q.cols());
  }
  if (!std::isfinite(t)) throw std::invalid_argument("accelerations_of_states: t is not finite");
  const bool all = visit([&](auto& k) {
    const auto stride = q.outerStride();
    if (!k.model->has_body_forces() && stride == rates.outerStride() &&
        stride == udot.outerStride() && (!tau || stride == tau->outerStride()))
      return batch(
          k, t, threads,
          {q.data(), rates.data(), nullptr, udot.data(), stride, static_cast<std::size_t>(q.cols()),
           tau ? tau->data() : nullptr},
          [t](BatchSweeps& sweeps, const States& part) { return sweeps.acceleration(t, part); });
    Eigen::VectorXd one(nv);
    return one_by_one(q.cols(), [&](Eigen::Index i) {
      const bool ok = tau ? chain.accelerations(t, q.col(i), rates.col(i), tau->col(i), one)
                          : chain.accelerations(t, q.col(i), rates.col(i), one);
      udot.col(i) = ok ? one : one.setConstant(nothing);
      return ok;
    });
  });
  return tau ? told_of_state(all, q, "u", rates, "tau", *tau) : told_of_state(all, q, "u", rates);
}

bool OpenChain::accelerations_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& u,
                                        StatesRef udot, int threads) {
  return impl_->accelerations_of_states(*this, t, q, u, nullptr, udot, threads);
}
bool OpenChain::accelerations_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& u,
                                        const ConstStatesRef& tau, StatesRef udot, int threads) {
  return impl_->accelerations_of_states(*this, t, q, u, &tau, udot, threads);
}

// Outputs of a chain beside its motion: energies, sums over bodies, reactions, mass matrix, poses.

namespace {

Eigen::Vector3d vector(const Vec3<double>& v) {
  return {v[0], v[1], v[2]};
}

/// F_K in the scene's axes of body k: the model's frame may be turned about and shifted along the
/// joint's z.
Reaction reaction_of(const Tree::Body& body, const Model<Spatial>& model,
                     const Workspace<Spatial, double>&, std::size_t k,
                     const Spatial::Force<double>& f) {
  const Eigen::Matrix3d to_scene = (model.frames[k] * body.scene_axes).linear().transpose();
  const Eigen::Vector3d force = vector(f.f);
  const Eigen::Vector3d origin = model.frames[k].translation();
  const Eigen::Vector3d torque = vector(f.n) - origin.cross(force);
  return {body.joint, to_scene * force, to_scene * torque};
}
Reaction reaction_of(const Tree::Body& body, const Model<Planar>& model,
                     const Workspace<Planar, double>& w, std::size_t k,
                     const Planar::Force<double>& wrench) {
  const auto& edge = w.body[k].edge;
  const Vec2<double> f = wrench.f;
  const Eigen::Vector3d turned_back(edge.c * f[0] + edge.s * f[1], edge.c * f[1] - edge.s * f[0],
                                    0);
  const Eigen::Matrix3d to_scene =
      (model.frames[k].linear() * body.scene_axes.linear()).transpose();
  return {body.joint, to_scene * turned_back, to_scene * Eigen::Vector3d(0, 0, wrench.n)};
}

}  // namespace

Energies OpenChain::energies(double t, const ConstVectorRef& q, const ConstVectorRef& u) {
  expect_size("energies", "q", q.size(), nq());
  expect_size("energies", "u", u.size(), nv());
  expect_given_finite("energies", impl_->not_a_number, t, {"q", q}, {"u", u});
  const Energies all = impl_->visit([&](auto& kernel) {
    Energies e;
    momenta_from_rates(kernel.w, t, q.data(), u.data(), impl_->p.data());
    poses_outward(kernel.w, t, q.data(), true);
    e.kinetic = kinetic_energy(kernel.w);
    e.potential = potential_energy(kernel.w, q.data());
    e.hamiltonian = impl_->p.dot(u) - e.kinetic + e.potential;
    return e;
  });
  const std::array found{all.kinetic, all.potential, all.hamiltonian};
  expect_found_finite("energies", impl_->not_a_number, found);
  return all;
}

bool OpenChain::centroidal(double t, const ConstVectorRef& q, const ConstVectorRef& p,
                           Centroidal& all) {
  const double* u = impl_->u.data();
  if (!velocities(t, q, p, impl_->u)) return false;
  if (auto* in_space = std::get_if<Kernel<Spatial>>(&impl_->kernel)) {
    all = centroidal_of(centroidal_sums(in_space->w, t, q.data(), u));
  } else {
    if (!impl_->in_space)
      impl_->in_space = std::make_unique<CentroidalSweep>(impl_->tree, *impl_->flat);
    all = (*impl_->in_space)(t, q.data(), u);
  }
  std::string& failure = impl_->not_a_number;
  return (all.mass == 0 || found_finite(failure, all.centre)) &&
         found_finite(failure, all.linear_momentum, all.angular_momentum);
}

std::vector<Reaction> OpenChain::reactions(double t, const ConstVectorRef& q,
                                           const ConstVectorRef& u) {
  expect_size("reactions", "q", q.size(), nq());
  expect_size("reactions", "u", u.size(), nv());
  expect_given_finite("reactions", impl_->not_a_number, t, {"q", q}, {"u", u});
  const std::vector<Reaction> found = impl_->visit([&](auto& kernel) {
    std::vector<Reaction> all;
    Eigen::VectorXd p(nv()), rates(nv()), pdot(nv()), qdot(nq());
    momenta_from_rates(kernel.w, t, q.data(), u.data(), p.data());
    if (!impl_->momentum(kernel, t, q.data(), p.data(), rates.data(), pdot.data())) return all;
    momenta::coordinate_rates(*kernel.model, q.data(), u.data(), qdot.data());
    auto& pass = kernel.reactions.get(*kernel.links);
    pass(t, q.data(), qdot.data(), p.data(), pdot.data());
    poses_outward(kernel.w, t, q.data(), true);
    all.reserve(tree().bodies.size());
    for (std::size_t k = 0; k < tree().bodies.size(); ++k)
      if (tree().carries_scene_body(static_cast<int>(k)))
        all.push_back(reaction_of(tree().bodies[k], *kernel.model, kernel.w, k, pass.reaction(k)));
    return all;
  });
  for (const Reaction& r : found)
    expect_found_finite("reactions", impl_->not_a_number, r.force, r.torque);
  return found;
}

Eigen::MatrixXd OpenChain::mass_matrix(double t, const ConstVectorRef& q) {
  expect_size("mass_matrix", "q", q.size(), nq());
  expect_given_finite("mass_matrix", impl_->not_a_number, t, {"q", q});
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(nv(), nv());
  impl_->visit([&](auto& kernel) {
    poses_outward(kernel.w, t, q.data(), false);
    mass_matrix_inward(kernel.w, [&](int i, int j, double value) { m(i, j) = m(j, i) = value; });
  });
  expect_found_finite("mass_matrix", impl_->not_a_number, m);
  return m;
}

std::vector<Eigen::Isometry3d> OpenChain::poses(double t, const ConstVectorRef& q) {
  expect_size("poses", "q", q.size(), nq());
  expect_given_finite("poses", impl_->not_a_number, t, {"q", q});
  const std::vector<Eigen::Isometry3d> found = impl_->visit([&](auto& kernel) {
    poses_outward(kernel.w, t, q.data(), true);
    std::vector<Eigen::Isometry3d> all;
    for (std::size_t k = 0; k < tree().bodies.size(); ++k)
      all.push_back(pose_of(tree().bodies[k], *kernel.model, kernel.w, k));
    return all;
  });
  for (const Eigen::Isometry3d& pose : found)
    expect_found_finite("poses", impl_->not_a_number, pose.matrix());
  return found;
}

}  // namespace momenta
