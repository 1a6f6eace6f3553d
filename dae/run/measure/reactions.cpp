#include <momenta/core/kernel/accelerations.h>
#include <momenta/dae/mechanism/joint_places.h>
#include <momenta/dae/mechanism/loop/loop_rows.h>
#include <momenta/dae/run/measure/reactions.h>

#include <algorithm>
#include <optional>

namespace momenta {
namespace {

/// From sweep axes of body k (the plane's own in the plane, the body's in space) to ground axes.
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

/// The point `at`, in the tree's frame of body k, in ground axes.
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

/// The wrench F on body k about its model origin, moved to `at`, tree's frame.
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
class Sweep final : public WrenchSweep {
 public:
  using Force = typename Space::template Force<double>;

  Sweep(const Mechanism& mechanism, Model<Space> model)
      : mechanism_(mechanism),
        model_(std::move(model)),
        w_(model_),
        places_(joint_places(mechanism)),
        lambda_(static_cast<std::size_t>(mechanism.m())),
        unused_(static_cast<std::size_t>(mechanism.nv())) {
    if (mechanism.m() == 0) return;
    loop_model_ = build_loops(mechanism.scene(), mechanism.tree(), model_);
    loops_.emplace(loop_model_, w_);
    take_couplers();
  }

  void move(double t, const double* q, const double* u, const double* udot,
            const double* lambda) override {
    poses_outward(w_, t, q, true);
    velocities_outward(w_, u);
    accelerations_outward(w_, u, udot);
    if (model_.has_gravity) gravity_outward(w_);
    apply_forces(w_, model_.has_body_forces());
    std::copy_n(lambda, lambda_.size(), lambda_.begin());
    if (loops_) {
      loops_->place(t, q);
      loops_->add_wrenches(lambda_.data(), -1.0, [](auto& body) -> Force& { return body.T; });
    }
    newton_euler_inward(w_, q, u, unused_.data());
  }

  void efforts(double* by_drive) const override {
    for (std::size_t k = 0; k < model_.bodies.size(); ++k) {
      const auto& b = model_.bodies[k];
      if (b.drive < 0) continue;
      double& effort = by_drive[b.drive];
      Joint<Space>::project(b, w_.body[k].edge, w_.body[k].P, &effort);
    }
    for (const Coupled& c : coupled_) by_drive[c.drive] += c.ratio * lambda_[c.row];
  }

  double prescribed_power() const override {
    double power = 0;
    for (std::size_t k = 0; k < model_.bodies.size(); ++k) {
      typename Space::template Motion<double> prescribed{};
      add_drive<Space, double>(model_.bodies[k], w_.body[k], prescribed);
      power += Space::power(w_.body[k].P, prescribed);
    }
    return power;
  }

  Reactions reactions() override {
    const Tree& tree = mechanism_.tree();
    const Scene& scene = mechanism_.scene();
    Reactions all;
    for (std::size_t i = 0; i < scene.loops.size(); ++i) {
      const auto& l = loop_model_.loops[i];
      if (l.is_coupler()) {  // acts on bodies through their joints alone
        const Eigen::Vector3d none = Eigen::Vector3d::Zero();
        all.loops.push_back({scene.loops[i].name, none, none, none});
        continue;
      }
      Force on_child{};
      for (int row = 0; row < l.rows; ++row) {
        Force a, b;
        loops_->unit_wrench(i, row, a, b);
        for (int j = 0; j < Space::dimension; ++j)
          on_child[j] -= lambda_[static_cast<std::size_t>(l.row + row)] * a[j];
      }
      all.loops.push_back(transmitted(scene.loops[i].name, w_, l.a,
                                      tree.point(l.a, scene.loops[i].origin_child), on_child));
    }
    for (const JointPlace& joint : places_)
      all.joints.push_back(transmitted(joint.name, w_, joint.body, Eigen::Vector3d::Zero(),
                                       w_.body[static_cast<std::size_t>(joint.body)].P));
    return all;
  }

 private:
  struct Coupled {
    int drive;
    std::size_t row;
    double ratio;
  };
  void take_couplers() {
    const Tree& tree = mechanism_.tree();
    for (std::size_t i = 0; i < mechanism_.scene().loops.size(); ++i) {
      const LoopSpec& spec = mechanism_.scene().loops[i];
      if (spec.kind != LoopKind::coupler) continue;
      for (std::size_t j = 0; j < spec.joints.size(); ++j) {
        const int k =
            tree.part_of(spec.joints[j], spec.coordinates.empty() ? 0 : spec.coordinates[j]);
        if (const int drive = tree.bodies[static_cast<std::size_t>(k)].drive; drive >= 0)
          coupled_.push_back(
              {drive, static_cast<std::size_t>(loop_model_.loops[i].row), spec.ratios[j]});
      }
    }
  }

  const Mechanism& mechanism_;
  Model<Space> model_;
  Workspace<Space, double> w_;
  LoopModel<Space> loop_model_;
  std::optional<LoopRows<Space, double>> loops_;
  std::vector<JointPlace> places_;
  std::vector<Coupled> coupled_;
  std::vector<double> lambda_, unused_;
};

}  // namespace

Reactions reactions(const Mechanism& mechanism, double t, const Eigen::VectorXd& q,
                    const Eigen::VectorXd& u, const Eigen::VectorXd& udot,
                    const Eigen::VectorXd& lambda) {
  if (const auto& lagrangian = mechanism.scene().lagrangian) {  // loops of a Lagrangian act on no
                                                                // body
    Reactions all;
    const Eigen::Vector3d none = Eigen::Vector3d::Zero();
    for (const auto& c : lagrangian->constraints) all.loops.push_back({c.name, none, none, none});
    return all;
  }
  const auto sweep = make_wrench_sweep(mechanism);
  sweep->move(t, q.data(), u.data(), udot.data(), lambda.data());
  return sweep->reactions();
}

std::unique_ptr<WrenchSweep> make_wrench_sweep(const Mechanism& mechanism) {
  const Tree& tree = mechanism.tree();
  const Plan& plan = mechanism.plan();
  if (plan.planar)
    return std::make_unique<Sweep<Planar>>(mechanism,
                                           build_planar_model(tree, mechanism.scene(), plan.basis));
  return std::make_unique<Sweep<Spatial>>(mechanism, build_spatial_model(tree, mechanism.scene()));
}

void mark_undetermined(Reactions& all, const Mechanism& mechanism, double t,
                       const Eigen::VectorXd& q, const Eigen::MatrixXd& idle, double rounding) {
  // Reactions are affine in λ: change by a column of `idle`, at rest.
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
        if (size(i) > rounding * (largest + a[i].force.norm() * length + a[i].torque.norm()))
          marked[i].unique = false;
    };
    mark(all.joints, with.joints, without.joints);
    mark(all.loops, with.loops, without.loops);
  }
}

}  // namespace momenta
