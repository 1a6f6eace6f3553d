#include <momenta/core/kernel/accelerations.h>
#include <momenta/core/kernel/levels/open_sweeps.h>
#include <momenta/core/kernel/mass_matrix.h>
#include <momenta/core/kernel/reactions.h>
#include <momenta/core/open_chain.h>

#include <algorithm>
#include <limits>
#include <variant>

namespace momenta {
namespace {

template <class Space>
struct Kernel {
  using Links = decltype(build_links(std::declval<const Model<Space>&>()));
  // Links, sweeps and workspace point at the model, so it stays at one address.
  Kernel(Model<Space> m, int level)
      : model(std::make_unique<Model<Space>>(std::move(m))),
        links(std::make_unique<Links>(build_links(*model))),
        sweeps(make_sweeps(*links, level)),
        w(*model) {}
  std::unique_ptr<Model<Space>> model;
  std::unique_ptr<Links> links;
  std::unique_ptr<OpenSweeps> sweeps;
  using Pass = ReactionPass<Space>;
  std::unique_ptr<Pass> reactions;  ///< made when first asked for
  Workspace<Space, double> w;
};

Eigen::Vector3d vector(const Vec3<double>& v) {
  return {v[0], v[1], v[2]};
}

/// F_K in the scene's axes of body k: the model's frame may be turned and shifted along the joint's
/// z.
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

Eigen::Isometry3d pose_of(const Tree::Body& body, const Model<Spatial>& model,
                          const Workspace<Spatial, double>& w, std::size_t k) {
  Eigen::Isometry3d pose;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) pose.linear()(i, j) = w.body[k].pose.axes(i, j);
  pose.translation() = vector(w.body[k].pose.origin);
  pose.makeAffine();
  return pose * model.frames[k] * body.scene_axes;
}
Eigen::Isometry3d pose_of(const Tree::Body& body, const Model<Planar>& model,
                          const Workspace<Planar, double>& w, std::size_t k) {
  const auto& p = w.body[k].pose;
  Eigen::Isometry3d in_plane = Eigen::Isometry3d::Identity();
  in_plane.linear().topLeftCorner<2, 2>() << p.c, -p.s, p.s, p.c;
  in_plane.translation() << p.origin[0], p.origin[1], 0;
  Eigen::Isometry3d basis = Eigen::Isometry3d::Identity();
  basis.linear() = model.basis;
  return basis * in_plane * model.frames[k] * body.scene_axes;
}

}  // namespace

struct OpenChain::Inside {
  Tree tree;
  Plan plan;
  std::variant<Kernel<Planar>, Kernel<Spatial>> kernel;
  Eigen::VectorXd u, p;  // scratch, nv
  int singular = -1;
  Eigen::Index failed_state = -1;  ///< of the last batch

  Inside(Tree t, Plan pl, const Scene& scene, int level)
      : tree(std::move(t)),
        plan(std::move(pl)),
        kernel(plan.planar
                   ? decltype(kernel)(
                         Kernel<Planar>(build_planar_model(tree, scene, plan.basis), level))
                   : decltype(kernel)(Kernel<Spatial>(build_spatial_model(tree, scene), level))),
        u(tree.nv),
        p(tree.nv) {}

  /// The momentum recursion and its third sweep.
  template <class K>
  bool momentum(K& k, double t, const double* q, const double* momenta, double* rates,
                double* pdot) {
    if (!k.sweeps->momentum(t, q, momenta, rates, pdot)) {
      singular = k.sweeps->stuck();
      return false;
    }
    singular = -1;
    if (k.model->has_body_forces()) {
      body_force_rates(k.w, t, q, static_cast<const double*>(rates));
      for (int i = 0; i < tree.nv; ++i) pdot[i] += k.w.generalised[static_cast<std::size_t>(i)];
    }
    return true;
  }
  template <class K>
  bool acceleration(K& k, double t, const double* q, const double* rates, double* udot) {
    applied_forces(k.w, t, q, rates);
    const bool ok = k.sweeps->acceleration(t, q, rates, k.w.generalised.data(), udot);
    singular = ok ? -1 : k.sweeps->stuck();
    return ok;
  }

