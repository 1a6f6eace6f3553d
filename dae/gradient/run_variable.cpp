#include <momenta/core/format/toml/number_at.h>
#include <momenta/core/scalar/sixth_order.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/gradient/run_variable.h>
#include <momenta/dae/kkt/loop_units.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace momenta {
namespace {

RunVariable of_scene(const std::string& place, double value) {
  return {RunVariable::Kind::parameter, place, "", -1, value, std::abs(value)};
}

/// Whether a name begins like the place of a number: "body.crank.mass".
bool is_place(const std::string& name) {
  for (const char* table : {"body.", "joint.", "loop.", "force.", "drive.", "marker.", "function.",
                            "gravity.", "lagrangian."})
    if (name.starts_with(table)) return true;
  return false;
}

}  // namespace

Scene SceneText::scene(const std::vector<Setting>& more) const {
  std::vector<Setting> all = fixed;
  all.insert(all.end(), more.begin(), more.end());
  return parse_scene(text, file, all);
}

double step_size(double value, const std::function<void(double)>& make) {
  constexpr double next_to_nothing = 1e-12, widest = 3 * sixth_order::part;
  const double magnitude = std::abs(value);
  if (magnitude >= next_to_nothing) return magnitude;
  for (double size = 1; size > next_to_nothing; size /= 8) try {
      make(value + widest * size);
      make(value - widest * size);
      return size;
    } catch (const SceneError&) {  // narrower
    }
  return magnitude > 0 ? magnitude : 1;
}

std::vector<RunVariable> run_variables(const SceneText& scene, const Mechanism& mechanism,
                                       const std::vector<std::string>& names) {
  using Kind = RunVariable::Kind;
  std::vector<RunVariable> all;
  for (const ParameterSpec& p : mechanism.scene().parameters)
    all.push_back(of_scene(p.name, p.value));
  const LoopUnits units(mechanism);
  const std::vector<Column> coordinates = mechanism.coordinate_columns(),
                            rates = mechanism.rate_columns();
  const Tree& tree = mechanism.tree();
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (coordinates[i].unit == "1") continue;  // part of a quaternion
    const auto at = static_cast<Eigen::Index>(i);
    // Lengths are in lengths of the scene; q and u differ by quaternions alone.
    const double length = coordinates[i].unit == "m" && tree.nq == tree.nv ? units.rates[at] : 1;
    all.push_back({Kind::position, coordinates[i].name, coordinates[i].unit, static_cast<int>(i),
                   tree.q0[at], std::max(length, 0.1 * std::abs(tree.q0[at]))});
  }
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    all.push_back({Kind::rate, rates[i].name, rates[i].unit, static_cast<int>(i), tree.u0[at],
                   std::max(units.rates[at], std::abs(tree.u0[at]))});
  }
  std::vector<RunVariable> chosen;
  std::vector<std::string_view> known;
  std::function<double(const std::string&)> number_at;
  for (const RunVariable& v : all) known.push_back(v.name);
  for (std::string name : names) {
    if (constexpr std::string_view table = "parameters."; name.starts_with(table))
      name.erase(0, table.size());  // settings take both
    if (std::any_of(chosen.begin(), chosen.end(),
                    [&](const RunVariable& v) { return v.name == name; }))
      throw std::invalid_argument(reading::in_quotes(name) + " is named twice; expected it once");
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const RunVariable& v) { return v.name == name; });
    if (found == all.end() && is_place(name)) {
      if (!number_at) number_at = numbers_of(scene.text, scene.file, scene.fixed);
      chosen.push_back(of_scene(name, number_at(name)));
      continue;
    }
    if (found == all.end()) {
      const std::string near = reading::did_you_mean(name, known);
      throw std::invalid_argument(
          reading::in_quotes(name) + " is no parameter of the scene and no start value" +
          (!near.empty()   ? near
           : known.empty() ? ", expected a number by its place, as in body.crank.mass"
                           : ", expected one of: " + reading::listed(known)));
    }
    chosen.push_back(*found);
  }
  for (RunVariable& v : chosen)
    if (v.kind == Kind::parameter)
      v.size = step_size(v.value, [&](double value) { scene.scene({{v.name, value}}); });
  if (chosen.empty())
    throw std::invalid_argument(
        "no numbers are named that the gradient is by; expected parameters or start values");
  return chosen;
}

}  // namespace momenta
