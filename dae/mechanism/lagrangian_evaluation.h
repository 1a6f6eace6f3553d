#pragma once
// The evaluation of a Lagrangian in doubles: beside the rows of its equations the entries of (7),
// and where it has no constraints (q, p) → (u, ṗ) and (q, u) → u̇ by factors of M.

#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/mechanism/lagrangian_rows.h>
#include <momenta/dae/mechanism/tree_factor.h>

namespace momenta {

class LagrangianEvaluation final : public LagrangianRows<double> {
 public:
  /// `pattern`: the KKT pattern of `model`.
  LagrangianEvaluation(const LagrangianModel& model, const KktPattern& pattern)
      : LagrangianRows(model),
        factor_(pattern, model.n),
        mass_(pattern.mass.size()),
        rest_(size(model.n)),
        diagonal_(size(model.n)) {
    for (std::size_t i = 0; i < pattern.mass.size(); ++i)
      if (pattern.mass[i].row == pattern.mass[i].column) diagonal_[size(pattern.mass[i].row)] = i;
  }

  void mass_entries(double* all) override { mass_values(all); }
  void mass_diagonal(double* all) override {
    mass_values(mass_.data());
    for (std::size_t i = 0; i < diagonal_.size(); ++i) all[i] = mass_[diagonal_[i]];
  }
  void constraint_entries(double* all) override { constraint_values(all); }

  bool open_momentum_rates(double t, const double* q, const double* p, double* u,
                           double* pdot) override {
    place(t, q);
    if (!factorise()) return false;
    std::copy_n(p, model_.n, u);
    if (model_.linear) {
      move(nullptr);
      momenta(nullptr, rest_.data());
      for (std::size_t i = 0; i < rest_.size(); ++i) u[i] -= rest_[i];
    }
    solve(u);
    move(u);
    momentum_rates(q, u, nullptr, 0, pdot);
    return all_finite(u, rest_.size()) && all_finite(pdot, rest_.size());
  }
  bool open_accelerations(double t, const double* q, const double* u, double* udot) override {
    place(t, q);
    if (!factorise()) return false;
    move(u);
    joint_forces(q, u, nullptr, nullptr, udot);
    for (std::size_t i = 0; i < rest_.size(); ++i) udot[i] = (pushed_ ? pushed_[i] : 0) - udot[i];
    solve(udot);
    return all_finite(udot, rest_.size());
  }
  void push(const double* tau) override { pushed_ = tau; }
  int singular_joint() const override { return singular_; }

  /// A Lagrangian has no points of bodies.
  void body_forces(double, const double*, const double*, double* tau) override {
    std::fill_n(tau, model_.n, 0.0);
  }
  double kinetic() override { return value(model_.kinetic); }
  double potential(const double*) override { return value(model_.potential); }
  double dissipated_power(const double*, const double*) override { return value(model_.power); }
  /// Forces of formulas beside those of bodies; a Lagrangian has no others.
  double formula_size() override { return 0; }
  std::string formula_without_value() override { return ""; }
  std::string lost_loop() const override { return ""; }
  void slot_places(double*) const override {}
  void markers(double*) override {}

 private:
  double value(const Expression& formula) {
    double y = 0;
    values(formula, &y);
    return y;
  }
  bool factorise() {
    mass_values(mass_.data());
    singular_ = all_finite(mass_.data(), mass_.size()) ? factor_.factor(mass_) : -1;
    return singular_ < 0 && all_finite(mass_.data(), mass_.size());
  }
  void solve(double* x) {
    factor_.inward(x);
    for (std::size_t i = 0; i < rest_.size(); ++i) x[i] *= factor_.inverse_pivots()[i];
    factor_.outward(x);
  }

  TreeFactor factor_;
  std::vector<double> mass_, rest_;
  std::vector<std::size_t> diagonal_;
  int singular_ = -1;
  const double* pushed_ = nullptr;
};

}  // namespace momenta