  template <class F>
  decltype(auto) visit(F&& f) {
    return kernel.index() == 0 ? f(std::get<0>(kernel)) : f(std::get<1>(kernel));
  }
};

namespace {
Tree checked_tree(const Scene& scene) {
  if (!scene.loops.empty())
    throw SceneError(scene.where(scene.loops.front().at) + "loop '" + scene.loops.front().name +
                     "' closes the tree, but an open chain has no loops");
  return build_tree(scene);
}
}  // namespace

OpenChain::OpenChain(const Scene& scene, Algebra algebra, int level) {
  Tree tree = checked_tree(scene);
  Plan plan = make_plan(tree, scene, algebra);
  const int best = best_level();
  inside_ = std::make_unique<Inside>(std::move(tree), std::move(plan), scene,
                                     level == 0 ? best : std::min(level, best));
}
OpenChain::~OpenChain() = default;
OpenChain::OpenChain(OpenChain&&) noexcept = default;
OpenChain& OpenChain::operator=(OpenChain&&) noexcept = default;

const Tree& OpenChain::tree() const {
  return inside_->tree;
}
const Plan& OpenChain::plan() const {
  return inside_->plan;
}

int OpenChain::level() const {
  return inside_->visit([](auto& kernel) { return kernel.sweeps->level(); });
}

bool OpenChain::rates(double t, const ConstVectorRef& q, const ConstVectorRef& p, VectorRef qdot,
                      VectorRef pdot) {
  return inside_->visit([&](auto& kernel) {
    if (!inside_->plan.quasi_velocities)  // q̇ = u
      return inside_->momentum(kernel, t, q.data(), p.data(), qdot.data(), pdot.data());
    const bool ok =
        inside_->momentum(kernel, t, q.data(), p.data(), inside_->u.data(), pdot.data());
    if (ok) momenta::coordinate_rates(*kernel.model, q.data(), inside_->u.data(), qdot.data());
    return ok;
  });
}

bool OpenChain::rates_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& p,
                                StatesRef qdot, StatesRef pdot) {
  return inside_->visit([&](auto& kernel) {
    const auto count = static_cast<std::size_t>(q.cols());
    inside_->failed_state = -1;
    if (!kernel.model->has_body_forces() && q.outerStride() == p.outerStride() &&
        q.outerStride() == qdot.outerStride() && q.outerStride() == pdot.outerStride()) {
      const bool ok = kernel.sweeps->momentum(
          t, States{q.data(), p.data(), qdot.data(), pdot.data(), q.outerStride(), count});
      inside_->singular = ok ? -1 : kernel.sweeps->stuck();
      if (!ok) inside_->failed_state = static_cast<Eigen::Index>(kernel.sweeps->failed_state());
      return ok;
    }
    // Forces between bodies: state by state.
    bool all = true;
    Eigen::VectorXd one_qdot(nq()), one_pdot(nv());
    for (Eigen::Index i = 0; i < q.cols(); ++i) {
      const Eigen::VectorXd one_q = q.col(i), one_p = p.col(i);
      if (!rates(t, one_q, one_p, one_qdot, one_pdot)) {
        if (all) inside_->failed_state = i;
        all = false;
        one_qdot.setConstant(std::numeric_limits<double>::quiet_NaN());
        one_pdot.setConstant(std::numeric_limits<double>::quiet_NaN());
      }
      qdot.col(i) = one_qdot;
      pdot.col(i) = one_pdot;
    }
    return all;
  });
}

bool OpenChain::velocities(double t, const ConstVectorRef& q, const ConstVectorRef& p,
                           VectorRef u) {
  return inside_->visit([&](auto& kernel) {
    return inside_->momentum(kernel, t, q.data(), p.data(), u.data(), inside_->p.data());
  });
}

bool OpenChain::inverse_mass_times(double t, const ConstVectorRef& q, const ConstVectorRef& x,
                                   VectorRef result) {
  return inside_->visit([&](auto& kernel) {
    inside_->p.setZero();
    if (!kernel.sweeps->momentum(t, q.data(), inside_->p.data(), inside_->u.data(),
                                 inside_->p.data())) {
      inside_->singular = kernel.sweeps->stuck();
      return false;
    }
    kernel.sweeps->inverse_mass_times(x.data(), result.data());
    return true;
  });
}

