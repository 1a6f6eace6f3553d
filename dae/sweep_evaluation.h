#pragma once
// The evaluation of a mechanism by sweeps, for one algebra and one scalar. Included only where it
// is instantiated.

#include <momenta/core/kernel/accelerations.h>
#include <momenta/core/kernel/mass_matrix.h>
#include <momenta/core/kernel/momentum_recursion.h>
#include <momenta/core/scalar/power_series.h>
#include <momenta/dae/loop/loop_rows.h>
#include <momenta/dae/mechanism.h>

#include <optional>

namespace momenta {

template <class Space, class S>
class Mechanism::SweepEvaluation final : public Evaluation<S> {
 public:
  SweepEvaluation(const Mechanism& mechanism, const Cast<Space>& cast)
      : model_(cast.model),
        w_(cast.model),
        loops_(cast.loops, w_),
        links_(build_links(cast.model)),
        still_(static_cast<std::size_t>(mechanism.nv())) {
    if (cast.loops.loops.empty()) {
      momentum_.emplace(links_);
      acceleration_.emplace(links_);
    }
    for (const auto& marker : mechanism.scene().markers) {
      const Tree& tree = mechanism.tree();
      const int body = tree.body(marker.body);
      const Eigen::Vector3d at = tree.point(body, marker.point);
      double height = 0;
      if constexpr (Space::dimension == 3)
        height = body < 0 ? model_.basis.col(2).dot(at)
                          : (model_.frames[static_cast<std::size_t>(body)] * at).z();
      markers_.push_back({body, model_.point(body, at), height});
    }
  }

  void place(double t, const S* q) override {
    poses_outward(w_, Moment<S>::at(t), q, true);
    loops_.place(t, q);
    gravity_current_ = false;
  }
  void positions(S* phi) override { loops_.positions(phi); }

  void move(const S* u) override {
    velocities_outward(w_, u ? u : still_.data());
    loops_.move(u);
  }
  void velocities(S* rate) override { loops_.velocities(rate); }

  void momenta(const S* sigma, S* p) override {
    body_momenta(w_);
    if (sigma) loops_.add_wrenches(sigma, 1.0, [](auto& body) -> Force& { return body.P; });
    momenta_inward(w_, p);
    if (sigma) loops_.add_couplings(sigma, 1.0, p);
  }

  void momentum_rates(const S* q, const S* u, const S* sigma, double leak, S* pdot) override {
    apply();
    if (sigma) {
      loops_.add_inertial_rates(sigma);
      if (leak != 0) loops_.add_wrenches(sigma, -leak, [](auto& body) -> Force& { return body.T; });
    }
    momentum_rates_inward(w_, q, u, pdot);
    if (sigma && leak != 0) loops_.add_couplings(sigma, -leak, pdot);
  }

  void joint_forces(const S* q, const S* u, const S* udot, const S* lambda, S* tau) override {
    accelerations_outward(w_, u, udot);
    apply();
    // Φ_qᵀλ stands on the left of (1a): as an applied wrench it is −λ.
    if (lambda) loops_.add_wrenches(lambda, -1.0, [](auto& body) -> Force& { return body.T; });
    newton_euler_inward(w_, q, u, tau);
    if (lambda) loops_.add_couplings(lambda, 1.0, tau);
    loops_.accelerate(udot);
  }
  void accelerations(S* rate) override { loops_.accelerations(rate); }

  void constraint_forces(const S* x, S* result) override {
    for (auto& body : w_.body) body.P = {};
    loops_.add_wrenches(x, 1.0, [](auto& body) -> Force& { return body.P; });
    momenta_inward(w_, result);
    loops_.add_couplings(x, 1.0, result);
  }

  void coordinate_rates(const S* q, const S* u, S* qdot) const override {
    momenta::coordinate_rates(model_, q, u, qdot);
  }
  void joint_rates(const S* q, const S* qdot, S* u) const override {
    for (const auto& b : model_.bodies)
      if (b.nv > 0) momenta::joint_rates(b.kind, q + b.q, qdot + b.q, u + b.u);
  }

  void mass_entries(S* values) override {
    mass_matrix_inward(w_, [&](int, int, const S& value) { *values++ = value; });
  }
  void mass_diagonal(S* values) override { mass_diagonal_inward(w_, values); }
  void constraint_entries(S* values) override {
    each_constraint_entry([&](int, int, const S& value) { *values++ = value; });
  }
  /// Calls entry(row, column, value) for the structural nonzeros of Φ_q: the joints between each
  /// end of a loop and the lowest common ancestor of its bodies; above it the two ends cancel. Of a
  /// coupler its ratios.
  template <class Entry>
  void each_constraint_entry(Entry&& entry) {
    for (std::size_t i = 0; i < loops_.model().loops.size(); ++i) {
      const auto& l = loops_.model().loops[i];
      for (const auto& c : l.joints) entry(l.row, c.u, S(c.ratio));
      for (int row = 0; row < l.rows; ++row) {
        Force on_a, on_b;
        loops_.unit_wrench(i, row, on_a, on_b);
        int a = l.a, b = l.b;
        while (a != b) {
          // The deeper body in depth-first order can't be an ancestor of the other: climb from it.
          int& k = a > b ? a : b;
          Force& f = a > b ? on_a : on_b;
          const auto& body = model_.bodies[static_cast<std::size_t>(k)];
          const auto& edge = w_.body[static_cast<std::size_t>(k)].edge;
          S column[6];
          Joint<Space>::project(body, edge, f, column);
          for (int j = 0; j < body.nv; ++j) entry(l.row + row, body.u + j, column[j]);
          f = Space::to_parent(body.edge, body.kind, edge, f);
          k = body.parent;
        }
      }
    }
  }
  template <class Entry>
  void each_mass_entry(Entry&& entry) {
    mass_matrix_inward(w_, entry);
  }

