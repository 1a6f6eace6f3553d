#include <momenta/core/expression/formula_text.h>
#include <momenta/core/expression/jumps.h>
#include <momenta/core/scene/formula.h>
#include <momenta/core/text/number_text.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/gradient/law_jumps.h>
#include <momenta/dae/gradient/linear_formulas.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

namespace momenta {
namespace {

using Eigen::VectorXd;

constexpr int pieces = 8, halvings = 24, steep = 10;

/// Whether the derivative of an operation may jump.
bool may_turn(formula::Operation o) {
  using O = formula::Operation;
  return formula::has_corner(o) || o == O::spline || o == O::sqrt || o == O::hypot ||
         o == O::power || o == O::asin || o == O::acos;
}

/// Whether a formula may jump at a moment that depends on the motion (variables of_motion) or on a
/// number that differs in one of the others; with `rates`, its derivatives too; with `points_move`,
/// places of points.
template <class Moves>
bool may_jump(const Expression& formula, Moves&& of_motion, const std::vector<Expression>& others,
              bool rates = false, bool points_move = false) {
  using O = formula::Operation;
  const std::vector<formula::Instruction>& tape = formula.tape();
  const auto differs = [&](std::size_t i) {
    return std::any_of(others.begin(), others.end(), [&](const Expression& other) {
      return other.tape().size() != tape.size() || other.tape()[i].number != tape[i].number;
    });
  };
  std::vector<char> moves(tape.size(), 0);
  bool jumps = false;
  for (std::size_t i = 0; i < tape.size(); ++i) {
    const formula::Instruction& in = tape[i];
    if (in.operation == O::number || in.operation == O::variable) {
      moves[i] = in.operation == O::number ? differs(i) : of_motion(in.a);
      continue;
    }
    const auto of = [&](int k) { return k >= 0 && moves[static_cast<std::size_t>(k)] != 0; };
    moves[i] = of(in.a) || of(in.b) || of(in.c) || (in.operation == O::spline && points_move);
    if (in.operation == O::choice || in.operation == O::sign || in.operation == O::floor)
      jumps |= of(in.a);
    // x / |x|, x (x²)^(−1/2) and the like jump where they divide by zero; if never, in_step() finds
    // no jump.
    if (in.operation == O::divide) jumps |= of(in.b);
    if (in.operation == O::whole_power && in.number < 0) jumps |= of(in.a);
    if (in.operation == O::power) {
      const formula::Instruction& exponent = tape[static_cast<std::size_t>(in.b)];
      if (exponent.operation != O::number || !(exponent.number > 0)) jumps |= moves[i] != 0;
    }
    if (in.operation == O::atan2 || in.operation == O::tan) jumps |= moves[i] != 0;
    if (rates && may_turn(in.operation)) jumps |= moves[i] != 0;
  }
  return jumps;
}
bool may_jump(const Formula& formula, const std::vector<Expression>& others, bool rates = false,
              bool points_move = false) {
  const auto of_motion = [&](int i) {
    return formula.signals[static_cast<std::size_t>(i)].kind != Signal::Kind::time;
  };
  return may_jump(formula.expression, of_motion, others, rates, points_move);
}

/// The same for a force or, with `rates`, an energy in a Lagrangian, whose parameters are
/// variables.
bool may_jump(const std::string& law, const Scene& scene, const std::vector<Scene>& others,
              bool rates = false) {
  AnyNames names;
  const auto of_motion = [&](int i) {
    const std::string& name = names.names[static_cast<std::size_t>(i)];
    for (std::size_t k = 0; k < scene.parameters.size(); ++k)
      if (scene.parameters[k].name == name)
        return std::any_of(others.begin(), others.end(), [&](const Scene& other) {
          return other.parameters[k].value != scene.parameters[k].value;
        });
    return name != "t";
  };
  try {
    return may_jump(Expression(law, names), of_motion, {}, rates);
  } catch (const std::logic_error&) {  // the formula calls functions by points
    return rates;
  }
}

/// Functions by points, which events do not know.
bool calls_points(const Formula& formula) {
  const std::vector<formula::Instruction>& tape = formula.expression.tape();
  return std::any_of(tape.begin(), tape.end(), [](const formula::Instruction& in) {
    return in.operation == formula::Operation::spline;
  });
}

}  // namespace

LawJumps::LawJumps(const Mechanism& mechanism, const std::vector<Scene>& others,
                   bool of_accelerations, std::vector<double> inputs)
    : of_accelerations_(of_accelerations), inputs_(std::move(inputs)) {
  const Scene& scene = mechanism.scene();
  const FormulaReader reader(scene);
  std::vector<FormulaReader> readers;
  for (const Scene& other : others) readers.emplace_back(other);
  std::vector<EventSpec> events;
  const auto watch = [&](const std::string& law, std::string text) {
    events.emplace_back().when.text = std::move(text);
    laws_.push_back("the force by " + reading::in_quotes(law));
  };
  bool whole = false;
  if (scene.lagrangian) {
    const LagrangianSpec& l = *scene.lagrangian;
    for (const LagrangianSpec::Force& force : l.forces)
      if (may_jump(force.value.text, scene, others)) watch(force.value.text, force.value.text);
    whole = !l.forces.empty();
    for (const std::string& energy : {l.lagrangian.text, l.kinetic.text, l.potential.text})
      whole |= !energy.empty() && may_jump(energy, scene, others, true);
  }
  for (std::size_t i = 0; i < scene.forces.size(); ++i) {
    const ForceSpec& force = scene.forces[i];
    // θ of a bushing turns over at half a turn, the direction of a spring at length zero.
    whole |= force.rotational_stiffness != 0 || (force.kind == "spring-damper" && force.rest != 0);
    const bool potential = force.kind == "potential";
    const std::vector<OwnName> own = reader.own_names(force);
    each_formula(force, [&](const std::string& key, const std::string& law) {
      const Formula formula = reader.read(law, own);
      std::vector<Expression> near;
      for (std::size_t k = 0; k < others.size(); ++k) {
        const ForceSpec& its = others[k].forces[i];
        each_formula(its, [&](const std::string& its_key, const std::string& its_law) {
          if (its_key == key)
            near.push_back(readers[k].read(its_law, readers[k].own_names(its)).expression);
        });
      }
      whole |= !potential || may_jump(formula, near, true);
      if (potential) return;
      if (calls_points(formula) || !may_jump(formula, near)) return;
      std::vector<std::string> names;
      for (const Signal& signal : formula.signals) names.push_back(in_words(scene, signal));
      watch(law, formula::text_of(formula.expression.tape(), formula.expression.outputs().front(),
                                  names));
    });
  }
  if (!events.empty()) values_ = std::make_unique<EventValues>(mechanism, events);
  if (whole && mechanism.nv() > 0) {
    evaluation_ = mechanism.evaluation<double>();
    for (const Column& rate : mechanism.rate_columns()) rates_.push_back(rate.name);
  }
  const bool points_move = std::any_of(others.begin(), others.end(), [&](const Scene& other) {
    return !std::equal(scene.functions.begin(), scene.functions.end(), other.functions.begin(),
                       [](const FunctionSpec& a, const FunctionSpec& b) { return a.x == b.x; });
  });
  for (std::size_t i = 0; i < scene.drives.size(); ++i) {
    const std::string& law = scene.drives[i].law;
    if (law_corner(scene.drives[i]).empty()) continue;
    std::vector<Expression> near;
    for (std::size_t k = 0; k < others.size(); ++k)
      near.push_back(readers[k].read_of_time(others[k].drives[i].law).expression);
    if (!may_jump(reader.read_of_time(law), near, true, points_move)) continue;
    drives_.emplace_back(scene.drives[i]);
    for (const char* what : {"the drive by ", "the rate of the drive by "})
      laws_.push_back(what + reading::in_quotes(law));
    if (of_accelerations)
      laws_.push_back("the acceleration of the drive by " + reading::in_quotes(law));
  }
}

namespace {

struct Jump {
  double t, from, to;
  double within;  ///< [s]; 0: not continuous
};

/// A jump of number k of at(t, numbers) in a part of a step. Numbers that are continuous keep 2⁻²⁴
/// of their first change, or that of their steepest place. One that has most of its change in a
/// thousandth of the step is as steep as a jump to methods that see its ends.
template <class At>
std::optional<Jump> jump_in(double from, double to, VectorXd low, VectorXd high, Eigen::Index k,
                            const At& at) {
  const double first = std::abs(high[k] - low[k]);
  std::optional<Jump> found;
  VectorXd middle;
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
    if (i + 1 == steep && std::abs(high[k] - low[k]) > 0.5 * first)
      found = Jump{to, low[k], high[k], to - from};
  }
  if (std::abs(high[k] - low[k]) > 0.01 * first) return Jump{to, low[k], high[k], 0};
  return found;
}

std::string in_words(const std::string& law, const Jump& jump) {
  const std::string by = " from " + compact(jump.from, 3) + " to " + compact(jump.to, 3);
  if (jump.within > 0)
    return "at t = " + compact(jump.t, 6) + " s " + law + " changes" + by + " within " +
           compact(jump.within, 2) +
           " s, in a thousandth of a step; expected one that is less steep, or shorter steps";
  return "at t = " + compact(jump.t, 6) + " s " + law + " jumps" + by +
         ", at a moment that depends on the motion or on what the derivative is by; expected one "
         "that is continuous, as with tanh in the place of sign";
}

}  // namespace

