#include <momenta/core/expression/function_names.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/scene/lagrangian/lagrangian_formulas.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

using reading::in_quotes;

/// q, q̇, t and the parameters by their names.
class LagrangianNames final : public FormulaNames {
 public:
  LagrangianNames(const std::vector<std::string>& names, std::size_t n) : names_(names), n_(n) {}
  std::optional<Meaning> meaning(std::string_view name, std::size_t) override {
    const std::size_t i = find(name);
    if (i == names_.size()) return {};
    return Meaning{static_cast<int>(i), 0};
  }
  std::string expected(std::string_view name) const override {
    const std::size_t dot = name.rfind('.');
    const std::string_view last = dot == name.npos ? "" : name.substr(dot + 1);
    const std::size_t owner = find(name.substr(0, dot));
    if (owner < 2 * n_ && (owner >= n_ ? last == "dot" : last == "ddot" || last == "dotdot"))
      return ", an acceleration, expected coordinates and their rates";
    if (last == "dot" && owner >= 2 * n_ && owner < names_.size())
      return ": " + in_quotes(names_[owner]) +
             (owner == 2 * n_ ? " is the time" : " is a parameter") +
             " and has no rate, expected that of a coordinate: " + names(n_, 2 * n_);
    std::vector<std::string_view> near(names_.begin(), names_.end());
    near.push_back("pi");
    const std::string meant = reading::did_you_mean(name, near);
    return !meant.empty() ? meant : ", expected one of: " + reading::listed(near);
  }
  /// Hint on rates in other notations: "der(x)".
  std::string expected_in_brackets(std::string_view word, std::string_view) const override {
    if (find(word) < names_.size()) return "";
    for (const char* elsewhere : {"dot", "der", "diff", "d", "D", "ddt", "derivative"})
      if (word == elsewhere) return ", expected the rate of a coordinate: " + names(n_, 2 * n_);
    return "";
  }

 private:
  std::size_t find(std::string_view name) const {
    return static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) - names_.begin());
  }
  std::string names(std::size_t from, std::size_t to) const {
    std::vector<std::string_view> some;
    for (std::size_t i = from; i < to; ++i) some.push_back(names_[i]);
    return reading::listed(some);
  }

  const std::vector<std::string>& names_;
  std::size_t n_;
};

/// Whether a number on the tape is not finite: 1/0.
bool has_no_value(const Expression& formula) {
  return std::any_of(formula.tape().begin(), formula.tape().end(), [](const auto& in) {
    return in.operation == formula::Operation::number && !std::isfinite(in.number);
  });
}

/// Reads the formulas of one scene; `who` opens the sentences.
class Reader {
 public:
  Reader(const Scene& scene, LagrangianFormulas& all)
      : scene_(scene), all_(all), n_(static_cast<int>(scene.lagrangian->coordinates.size())) {}

