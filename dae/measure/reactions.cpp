#include <momenta/core/kernel/accelerations.h>
#include <momenta/dae/joint_places.h>
#include <momenta/dae/loop/loop_rows.h>
#include <momenta/dae/measure/reactions.h>

#include <algorithm>

namespace momenta {
namespace {

/// Sweep axes of body k to ground axes: the plane's own in the plane, the body's in space.
Eigen::Vector3d ground_vector(const Workspace<Spatial, double>& w, int k, const Vec3<double>& v) {
  const Vec3<double> g = to_ground(w, k, v);
  return {g[0], g[1], g[2]};
}
Eigen::Vector3d ground_vector(const Workspace<Planar, double>& w, int, const Vec2<double>& v) {
  return w.model->basis.leftCols<2>() * Eigen::Vector2d(v[0], v[1]);
}
Eigen::Vector3d ground_couple(const Workspace<Spatial, double>& w, int k, const Vec3<double>& c) {
  return ground_vector(w, k, c);
}
Eigen::Vector3d ground_couple(const Workspace<Planar, double>& w, int, double c) {
  return w.model->basis.col(2) * c;
}

/// The point `at`, tree's frame of body k, in ground axes.
Eigen::Vector3d ground_point(const Workspace<Spatial, double>& w, int k,
                             const Eigen::Vector3d& at) {
  const Vec3<double> x = point_position(w, k, w.model->point(k, at));
  return {x[0], x[1], x[2]};
}
Eigen::Vector3d ground_point(const Workspace<Planar, double>& w, int k, const Eigen::Vector3d& at) {
  const Vec2<double> x = point_position(w, k, w.model->point(k, at));
  const double height = (w.model->frames[static_cast<std::size_t>(k)] * at).z();
  return w.model->basis * Eigen::Vector3d(x[0], x[1], height);
}

/// The wrench F on body k about its model origin, as one about `at`, a point of the tree's frame.
template <class Space>
Transmitted transmitted(const std::string& name, const Workspace<Space, double>& w, int k,
                        const Eigen::Vector3d& at,
                        const typename Space::template Force<double>& F) {
  Transmitted r;
  r.name = name;
  r.at = ground_point(w, k, at);
  r.force = ground_vector(w, k, F.f);
  const auto arm = from_ground(w, k, to_ground(w, k, w.model->point(k, at)));
  const auto couple = cross(arm, F.f);
  auto n = F.n;
  n -= couple;
  r.torque = ground_couple(w, k, n);
  return r;
}

template <class Space>
Reactions in(const Mechanism& mechanism, const Model<Space>& model, double t,
             const Eigen::VectorXd& q, const Eigen::VectorXd& u, const Eigen::VectorXd& udot,
             const Eigen::VectorXd& lambda) {
  using Force = typename Space::template Force<double>;
  const Tree& tree = mechanism.tree();
  const Scene& scene = mechanism.scene();
  Workspace<Space, double> w(model);
  poses_outward(w, t, q.data(), true);
  velocities_outward(w, u.data());
  accelerations_outward(w, u.data(), udot.data());
  if (model.has_gravity) gravity_outward(w);
  apply_forces(w, model.has_body_forces());

  Reactions all;
  if (mechanism.m() > 0) {
    const LoopModel<Space> loop_model = build_loops(scene, tree, model);
    LoopRows<Space, double> loops(loop_model, w);
    loops.place(t, q.data());
    loops.add_wrenches(lambda.data(), -1.0, [](auto& body) -> Force& { return body.T; });
    for (std::size_t i = 0; i < scene.loops.size(); ++i) {
      const auto& l = loop_model.loops[i];
      if (l.is_coupler()) {  // no body feels it but through its joints
        const Eigen::Vector3d none = Eigen::Vector3d::Zero();
        all.loops.push_back({scene.loops[i].name, none, none, none});
        continue;
      }
      Force on_child{};
      for (int row = 0; row < l.rows; ++row) {
        Force a, b;
        loops.unit_wrench(i, row, a, b);
        for (int j = 0; j < Space::dimension; ++j) on_child[j] -= lambda[l.row + row] * a[j];
      }
      all.loops.push_back(transmitted(scene.loops[i].name, w, l.a,
                                      tree.point(l.a, scene.loops[i].origin_child), on_child));
    }
  }
  Eigen::VectorXd unused(mechanism.nv());
  newton_euler_inward(w, q.data(), u.data(), unused.data());
  for (const JointPlace& joint : joint_places(mechanism))
    all.joints.push_back(transmitted(joint.name, w, joint.body, Eigen::Vector3d::Zero(),
                                     w.body[static_cast<std::size_t>(joint.body)].P));
  return all;
}

}  // namespace

Reactions reactions(const Mechanism& mechanism, double t, const Eigen::VectorXd& q,
                    const Eigen::VectorXd& u, const Eigen::VectorXd& udot,
                    const Eigen::VectorXd& lambda) {
  if (const auto& lagrangian = mechanism.scene().lagrangian) {  // no body feels them
    Reactions all;
    const Eigen::Vector3d none = Eigen::Vector3d::Zero();
    for (const auto& c : lagrangian->constraints) all.loops.push_back({c.name, none, none, none});
    return all;
  }
  const Tree& tree = mechanism.tree();
  const Plan& plan = mechanism.plan();
  if (plan.planar)
    return in(mechanism, build_planar_model(tree, mechanism.scene(), plan.basis), t, q, u, udot,
              lambda);
  return in(mechanism, build_spatial_model(tree, mechanism.scene()), t, q, u, udot, lambda);
}

void mark_undetermined(Reactions& all, const Mechanism& mechanism, double t,
                       const Eigen::VectorXd& q, const Eigen::MatrixXd& idle) {
  // Reactions are affine in λ: what a column of `idle` adds, with nothing moving.
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(mechanism.nv());
  const double length = length_of(mechanism.scene());
  const Reactions without =
      reactions(mechanism, t, q, rest, rest, Eigen::VectorXd::Zero(mechanism.m()));
  for (Eigen::Index k = 0; k < idle.cols(); ++k) {
    const Reactions with = reactions(mechanism, t, q, rest, rest, idle.col(k));
    const auto mark = [&](std::vector<Transmitted>& marked, const std::vector<Transmitted>& a,
                          const std::vector<Transmitted>& b) {
      const auto size = [&](std::size_t i) {
        return (a[i].force - b[i].force).norm() * length + (a[i].torque - b[i].torque).norm();
      };
      double largest = 0;
      for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, size(i));
      for (std::size_t i = 0; i < a.size(); ++i)
        if (size(i) > 1e-9 * (largest + a[i].force.norm() * length + a[i].torque.norm()))
          marked[i].unique = false;
    };
    mark(all.joints, with.joints, without.joints);
    mark(all.loops, with.loops, without.loops);
  }
}

}  // namespace momenta
