#include <momenta/core/expression/formula_text.h>
#include <momenta/core/scene/formula.h>
#include <momenta/core/text/near_name.h>
#include <momenta/dae/gradient/law_jumps.h>
#include <momenta/dae/text/number_text.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

using Eigen::VectorXd;

constexpr int pieces = 8, halvings = 24;

/// Whether the formula may jump at a moment that the motion, not the time alone, decides on; not
/// where functions by points stand in it.
bool may_jump(const Formula& formula) {
  using O = formula::Operation;
  const std::vector<formula::Instruction>& tape = formula.expression.tape();
  std::vector<char> moves(tape.size(), 0);
  bool jumps = false;
  for (std::size_t i = 0; i < tape.size(); ++i) {
    const formula::Instruction& in = tape[i];
    if (in.operation == O::spline) return false;
    if (in.operation == O::number) continue;
    if (in.operation == O::variable) {
      moves[i] = formula.signals[static_cast<std::size_t>(in.a)].kind != Signal::Kind::time;
      continue;
    }
    const auto of = [&](int k) { return k >= 0 && moves[static_cast<std::size_t>(k)] != 0; };
    moves[i] = of(in.a) || of(in.b) || of(in.c);
    if (in.operation == O::choice || in.operation == O::sign || in.operation == O::floor)
      jumps |= of(in.a);
  }
  return jumps;
}

}  // namespace

LawJumps::LawJumps(const Mechanism& mechanism) {
  const Scene& scene = mechanism.scene();
  if (scene.lagrangian) return;
  const FormulaReader reader(scene);
  std::vector<EventSpec> events;
  for (const ForceSpec& force : scene.forces) {
    if (force.kind == "potential") continue;
    const std::vector<OwnName> own = reader.own_names(force);
    each_formula(force, [&](const std::string&, const std::string& law) {
      const Formula formula = reader.read(law, own);
      if (!may_jump(formula)) return;
      std::vector<std::string> names;
      for (const Signal& signal : formula.signals) names.push_back(in_words(scene, signal));
      EventSpec event;
      event.when.text =
          formula::text_of(formula.expression.tape(), formula.expression.outputs().front(), names);
      events.push_back(std::move(event));
      laws_.push_back(law);
    });
  }
  if (!laws_.empty()) values_ = std::make_unique<EventValues>(mechanism, events);
}

std::string LawJumps::in_step(double t0, double t1, const Motion& motion) {
  const auto count = static_cast<Eigen::Index>(laws_.size());
  VectorXd q, u;
  const auto at = [&](double t, VectorXd& f) {
    f.resize(count);
    if (!motion(t, q, u)) return false;
    values_->at(t, q, u, f.data());
    return f.allFinite();
  };
  std::vector<VectorXd> f(pieces + 1);
  const auto time = [&](int i) { return i == pieces ? t1 : t0 + (t1 - t0) * i / pieces; };
  for (int i = 0; i <= pieces; ++i)
    if (!at(time(i), f[static_cast<std::size_t>(i)])) return "";
  for (Eigen::Index k = 0; k < count; ++k) {
    double largest = 0;
    for (const VectorXd& values : f) largest = std::max(largest, std::abs(values[k]));
    std::size_t most = 0;
    const auto change = [&](std::size_t i) { return std::abs(f[i + 1][k] - f[i][k]); };
    for (std::size_t i = 1; i < pieces; ++i)
      if (change(i) > change(most)) most = i;
    const double first = change(most);
    if (!(first > 1e-9 * largest)) continue;
    double from = time(static_cast<int>(most)), to = time(static_cast<int>(most) + 1);
    VectorXd low = f[most], high = f[most + 1], middle;
    for (int i = 0; i < halvings; ++i) {
      const double half = 0.5 * (from + to);
      if (!(from < half && half < to) || !at(half, middle)) break;
      if (std::abs(middle[k] - low[k]) > std::abs(high[k] - middle[k])) {
        high = middle;
        to = half;
      } else {
        low = middle;
        from = half;
      }
    }
    // Of a continuous force it is 2⁻²⁴ of the first, or that of its steepest place.
    if (std::abs(high[k] - low[k]) > 0.01 * first)
      return "at t = " + compact(to, 6) + " s the force by " +
             reading::in_quotes(laws_[static_cast<std::size_t>(k)]) + " jumps from " +
             compact(low[k], 3) + " to " + compact(high[k], 3) +
             ", at a moment that depends on the motion; expected one that is continuous, as with "
             "tanh in the place of sign";
  }
  return "";
}

}  // namespace momenta