  Expression read(const FormulaSpec& formula, const std::string& who) {
    const std::string told = who + ", " + in_quotes(formula.text) + ": ";
    try {
      LagrangianNames names(all_.names, static_cast<std::size_t>(n_));
      Expression read(formula.text, names);
      if (has_no_value(read))
        throw SceneError(scene_.where(formula.at) + told +
                         "has a part that is infinite or no number whatever its names stand for, "
                         "expected one with values");
      if (read.is_truth())
        throw SceneError(scene_.where(formula.at) + told + "is a comparison, expected a number");
      for (const int v : read.variables())
        if (v > 2 * n_) all_.uses_parameter[static_cast<std::size_t>(v - 2 * n_ - 1)] = true;
      return read;
    } catch (const ExpressionError& e) {
      throw SceneError(scene_.where(reading::place_in(formula.text, formula.at, e.place())) + told +
                       e.what());
    }
  }
  /// A formula of q and t alone.
  Expression of_positions(const FormulaSpec& formula, const std::string& who,
                          const char* expected) {
    Expression read = this->read(formula, who);
    for (const int v : read.variables())
      if (v >= n_ && v < 2 * n_)
        throw SceneError(scene_.where(formula.at) + who + " has the rate " +
                         in_quotes(all_.names[static_cast<std::size_t>(v)]) + " in it, expected " +
                         expected);
    return read;
  }
  /// A formula of something that changes.
  Expression of_event(const FormulaSpec& formula, const std::string& who) {
    Expression read = this->read(formula, who);
    for (const int v : read.variables())
      if (v <= 2 * n_) return read;
    throw SceneError(scene_.where(formula.at) + who + ", " + in_quotes(formula.text) +
                     ", takes nothing that changes, expected t, a coordinate or a rate in it");
  }
  /// A formula without jumps or corners in q̇, where L has no momenta; where a factor of a rate
  /// jumps with q, forces are impulses.
  Expression smooth_in_rates(const FormulaSpec& formula, const std::string& who) {
    using O = formula::Operation;
    Expression read = this->read(formula, who);
    // For each value on the tape: a rate and a coordinate in it, and a coordinate it jumps with;
    // -1: none.
    std::vector<int> rate, place, jump;
    const auto take = [](std::vector<int>& all, const formula::Instruction& in) {
      int taken = -1;
      for (const int of : {in.a, in.b, in.c})
        if (of >= 0) taken = std::max(taken, all[static_cast<std::size_t>(of)]);
      all.push_back(taken);
      return taken;
    };
    for (const formula::Instruction& in : read.tape()) {
      if (in.operation == O::variable) {
        place.push_back(in.a < n_ ? in.a : -1);
        rate.push_back(in.a >= n_ && in.a < 2 * n_ ? in.a : -1);
        jump.push_back(-1);
        continue;
      }
      const int taken = take(rate, in), of_place = take(place, in), with = take(jump, in);
      const bool jumps = in.operation == O::less || in.operation == O::less_equal ||
                         in.operation == O::sign || in.operation == O::floor;
      const bool turns =
          jumps || in.operation == O::abs || in.operation == O::min || in.operation == O::max;
      if (jumps) jump.back() = of_place;
      const bool sums =
          in.operation == O::add || in.operation == O::subtract || in.operation == O::negative;
      const auto numbers = [&](int of) { return of < 0 || is_number(read, of); };
      const bool scales = (in.operation == O::multiply && (numbers(in.a) || numbers(in.b))) ||
                          (in.operation == O::divide && numbers(in.b));
      if (taken >= 0 && with >= 0 && !sums && !scales)
        throw SceneError(scene_.where(formula.at) + who + ": what multiplies the rate " +
                         in_quotes(all_.names[static_cast<std::size_t>(taken)]) +
                         " has an 'if', sign or floor of the coordinate " +
                         in_quotes(all_.names[static_cast<std::size_t>(with)]) +
                         ", expected a formula without jumps there, as with tanh or abs: the "
                         "momenta jump where it does");
      if (!turns || taken < 0) continue;
      const std::string_view name = formula::function_name(in.operation);
      throw SceneError(scene_.where(formula.at) + who + ": its " +
                       in_quotes(name.empty() ? "if" : name) + " turns with the rate " +
                       in_quotes(all_.names[static_cast<std::size_t>(taken)]) +
                       ", expected a formula that is smooth in the rates; friction and the "
                       "like belong to force");
    }
    return read;
  }
  static bool is_number(const Expression& formula, int i) {
    return formula.tape()[static_cast<std::size_t>(i)].operation == formula::Operation::number;
  }
  void expect_equation(const Expression& equation, const LagrangianSpec::Constraint& c,
                       const std::string& who) const {
    if (const std::string_view corner = equation.corner(); !corner.empty())
      throw SceneError(scene_.where(c.equation.at) + who + " has " + in_quotes(corner) +
                       ", where no second derivative may exist; expected a smooth formula");
    const std::vector<int> all = equation.variables();
    if (std::any_of(all.begin(), all.end(), [&](int v) { return v < n_; })) return;
    throw SceneError(scene_.where(c.equation.at) + who +
                     " has no coordinate in it, expected an equation that ties coordinates");
  }

 private:
  const Scene& scene_;
  LagrangianFormulas& all_;
  int n_;
};

}  // namespace

LagrangianFormulas::LagrangianFormulas(const Scene& scene)
    : uses_parameter(scene.parameters.size(), false) {
  const LagrangianSpec& spec = *scene.lagrangian;
  for (const auto& c : spec.coordinates) names.push_back(c.name);
  for (const auto& c : spec.coordinates) names.push_back(rate_name(c.name));
  names.emplace_back("t");
  for (const ParameterSpec& p : scene.parameters) names.push_back(p.name);

  Reader reader(scene, *this);
  if (!spec.lagrangian.text.empty())
    lagrangian = reader.smooth_in_rates(spec.lagrangian, "lagrangian");
  else
    kinetic = reader.smooth_in_rates(spec.kinetic, "kinetic");
  if (!spec.potential.text.empty())
    potential = reader.of_positions(spec.potential, "potential",
                                    "a formula of coordinates and t; what has rates belongs to "
                                    "lagrangian or force");
  for (const auto& f : spec.forces)
    forces.push_back(reader.read(f.value, "force on " + in_quotes(f.coordinate)));
  for (const auto& c : spec.constraints) {
    const std::string who = "constraint " + in_quotes(c.name);
    constraints.push_back(
        reader.of_positions(c.equation, who, "a holonomic equation, of coordinates and t"));
    reader.expect_equation(constraints.back(), c, who);
  }
  for (std::size_t i = 0; i < scene.events.size(); ++i)
    events.push_back(
        reader.of_event(scene.events[i].when, in_quotes(name_of(scene.events[i], i)) + ": when"));
}

}  // namespace momenta
