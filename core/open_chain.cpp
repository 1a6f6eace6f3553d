#include <momenta/core/kernel/accelerations.h>
#include <momenta/core/kernel/levels/open_sweeps.h>
#include <momenta/core/kernel/mass_matrix.h>
#include <momenta/core/kernel/reactions.h>
#include <momenta/core/kernel/whole_sums.h>
#include <momenta/core/open_chain.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <variant>

namespace momenta {
namespace {

/// Workspaces of dual numbers, made when a call first needs them.
template <class Pass>
class WhenAsked {
 public:
  template <class Links>
  Pass& get(const Links& links) {
    if (!pass_) pass_ = std::make_unique<Pass>(links);
    return *pass_;
  }

 private:
  std::unique_ptr<Pass> pass_;
};

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
  WhenAsked<ReactionPass<Space>> reactions;
  Workspace<Space, double> w;
};

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

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
  std::optional<Scene> flat;  ///< of a planar kernel: `in_space` is made of it when asked for
  std::unique_ptr<WholeSweep> in_space;
  Eigen::VectorXd u, p;  // scratch, nv
  int singular = -1;
  Eigen::Index failed_state = -1;  ///< of the last batch

  Inside(Tree t, Plan pl, const Scene& from, int level)
      : tree(std::move(t)),
        plan(std::move(pl)),
        kernel(plan.planar
                   ? decltype(kernel)(
                         Kernel<Planar>(build_planar_model(tree, from, plan.basis), level))
                   : decltype(kernel)(Kernel<Spatial>(build_spatial_model(tree, from), level))),
        u(tree.nv),
        p(tree.nv) {
    if (plan.planar) flat = from;
  }

  /// The momentum recursion and its third sweep.
  template <class K>
  bool momentum(K& k, double t, const double* q, const double* momenta, double* rates,
                double* pdot) {
    if (!k.sweeps->momentum(t, q, momenta, rates, pdot)) {
      singular = k.sweeps->stuck();
      return false;
    }
    singular = -1;
    failed_state = -1;
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

  /// What a call on one state left behind.
  template <class K>
  bool noted_one(K& k, bool ok) {
    singular = ok ? -1 : k.sweeps->stuck();
    failed_state = -1;
    return ok;
  }
  /// What a batch left behind.
  template <class K>
  bool noted(K& k, bool ok) {
    singular = ok ? -1 : k.sweeps->stuck();
    failed_state = ok ? -1 : static_cast<Eigen::Index>(k.sweeps->failed_state());
    return ok;
  }
  /// Forces between bodies: state by state.
  template <class F>
  bool one_by_one(Eigen::Index count, F&& f) {
    Eigen::Index failed = -1;
    int stuck = -1;
    for (Eigen::Index i = 0; i < count; ++i)
      if (!f(i) && failed < 0) {
        failed = i;
        stuck = singular;
      }
    failed_state = failed;
    singular = stuck;
    return failed < 0;
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
    const auto stride = q.outerStride();
    if (!kernel.model->has_body_forces() && stride == p.outerStride() &&
        stride == qdot.outerStride() && stride == pdot.outerStride())
      return inside_->noted(
          kernel, kernel.sweeps->momentum(t, {q.data(), p.data(), qdot.data(), pdot.data(), stride,
                                              static_cast<std::size_t>(q.cols())}));
    Eigen::VectorXd one_qdot(nq()), one_pdot(nv());
    return inside_->one_by_one(q.cols(), [&](Eigen::Index i) {
      const bool ok = rates(t, q.col(i), p.col(i), one_qdot, one_pdot);
      if (!ok) one_qdot.setConstant(nothing), one_pdot.setConstant(nothing);
      qdot.col(i) = one_qdot;
      pdot.col(i) = one_pdot;
      return ok;
    });
  });
}

bool OpenChain::accelerations_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& u,
                                        StatesRef udot) {
  return inside_->visit([&](auto& kernel) {
    const auto stride = q.outerStride();
    if (!kernel.model->has_body_forces() && !kernel.model->has_joint_forces &&
        stride == u.outerStride() && stride == udot.outerStride())
      return inside_->noted(
          kernel, kernel.sweeps->acceleration(t, {q.data(), u.data(), nullptr, udot.data(), stride,
                                                  static_cast<std::size_t>(q.cols())}));
    Eigen::VectorXd one(nv());
    return inside_->one_by_one(q.cols(), [&](Eigen::Index i) {
      const bool ok = accelerations(t, q.col(i), u.col(i), one);
      if (!ok) one.setConstant(nothing);
      udot.col(i) = one;
      return ok;
    });
  });
}

bool OpenChain::jacobian_times(double t, const ConstVectorRef& q, const ConstVectorRef& p,
                               const ConstVectorRef& dq, const ConstVectorRef& dp, VectorRef dqdot,
                               VectorRef dpdot) {
  return inside_->visit([&](auto& kernel) {
    return inside_->noted_one(
        kernel, kernel.sweeps->derivative(t, q.data(), p.data(), dq.data(), dp.data(), dqdot.data(),
                                          dpdot.data()));
  });
}

bool OpenChain::jacobian(double t, const ConstVectorRef& q, const ConstVectorRef& p, MatrixRef J) {
  return inside_->visit([&](auto& kernel) {
    return inside_->noted_one(
        kernel, kernel.sweeps->jacobian(t, q.data(), p.data(), J.data(), J.outerStride()));
  });
}
Eigen::MatrixXd OpenChain::jacobian(double t, const ConstVectorRef& q, const ConstVectorRef& p) {
  Eigen::MatrixXd J(nq() + nv(), nq() + nv());
  if (!jacobian(t, q, p, J)) J.resize(0, 0);
  return J;
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

bool OpenChain::whole(double t, const ConstVectorRef& q, const ConstVectorRef& p, Whole& all) {
  const double* u = inside_->u.data();
  if (!velocities(t, q, p, inside_->u)) return false;
  if (auto* in_space = std::get_if<Kernel<Spatial>>(&inside_->kernel)) {
    all = whole_of(whole_sums(in_space->w, t, q.data(), u));
    return true;
  }
  if (!inside_->in_space)
    inside_->in_space = std::make_unique<WholeSweep>(inside_->tree, *inside_->flat);
  all = (*inside_->in_space)(t, q.data(), u);
  return true;
}

std::vector<Reaction> OpenChain::reactions(double t, const ConstVectorRef& q,
                                           const ConstVectorRef& u) {
  return inside_->visit([&](auto& kernel) {
    std::vector<Reaction> all;
    Eigen::VectorXd p(nv()), rates(nv()), pdot(nv()), qdot(nq());
    momenta_from_rates(kernel.w, t, q.data(), u.data(), p.data());
    if (!inside_->momentum(kernel, t, q.data(), p.data(), rates.data(), pdot.data())) return all;
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
  const Tree& t = inside_->tree;
  const auto& b = t.bodies[static_cast<std::size_t>(inside_->singular)];
  const auto& carried = t.bodies[static_cast<std::size_t>(t.carried_by(b.joint))];
  const std::string state =
      inside_->failed_state < 0 ? "" : "state " + std::to_string(inside_->failed_state) + ": ";
  return state + t.joint_in_words(inside_->singular) +
         " has no inertia to move: the articulated inertia of body '" + carried.name +
         "' along it is not positive";
}

}  // namespace momenta