  bool open_momentum_rates(double t, const S* q, const S* p, S* u, S* pdot) override {
    const bool ok = momentum_recursion(*momentum_, w_, Moment<S>::at(t), q, p, u, pdot);
    stuck_ = ok ? -1 : momentum_->stuck();
    return ok;
  }
  bool open_accelerations(double t, const S* q, const S* u, S* udot) override {
    const bool ok = acceleration_recursion(*acceleration_, w_, Moment<S>::at(t), q, u, udot);
    stuck_ = ok ? -1 : acceleration_->stuck();
    return ok;
  }

  void body_forces(double t, const S* q, const S* u, S* tau) override {
    body_force_rates(w_, Moment<S>::at(t), q, u);
    std::copy(w_.generalised.begin(), w_.generalised.end(), tau);
  }
  void applied_forces(double t, const S* q, const S* u, S* tau, bool at_points) override {
    momenta::applied_forces(w_, Moment<S>::at(t), q, u, at_points);
    std::copy(w_.generalised.begin(), w_.generalised.end(), tau);
  }

  int stuck() const override {
    return stuck_ < 0 ? -1 : model_.bodies[static_cast<std::size_t>(stuck_)].u;
  }

  S kinetic() override { return kinetic_energy(w_); }
  S potential(const S* q) override { return potential_energy(w_, q); }
  S lost_power(const S* u) override {
    // Dampers and body-axes wrenches or torques: all applied power less that of the potentials.
    S power{};
    for (const auto& b : model_.bodies)
      if (b.nv == 1) power -= b.damping * (u[b.u] * u[b.u]);
    if (!model_.has_body_forces()) return power;
    for (const auto& spring : model_.springs) {
      const SpringLine<Space, S> line(w_, spring);
      if (value_of(line.length) == 0) continue;
      const S rate = dot(line.D, point_velocity(w_, spring.child, line.child) -
                                     point_velocity(w_, spring.parent, line.parent)) /
                     line.length;
      power -= spring.damping * (rate * rate);
    }
    for (const auto& wrench : model_.wrenches) {
      const int k = wrench.body;
      const auto omega = angular_velocity(w_, k);
      const auto in_ground = [&](const auto& v) {
        return wrench.in_body_axes ? to_ground(w_, k, v) : to_ground(w_, -1, v);
      };
      if (wrench.in_body_axes)
        power +=
            dot(in_ground(wrench.force), point_velocity(w_, k, point_position(w_, k, wrench.at)));
      if constexpr (Space::dimension == 3)
        power += wrench.normal_torque * omega;
      else
        power += dot(in_ground(wrench.torque), omega);
    }
    return power;
  }

  void markers(S* values) override {
    for (const auto& marker : markers_) {
      const auto x = point_position(w_, marker.body, marker.at);
      const auto v = point_velocity(w_, marker.body, x);
      for (int i = 0; i < 3; ++i) {
        S position{}, velocity{};
        if constexpr (Space::dimension == 3) {
          position = model_.basis(i, 0) * x[0] + model_.basis(i, 1) * x[1] +
                     S(model_.basis(i, 2) * marker.height);
          velocity = model_.basis(i, 0) * v[0] + model_.basis(i, 1) * v[1];
        } else {
          position = x[i];
          velocity = v[i];
        }
        values[i] = position;
        values[3 + i] = velocity;
      }
      values += 6;
    }
  }

 private:
  using Force = typename Space::template Force<S>;
  struct Marker {
    int body;
    typename Space::template Vector<double> at;
    double height;
  };

  void apply() {
    if (model_.has_gravity && !gravity_current_) {
      gravity_outward(w_);
      gravity_current_ = true;
    }
    apply_forces(w_, model_.has_body_forces());
  }

  const Model<Space>& model_;
  Workspace<Space, S> w_;
  LoopRows<Space, S> loops_;
  decltype(build_links(std::declval<const Model<Space>&>())) links_;
  std::optional<MomentumSweeps<Space, S>> momentum_;  ///< mechanisms without loops
  std::optional<AccelerationSweeps<Space, S>> acceleration_;
  int stuck_ = -1;
  std::vector<S> still_;
  std::vector<Marker> markers_;
  bool gravity_current_ = false;
};

template <class S>
std::unique_ptr<Evaluation<S>> Mechanism::evaluation() const {
  if (plan_.planar) return std::make_unique<SweepEvaluation<Planar, S>>(*this, std::get<0>(cast_));
  return std::make_unique<SweepEvaluation<Spatial, S>>(*this, std::get<1>(cast_));
}

}  // namespace momenta