std::string LawJumps::in_step(double t0, double t1, const Motion& motion) {
  std::string found = of_laws(t0, t1, motion);
  return found.empty() && evaluation_ ? of_forces(t0, t1, motion) : found;
}

std::string LawJumps::of_forces(double t0, double t1, const Motion& motion) {
  VectorXd q, u;
  const auto at = [&](double t, VectorXd& f) {
    f.resize(static_cast<Eigen::Index>(rates_.size()));
    if (!motion(t, q, u)) return false;
    evaluation_->place(t, q.data());
    evaluation_->move(u.data());
    evaluation_->joint_forces(q.data(), u.data(), nullptr, nullptr, f.data());
    return f.allFinite();
  };
  const auto is_input = [&](double t) {
    return std::find(inputs_.begin(), inputs_.end(), t) != inputs_.end();
  };
  // Inputs jump between two times next to each other.
  if (t1 - t0 <= 1e-9 * std::abs(t1) && is_input(t0) && is_input(t1)) return "";
  VectorXd before, after;
  if (!at(t0, before) || !at(t1, after)) return "";
  const VectorXd change = (after - before).cwiseAbs();
  VectorXd slope = slopes_;
  if (slope.size() == 0) slope = VectorXd::Zero(change.size());
  slopes_ = change / (t1 - t0);
  VectorXd p(change.size());
  evaluation_->momenta(nullptr, p.data());  // a force that matters changes it
  largest_ = std::max({largest_, before.cwiseAbs().maxCoeff(), after.cwiseAbs().maxCoeff(),
                       p.cwiseAbs().maxCoeff() / std::abs(t1)});
  for (Eigen::Index k = 0; k < change.size(); ++k) {
    if (!(change[k] > 1e-7 * largest_) || change[k] < 2 * slope[k] * (t1 - t0)) continue;
    const auto jump = jump_in(t0, t1, before, after, k, at);
    const auto at_jump = [&](double t) { return std::abs(t - jump->t) <= 1e-6 * (t1 - t0); };
    // A corner at the end of a step is steep in a small part of it, and small itself.
    if (jump && jump->within > 0 && change[k] < 0.01 * largest_) continue;
    // Nor does a step pass the jump from which the motion starts.
    if (jump && !at_jump(t0) && std::none_of(inputs_.begin(), inputs_.end(), at_jump))
      return in_words("the force along " + rates_[static_cast<std::size_t>(k)], *jump);
  }
  return "";
}

std::string LawJumps::of_laws(double t0, double t1, const Motion& motion) {
  if (laws_.empty()) return "";
  const auto count = static_cast<Eigen::Index>(laws_.size());
  const Eigen::Index of_drive = of_accelerations_ ? 3 : 2;
  VectorXd q, u;
  const auto at = [&](double t, VectorXd& f) {
    f.resize(count);
    if (values_) {
      if (!motion(t, q, u)) return false;
      values_->at(t, q, u, f.data());
    }
    Eigen::Index first = count - static_cast<Eigen::Index>(drives_.size()) * of_drive;
    for (const MotionLaw& law : drives_) {
      double second;
      law.evaluate(t, f[first], f[first + 1], second);
      if (of_accelerations_) f[first + 2] = second;
      first += of_drive;
    }
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
    if (const auto jump = jump_in(time(static_cast<int>(most)), time(static_cast<int>(most) + 1),
                                  f[most], f[most + 1], k, at);
        jump && jump->within == 0)
      return in_words(laws_[static_cast<std::size_t>(k)], *jump);
  }
  return "";
}

}  // namespace momenta
