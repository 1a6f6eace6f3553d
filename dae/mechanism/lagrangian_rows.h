#pragma once
// The rows of the equations of a Lagrangian, by its tapes, for one scalar. Included only where it
// is instantiated.

#include <momenta/core/expression/evaluate.h>
#include <momenta/core/scalar/power_series.h>
#include <momenta/core/scene/lagrangian/lagrangian_model.h>
#include <momenta/dae/mechanism/evaluation.h>

#include <algorithm>
#include <vector>

namespace momenta {

template <class S>
class LagrangianRows : public Evaluation<S> {
 public:
  /// Keeps the model by reference.
  explicit LagrangianRows(const LagrangianModel& model)
      : model_(model),
        x_(size(model.variables())),
        line_(longest(model)),
        part_(size(model.n)),
        none_(size(model.n)) {}

  void place(double t, const S* q) override {
    std::copy_n(q, model_.n, x_.begin());
    x_[size(model_.time())] = Moment<S>::at(t);
  }
  void positions(S* phi) override { values(model_.positions, phi); }

  void move(const S* u) override {
    if (!u) u = none_.data();
    std::copy_n(u, model_.n, at(model_.rate(0)));
    std::copy_n(u, model_.n, at(model_.direction(0)));
  }
  void velocities(S* rate) override { values(model_.velocities, rate); }

  void momenta(const S* sigma, S* p) override {
    values(model_.momenta, p);
    if (sigma) add(model_.constraint_forces, sigma, 1.0, p);
  }
  void momentum_rates(const S*, const S*, const S* sigma, double leak, S* pdot) override {
    values(model_.momentum_rates, pdot);
    if (!sigma) return;
    add(model_.constraint_rates, sigma, 1.0, pdot);
    if (leak != 0) add(model_.constraint_forces, sigma, -leak, pdot);
  }

  void joint_forces(const S*, const S*, const S* udot, const S* lambda, S* tau) override {
    std::copy_n(udot ? udot : none_.data(), model_.n, at(model_.acceleration(0)));
    values(model_.joint_forces, tau);
    if (lambda) add(model_.constraint_forces, lambda, 1.0, tau);
  }
  void accelerations(S* rate) override { values(model_.accelerations, rate); }

  void constraint_forces(const S* x, S* result) override {
    std::copy_n(x, model_.m, at(model_.multiplier(0)));
    values(model_.constraint_forces, result);
  }

  void coordinate_rates(const S*, const S* u, S* qdot) const override {
    std::copy_n(u, model_.n, qdot);
  }
  void joint_rates(const S*, const S* qdot, S* u) const override { std::copy_n(qdot, model_.n, u); }

  void applied_forces(double t, const S* q, const S* u, S* tau, bool) override {
    place(t, q);
    move(u);
    values(model_.applied, tau);
  }

  /// Values of M and of Φ_q in the order of their patterns. After place().
  void mass_values(S* all) { values(model_.mass.values, all); }
  void constraint_values(S* all) { values(model_.constraint.values, all); }

 protected:
  static std::size_t size(int n) { return static_cast<std::size_t>(n); }
  void values(const Expression& formula, S* all) {
    evaluate(formula, x_.data(), line_.data(), all);
  }
  const LagrangianModel& model_;

 private:
  typename std::vector<S>::iterator at(int i) { return x_.begin() + i; }
  static std::size_t longest(const LagrangianModel& m) {
    std::size_t all = 0;
    for (const Expression* formula :
         {&m.positions, &m.velocities, &m.accelerations, &m.constraint_forces, &m.constraint_rates,
          &m.momenta, &m.momentum_rates, &m.joint_forces, &m.applied, &m.kinetic, &m.potential,
          &m.power, &m.mass.values, &m.constraint.values})
      all = std::max(all, formula->tape().size());
    return all;
  }
  /// sum += factor times the values of a formula of multipliers.
  void add(const Expression& formula, const S* multipliers, double factor, S* sum) {
    std::copy_n(multipliers, model_.m, at(model_.multiplier(0)));
    values(formula, part_.data());
    for (std::size_t i = 0; i < part_.size(); ++i) sum[i] += factor * part_[i];
  }

  std::vector<S> x_, line_, part_, none_;
};

}  // namespace momenta
