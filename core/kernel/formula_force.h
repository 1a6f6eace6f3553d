#pragma once
// Forces given by formulas of signals x: generalised forces along signals,
//
//   Q = Σ factor · y(x) along s,             power factor · y ṡ
//   V(x):  −∂V/∂s along s for every s of x,  V̇ = Σ ∂V/∂s ṡ + ∂V/∂t
//
// Derivatives are tapes (core/expression/gradient.cpp), so that forces have exact derivatives. Like
// motion laws, formulas are computed out of line for single numbers of a level; directions from one
// state as eight derivatives of one evaluation.

#include <momenta/core/expression/evaluate.h>
#include <momenta/core/expression/run_steps.h>
#include <momenta/core/kernel/signals.h>

namespace momenta {

/// Writes the outputs of a formula to `values`; `line` has room for its tape.
template <class S>
void formula_values(const Expression& formula, const S* x, int, S* line, S* values) {
  evaluate(formula, x, line, values);
}

/// The same for `count` variables in doubles, and on Dual8 in plain arrays: value and eight
/// derivatives of each number.
void formula_in_doubles(const Expression& formula, const double* x, double* values);
void formula_in_dual8(const Expression& formula, const double* x, int count, double* values);

/// Scratch of plain doubles for the two functions below: one a thread, as long as the longest
/// formula so far.
double* formula_room(std::size_t size);

template <int W, int L>
void formula_values(const Expression& formula, const Pack<W, L>* x, int count, Pack<W, L>* line,
                    Pack<W, L>* values) {
  if constexpr (W > 1) {
    formula::run_steps(formula.steps(), x, line, values);
  } else {
    const auto n = static_cast<std::size_t>(count);
    const std::size_t outputs = formula.outputs().size();
    double* const room = formula_room(n + outputs);
    for (std::size_t i = 0; i < n; ++i) room[i] = x[i].v;
    formula_in_doubles(formula, room, room + n);
    for (std::size_t i = 0; i < outputs; ++i) values[i] = Pack<W, L>(room[n + i]);
  }
}
template <int W, int L>
void formula_values(const Expression& formula, const Directions<W, L>* x, int count,
                    Directions<W, L>*, Directions<W, L>* values) {
  const auto n = static_cast<std::size_t>(count);
  const std::size_t outputs = formula.outputs().size();
  double* const room = formula_room((n + outputs) * dual8_numbers);
  for (std::size_t i = 0; i < (n + outputs) * dual8_numbers; ++i) room[i] = 0;
  for (std::size_t i = 0; i < n; ++i) spread(x[i], room + i * dual8_numbers);
  formula_in_dual8(formula, room, count, room + n * dual8_numbers);
  for (std::size_t i = 0; i < outputs; ++i) gather(room + (n + i) * dual8_numbers, values[i]);
}

/// Outputs of a formula force at the state. Needs poses, velocities for rates.
template <class Space, class S>
const S* outputs_of(const Workspace<Space, S>& w,
                    const typename Model<Space>::FormulaForce& force) {
  const std::size_t n = force.inputs.size();
  S* const x = w.formulas.data();
  S* const values = x + n;
  for (std::size_t i = 0; i < n; ++i)
    x[i] = signal_value(w, w.model->signals[static_cast<std::size_t>(force.inputs[i])]);
  formula_values(force.formula, static_cast<const S*>(x), static_cast<int>(n),
                 values + force.formula.outputs().size(), values);
  return values;
}

/// Adds the forces of formulas to body[k].T. Needs poses and velocities.
template <class Space, class S>
void add_formula_forces(Workspace<Space, S>& w) {
  for (const auto& force : w.model->formula_forces) {
    const S* const y = outputs_of(w, force);
    for (const auto& act : force.acts)
      add_along_signal(w, w.model->signals[static_cast<std::size_t>(act.signal)],
                       S(act.factor * y[act.output]));
  }
}

/// Σ V [J]. Needs poses.
template <class Space, class S>
S formula_energy(const Workspace<Space, S>& w) {
  S energy{};
  for (const auto& force : w.model->formula_forces)
    if (force.is_potential) energy += outputs_of(w, force)[0];
  return energy;
}

/// Σ |V| + Σ |y| of all acts: size of the forces of formulas, balanced or not [N, N m]. Needs
/// velocities.
template <class Space>
double formula_size(const Workspace<Space, double>& w) {
  double size = 0;
  for (const auto& force : w.model->formula_forces) {
    const double* const y = outputs_of(w, force);
    if (force.is_potential) size += std::abs(y[0]);
    for (const auto& act : force.acts) size += std::abs(y[act.output]);
  }
  return size;
}

/// The first formula force with an output or derivative that is not finite; null: none. Needs
/// velocities.
template <class Space>
const typename Model<Space>::FormulaForce* formula_without_value(
    const Workspace<Space, double>& w) {
  for (const auto& force : w.model->formula_forces) {
    const double* const y = outputs_of(w, force);
    for (std::size_t i = 0; i < force.formula.outputs().size(); ++i)
      if (!std::isfinite(y[i])) return &force;
  }
  return nullptr;
}

/// Power of forces without potential, and ∂V/∂t of those with one [W]. Needs velocities.
template <class Space, class S>
S formula_power(const Workspace<Space, S>& w) {
  S power{};
  for (const auto& force : w.model->formula_forces) {
    const S* const y = outputs_of(w, force);
    if (force.by_time >= 0) power += y[force.by_time];
    if (force.is_potential) continue;
    for (const auto& act : force.acts)
      power += act.factor * y[act.output] *
               signal_rate(w, w.model->signals[static_cast<std::size_t>(act.signal)]);
  }
  return power;
}

}  // namespace momenta