void OpenChain::momenta(double t, const ConstVectorRef& q, const ConstVectorRef& u, VectorRef p) {
  inside_->visit(
      [&](auto& kernel) { momenta_from_rates(kernel.w, t, q.data(), u.data(), p.data()); });
}

bool OpenChain::accelerations(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                              VectorRef udot) {
  return inside_->visit([&](auto& kernel) {
    return inside_->acceleration(kernel, t, q.data(), u.data(), udot.data());
  });
}

void OpenChain::coordinate_rates(const ConstVectorRef& q, const ConstVectorRef& u,
                                 VectorRef qdot) const {
  inside_->visit([&](auto& kernel) {
    momenta::coordinate_rates(*kernel.model, q.data(), u.data(), qdot.data());
  });
}

Energies OpenChain::energies(double t, const ConstVectorRef& q, const ConstVectorRef& u) {
  return inside_->visit([&](auto& kernel) {
    Energies e;
    momenta_from_rates(kernel.w, t, q.data(), u.data(), inside_->p.data());
    poses_outward(kernel.w, t, q.data(), true);
    e.kinetic = kinetic_energy(kernel.w);
    e.potential = potential_energy(kernel.w, q.data());
    e.hamiltonian = inside_->p.dot(u) - e.kinetic + e.potential;
    return e;
  });
}

std::vector<Reaction> OpenChain::reactions(double t, const ConstVectorRef& q,
                                           const ConstVectorRef& u) {
  return inside_->visit([&](auto& kernel) {
    std::vector<Reaction> all;
    Eigen::VectorXd p(nv()), rates(nv()), pdot(nv()), qdot(nq());
    momenta_from_rates(kernel.w, t, q.data(), u.data(), p.data());
    if (!inside_->momentum(kernel, t, q.data(), p.data(), rates.data(), pdot.data())) return all;
    momenta::coordinate_rates(*kernel.model, q.data(), u.data(), qdot.data());
    if (!kernel.reactions)
      kernel.reactions =
          std::make_unique<typename std::decay_t<decltype(kernel)>::Pass>(*kernel.links);
    (*kernel.reactions)(t, q.data(), qdot.data(), p.data(), pdot.data());
    poses_outward(kernel.w, t, q.data(), true);
    all.reserve(tree().bodies.size());
    for (std::size_t k = 0; k < tree().bodies.size(); ++k)
      all.push_back(
          reaction_of(tree().bodies[k], *kernel.model, kernel.w, k, kernel.reactions->reaction(k)));
    return all;
  });
}

Eigen::MatrixXd OpenChain::mass_matrix(double t, const ConstVectorRef& q) {
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(nv(), nv());
  inside_->visit([&](auto& kernel) {
    poses_outward(kernel.w, t, q.data(), false);
    mass_matrix_inward(kernel.w, [&](int i, int j, double value) { m(i, j) = m(j, i) = value; });
  });
  return m;
}

std::vector<Eigen::Isometry3d> OpenChain::poses(double t, const ConstVectorRef& q) {
  return inside_->visit([&](auto& kernel) {
    poses_outward(kernel.w, t, q.data(), true);
    std::vector<Eigen::Isometry3d> all;
    for (std::size_t k = 0; k < tree().bodies.size(); ++k)
      all.push_back(pose_of(tree().bodies[k], *kernel.model, kernel.w, k));
    return all;
  });
}

std::string OpenChain::failure() const {
  if (inside_->singular < 0) return "";
  const auto& b = inside_->tree.bodies[static_cast<std::size_t>(inside_->singular)];
  const std::string state =
      inside_->failed_state < 0 ? "" : "state " + std::to_string(inside_->failed_state) + ": ";
  return state + "joint '" + b.joint +
         "' has no inertia to move: the articulated inertia of body '" + b.name +
         "' along it is not positive";
}

}  // namespace momenta
