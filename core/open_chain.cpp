#include <momenta/core/kernel/accelerations.h>
#include <momenta/core/kernel/mass_matrix.h>
#include <momenta/core/kernel/momentum_recursion.h>
#include <momenta/core/open_chain.h>

#include <variant>

namespace momenta {
namespace {

template <class Space>
struct Kernel {
  // The workspace points at the model, so both live at one address.
  explicit Kernel(Model<Space> m)
      : model(std::make_unique<Model<Space>>(std::move(m))), w(*model) {}
  std::unique_ptr<Model<Space>> model;
  Workspace<Space, double> w;
};

Eigen::Vector3d vector(const Vec3<double>& v) {
  return {v[0], v[1], v[2]};
}

/// F_K in the scene's axes of body k: the model's frame may be turned and shifted along the joint's
/// z.
Reaction reaction_of(const Tree::Body& body, const Model<Spatial>& model,
                     const Workspace<Spatial, double>& w, std::size_t k) {
  const Eigen::Matrix3d to_scene = (model.frames[k] * body.scene_axes).linear().transpose();
  const Eigen::Vector3d force = vector(w.body[k].P.f);
  const Eigen::Vector3d origin = model.frames[k].translation();
  const Eigen::Vector3d torque = vector(w.body[k].P.n) - origin.cross(force);
  return {body.joint, to_scene * force, to_scene * torque};
}
Reaction reaction_of(const Tree::Body& body, const Model<Planar>& model,
                     const Workspace<Planar, double>& w, std::size_t k) {
  const auto& edge = w.body[k].edge;
  const Vec2<double> f = w.body[k].P.f;
  const Eigen::Vector3d turned_back(edge.c * f[0] + edge.s * f[1], edge.c * f[1] - edge.s * f[0],
                                    0);
  const Eigen::Matrix3d to_scene =
      (model.frames[k].linear() * body.scene_axes.linear()).transpose();
  return {body.joint, to_scene * turned_back, to_scene * Eigen::Vector3d(0, 0, w.body[k].P.n)};
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

  Inside(Tree t, Plan pl, const Scene& scene)
      : tree(std::move(t)),
        plan(std::move(pl)),
        kernel(plan.planar
                   ? decltype(kernel)(Kernel<Planar>(build_planar_model(tree, scene, plan.basis)))
                   : decltype(kernel)(Kernel<Spatial>(build_spatial_model(tree, scene)))),
        u(tree.nv),
        p(tree.nv) {}

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

OpenChain::OpenChain(const Scene& scene, Algebra algebra) {
  Tree tree = checked_tree(scene);
  Plan plan = make_plan(tree, scene, algebra);
  inside_ = std::make_unique<Inside>(std::move(tree), std::move(plan), scene);
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

bool OpenChain::rates(double t, const ConstVectorRef& q, const ConstVectorRef& p, VectorRef qdot,
                      VectorRef pdot) {
  return inside_->visit([&](auto& kernel) {
    const bool ok =
        momentum_recursion(kernel.w, t, q.data(), p.data(), inside_->u.data(), pdot.data());
    if (ok) momenta::coordinate_rates(*kernel.model, q.data(), inside_->u.data(), qdot.data());
    inside_->singular = kernel.w.singular;
    return ok;
  });
}

bool OpenChain::velocities(double t, const ConstVectorRef& q, const ConstVectorRef& p,
                           VectorRef u) {
  return inside_->visit([&](auto& kernel) {
    const bool ok =
        momentum_recursion(kernel.w, t, q.data(), p.data(), u.data(), inside_->p.data());
    inside_->singular = kernel.w.singular;
    return ok;
  });
}

void OpenChain::momenta(double t, const ConstVectorRef& q, const ConstVectorRef& u, VectorRef p) {
  inside_->visit(
      [&](auto& kernel) { momenta_from_rates(kernel.w, t, q.data(), u.data(), p.data()); });
}

bool OpenChain::accelerations(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                              VectorRef udot) {
  return inside_->visit([&](auto& kernel) {
    const bool ok = acceleration_recursion(kernel.w, t, q.data(), u.data(), udot.data());
    inside_->singular = kernel.w.singular;
    return ok;
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
    auto& w = kernel.w;
    std::vector<Reaction> all;
    Eigen::VectorXd udot(nv());
    if (!acceleration_recursion(w, t, q.data(), u.data(), udot.data())) {
      inside_->singular = w.singular;
      return all;
    }
    accelerations_outward(w, u.data(), udot.data());
    apply_forces(w, w.model->has_body_forces());
    newton_euler_inward(w, q.data(), u.data(), inside_->p.data());
    all.reserve(tree().bodies.size());
    for (std::size_t k = 0; k < tree().bodies.size(); ++k)
      all.push_back(reaction_of(tree().bodies[k], *kernel.model, w, k));
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
  return "joint '" + b.joint + "' has no inertia to move: the articulated inertia of body '" +
         b.name + "' along it is not positive";
}

}  // namespace momenta
