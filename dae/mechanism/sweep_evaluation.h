#pragma once
// The evaluation of a mechanism in doubles by sweeps, for one algebra: beside the rows of its
// equations the entries of (7), the recursions without loops, energies. Included only where it is
// instantiated.

#include <momenta/core/kernel/mass_matrix.h>
#include <momenta/dae/mechanism/marker_points.h>
#include <momenta/dae/mechanism/sweep_rows.h>

#include <algorithm>
#include <optional>

namespace momenta {

template <class Space>
class Mechanism::SweepEvaluation final : public SweepRows<Space, double> {
  using Rows = SweepRows<Space, double>;
  using Rows::bearings_;
  using Rows::loops_;
  using Rows::model_;
  using Rows::w_;
  using typename Rows::Force;

 public:
  SweepEvaluation(const Mechanism& mechanism, const ModelData<Space>& data)
      : Rows(mechanism, data),
        scene_(mechanism.scene()),
        links_(build_links(data.model)),
        markers_(mechanism.scene(), mechanism.tree(), data.model) {
    if (data.loops.loops.empty()) {
      momentum_.emplace(links_);
      acceleration_.emplace(links_);
    }
  }

  void mass_entries(double* values) override {
    mass_matrix_inward(w_, [&](int, int, double value) { *values++ = value; });
  }
  void mass_diagonal(double* values) override { mass_diagonal_inward(w_, values); }
  void constraint_entries(double* values) override {
    each_constraint_entry([&](int, int, double value) { *values++ = value; });
  }
  /// Calls entry(row, column, value) for the structural nonzeros of Φ_q: the joints between each
  /// end of a loop and the lowest common ancestor of its bodies (above it the two ends cancel), or
  /// the ratios of a coupler.
  template <class Entry>
  void each_constraint_entry(Entry&& entry) {
    for (std::size_t i = 0; i < loops_.model().loops.size(); ++i) {
      const auto& l = loops_.model().loops[i];
      if (l.is_equation()) {
        each_entry_of_equation(l, entry);
        continue;
      }
      for (const auto& c : l.joints) entry(l.row, c.u, loops_.ratio(c));
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
          double column[6];
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

  bool open_momentum_rates(double t, const double* q, const double* p, double* u,
                           double* pdot) override {
    const bool ok = momentum_recursion(*momentum_, w_, t, q, p, u, pdot);
    singular_joint_ = ok ? -1 : momentum_->singular_joint();
    return ok;
  }
  bool open_accelerations(double t, const double* q, const double* u, double* udot) override {
    applied_forces(w_, t, q, u);
    if (pushed_)
      for (std::size_t i = 0; i < w_.generalised.size(); ++i) w_.generalised[i] += pushed_[i];
    const bool ok = (*acceleration_)(t, q, u, w_.generalised.data(), udot);
    singular_joint_ = ok ? -1 : acceleration_->singular_joint();
    return ok;
  }
  void push(const double* tau) override { pushed_ = tau; }

  void bearing_loads(double* forces) override { bearings_.loads(w_, forces); }

  void body_forces(double t, const double* q, const double* u, double* tau) override {
    body_force_rates(w_, t, q, u);
    std::copy(w_.generalised.begin(), w_.generalised.end(), tau);
  }

  std::string lost_loop() const override {
    const int loop = loops_.lost_loop();
    if (loop < 0) return "";
    const auto at = static_cast<std::size_t>(loop);
    const LoopSpec& spec = scene_.loops[at];
    if (spec.kind == LoopKind::rolling)
      return "loop '" + spec.name + "': its wheel lies flat on the plane and touches in no point";
    if (has_equation(spec))
      return "loop '" + spec.name + "': its equation has no value or no derivatives here";
    const bool cam = spec.kind == LoopKind::cam;
    const std::string what =
        loops_.pair_place(at).lost == PairPlace::Lost::no_normal
            ? (cam ? "its outlines have no common normal" : "its point has no foot on the curve")
        : cam ? "its outlines curve alike where they touch, and where the contact goes is not "
                "determined"
              : "its point is at a centre of curvature of the curve";
    return "loop '" + spec.name + "': " + what;
  }
  void slot_places(double* places) const override {
    const auto& model = loops_.model();
    for (std::size_t i = 0; i < model.loops.size(); ++i) {
      const auto& l = model.loops[i];
      places[i] = l.is_pair() && model.pairs[static_cast<std::size_t>(l.pair)]->kind ==
                                     HigherPair::Kind::curve
                      ? loops_.pair_place(i).of_b
                      : std::nan("");
    }
  }

  void limited_lengths(double* lengths) const override {
    for (const auto& spring : model_.springs)
      if (spring.limited) *lengths++ = SpringLine<Space, double>(w_, spring).length;
  }

  int singular_joint() const override {
    return singular_joint_ < 0 ? -1 : model_.bodies[static_cast<std::size_t>(singular_joint_)].u;
  }

  double kinetic() override { return kinetic_energy(w_); }
  double potential(const double* q) override { return potential_energy(w_, q); }
  double dissipated_power(const double* q, const double* u) override {
    // Dampers, friction, stops, body-axes wrenches or torques, formulas: all applied power less
    // that of the potentials, and what potentials gain with time.
    double power = 0;
    for (const auto& b : model_.bodies)
      if (b.nv == 1) {
        power -= b.damping * (u[b.u] * u[b.u]);
        if (b.is_curved)
          power -= b.friction * (u[b.u] * u[b.u] / std::hypot(u[b.u], b.friction_rate)) +
                   (b.stop.acts() ? stop_loss(b.stop, q[b.q], u[b.u]) : 0);
      }
    if (!model_.has_body_forces()) return power;
    power += bushing_power(w_) + coordinate_spring_power(w_) + formula_power(w_);
    for (const auto& spring : model_.springs) {
      const SpringLine<Space, double> line(w_, spring);
      if (!line.has_direction()) continue;
      const double rate = line.rate(w_, spring);
      power -= spring.damping * (rate * rate) +
               (spring.stop.acts() ? stop_loss(spring.stop, line.length, rate) : 0);
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

  std::string formula_without_value() override {
    const auto* found = momenta::formula_without_value(w_);
    if (!found) return "";
    const ForceSpec& force = scene_.forces[static_cast<std::size_t>(found->force)];
    const auto& tape = found->formula.tape();
    const bool root = std::any_of(tape.begin(), tape.end(), [](const formula::Instruction& in) {
      return in.operation == formula::Operation::sqrt || in.operation == formula::Operation::hypot;
    });
    return scene_.where(force.at) +
           (force.name.empty() ? "force of kind '" + force.kind : "force '" + force.name) +
           "': " + found->key + ", or a derivative of it, is not finite at the start" +
           (root ? ", and sqrt and hypot have no slope at 0; expected another start, or "
                   "sqrt(x^2 + e^2) with a small e"
                 : "; expected a start where it has a value");
  }
  double formula_size() override { return momenta::formula_size(w_); }

  void markers(double* values) override { markers_.write(w_, values); }

 private:
  /// Row of an equation: its points' forces carried inward plus its coordinates' ratios.
  template <class Entry>
  void each_entry_of_equation(const typename LoopModel<Space>::Loop& l, Entry&& entry) {
    const auto& equation = *loops_.model().equations[static_cast<std::size_t>(l.equation)];
    inward_.resize(w_.body.size());  // allocates once
    for (const int k : equation.way) inward_[static_cast<std::size_t>(k)] = {};
    loops_.each_point_wrench(
        l, [&](int k, const Force& f) { inward_[static_cast<std::size_t>(k)] += f; });
    for (const int k : equation.way) {
      const auto at = static_cast<std::size_t>(k);
      const auto& body = model_.bodies[at];
      const auto& edge = w_.body[at].edge;
      double column[6];
      Joint<Space>::project(body, edge, inward_[at], column);
      for (const auto& c : l.joints)
        if (c.body == k) column[c.u - body.u] += loops_.ratio(c);
      for (int j = 0; j < body.nv; ++j) entry(l.row, body.u + j, column[j]);
      if (body.parent >= 0)
        inward_[static_cast<std::size_t>(body.parent)] +=
            Space::to_parent(body.edge, body.kind, edge, inward_[at]);
    }
  }
  std::vector<Force> inward_;

  const Scene& scene_;
  decltype(build_links(std::declval<const Model<Space>&>())) links_;
  std::optional<MomentumSweeps<Space, double>> momentum_;  ///< mechanisms without loops
  std::optional<AccelerationSweeps<Space, double>> acceleration_;
  const double* pushed_ = nullptr;
  int singular_joint_ = -1;
  MarkerPoints<Space> markers_;
};

}  // namespace momenta
