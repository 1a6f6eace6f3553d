#include <momenta/core/kernel/coordinate_spring.h>
#include <momenta/core/kernel/signals.h>
#include <momenta/core/kernel/sweeps.h>
#include <momenta/dae/gradient/line_losses.h>

#include <algorithm>
#include <vector>

namespace momenta {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

template <class Space>
class LineLossesOf final : public LineLosses {
  using S = Dual<double, 1>;
  using Body = typename Model<Space>::Body;

 public:
  explicit LineLossesOf(Model<Space> model)
      : model_(std::move(model)), w_(model_), x_(3 * static_cast<std::size_t>(model_.nv)) {
    by_rates_.setZero(model_.nv);
    for (const Body& b : model_.bodies) {
      if (b.nv != 1 || (b.damping == 0 && b.friction == 0 && !b.stop.acts())) continue;
      joints_ = true;
      if (b.is_curved) curved_.push_back(&b);
      by_rates_[b.u] = -b.damping;
    }
    for (const auto& spring : model_.springs)
      if (loses(spring)) springs_.push_back({&spring, 0});
    for (const auto& spring : model_.coordinate_springs)
      if (loses(spring)) sums_.push_back({&spring, 0});
    along_lines_ = !springs_.empty() || !sums_.empty();
  }

  bool along_lines() const { return along_lines_; }
  bool any() const override { return joints_ || along_lines_; }
  bool at_state() const override { return along_lines_ || !curved_.empty(); }

  void at(const VectorXd& q, const VectorXd& u, const VectorXd& b, VectorXd& skew,
          VectorXd& by_u) override {
    for (const Body* joint : curved_)
      by_rates_[joint->u] = joint_force(*joint, S(q[joint->q]), S::variable(u[joint->u], 0)).b[0];
    by_u = by_rates_.cwiseProduct(b);
    skew.setZero(b.size());
    if (!along_lines_) return;
    for (Index i = 0; i < q.size(); ++i) {
      S& x = x_[static_cast<std::size_t>(i)];
      x.a = q[i];
      x.b[0] = u[i];
    }
    poses_outward(w_, S(0.0), x_.data(), true);
    move(b);
    for (auto& [spring, weight] : springs_) {
      const SpringLine<Space, S> line(w_, *spring);
      weight = line.has_direction() ? weight_of(*spring, line.length) : 0;
      if (weight != 0) pull(*spring, line, weight);
    }
    for (auto& [spring, weight] : sums_) {
      S sum = coordinate_stretch(w_, *spring);
      sum.a += spring->rest;
      weight = weight_of(*spring, sum);
      pull(*spring, weight);
    }
    project();
    for (Index i = 0; i < b.size(); ++i) {
      by_u[i] += force(i).a;
      skew[i] = force(i).b[0];
    }
  }

  void along_rates(const VectorXd& du, VectorXd& dQ) override {
    dQ = by_rates_.cwiseProduct(du);
    if (!along_lines_) return;
    move(du);
    for (const auto& [spring, weight] : springs_)
      if (weight != 0) pull(*spring, SpringLine<Space, S>(w_, *spring), weight);
    for (const auto& [spring, weight] : sums_) pull(*spring, weight);
    project();
    for (Index i = 0; i < du.size(); ++i) dQ[i] += force(i).a;
  }

 private:
  template <class Spring>
  struct Weighted {
    const Spring* spring;
    double weight;  ///< F_ṡ at the last state
  };
  template <class Spring>
  static bool loses(const Spring& spring) {
    return spring.damping != 0 || spring.stop.acts();
  }
  /// F_ṡ of s + ε ṡ.
  template <class Spring>
  static double weight_of(const Spring& spring, const S& s) {
    if (!spring.stop.acts()) return spring.damping;
    return spring.damping - stop_force(spring.stop, S(s.a), S::variable(s.b[0], 0)).b[0];
  }
  void move(const VectorXd& rates) {
    S* const u = x_.data() + rates.size();
    for (Index i = 0; i < rates.size(); ++i) u[i] = S(rates[i]);
    velocities_outward(w_, u);
    for (auto& body : w_.body) body.T = {};
  }
  /// w (ṡ − ε …)
  static S tension(double weight, S rate) {
    rate.b[0] = -rate.b[0];
    return weight * rate;
  }
  void pull(const typename Model<Space>::Spring& spring, const SpringLine<Space, S>& line,
            double weight) {
    line.pull(w_, spring, S(tension(weight, line.rate(w_, spring)) / line.length));
  }
  void pull(const typename Model<Space>::CoordinateSpring& spring, double weight) {
    const S pulled = tension(weight, coordinate_stretch_rate(w_, spring));
    for (const auto& term : spring.terms) add_along_joint(w_, term.body, S((-term.ratio) * pulled));
  }
  void project() {
    for (auto& body : w_.body) body.P = body.T;
    project_inward(w_, x_.data() + 2 * model_.nv);
  }
  const S& force(Index i) const { return x_[static_cast<std::size_t>(2 * model_.nv + i)]; }

  Model<Space> model_;
  Workspace<Space, S> w_;
  std::vector<S> x_;  ///< q, u, forces
  bool joints_ = false, along_lines_ = false;
  std::vector<const Body*> curved_;
  VectorXd by_rates_;  ///< the diagonal Q_u of joints
  std::vector<Weighted<typename Model<Space>::Spring>> springs_;
  std::vector<Weighted<typename Model<Space>::CoordinateSpring>> sums_;
};

template <class Space>
std::unique_ptr<LineLosses> made(Model<Space> model) {
  const auto lost = [](const auto& wrench) {
    if constexpr (Space::dimension == 6)
      if (wrench.torque[0] != 0 || wrench.torque[1] != 0 || wrench.torque[2] != 0) return true;
    return wrench.in_body_axes;
  };
  const bool in_time = !model.drives.empty() || !model.laws.empty();
  if (!model.bushings.empty() || !model.formula_forces.empty() ||
      std::any_of(model.wrenches.begin(), model.wrenches.end(), lost))
    return nullptr;
  auto losses = std::make_unique<LineLossesOf<Space>>(std::move(model));
  if (in_time && losses->along_lines()) return nullptr;
  return losses;
}

}  // namespace

std::unique_ptr<LineLosses> make_line_losses(const Mechanism& mechanism) {
  if (mechanism.scene().lagrangian) return nullptr;
  const Tree& tree = mechanism.tree();
  if (mechanism.plan().planar)
    return made(build_planar_model(tree, mechanism.scene(), mechanism.plan().basis));
  return made(build_spatial_model(tree, mechanism.scene()));
}

}  // namespace momenta
