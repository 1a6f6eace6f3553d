#include <momenta/core/lagrangian/lagrangian_formulas.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/text/near_name.h>

#include <algorithm>

namespace momenta {
namespace {

using reading::in_quotes;

/// Reads formulas of one scene; sentences open with whose they are.
class Reader {
 public:
  Reader(const Scene& scene, LagrangianFormulas& all)
      : scene_(scene), all_(all), n_(static_cast<int>(scene.lagrangian->coordinates.size())) {}

  Expression read(const FormulaSpec& formula, const std::string& who) {
    const std::string told = who + ", " + in_quotes(formula.text) + ": ";
    try {
      Expression read(formula.text, all_.names);
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
  /// One of q and t alone.
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
  void expect_coordinate(const Expression& equation, const LagrangianSpec::Constraint& c,
                         const std::string& who) const {
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
    lagrangian = reader.read(spec.lagrangian, "lagrangian");
  else
    kinetic = reader.read(spec.kinetic, "kinetic");
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
    reader.expect_coordinate(constraints.back(), c, who);
  }
}

}  // namespace momenta
