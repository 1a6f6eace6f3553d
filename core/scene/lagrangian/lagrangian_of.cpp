#include <momenta/core/scene/lagrangian/lagrangian_formulas.h>
#include <momenta/core/scene/lagrangian/lagrangian_of.h>

#include <stdexcept>
#include <string>

namespace momenta {

std::vector<std::string> formula_names(const std::vector<LagrangianSpec::Coordinate>& coordinates) {
  std::vector<std::string> names;
  for (const auto& c : coordinates) names.push_back(c.name);
  for (const auto& c : coordinates) names.push_back(LagrangianFormulas::rate_name(c.name));
  names.emplace_back("t");
  return names;
}

void expect_constraints(bool has_function, std::size_t names) {
  if (has_function && names == 0)
    throw std::logic_error(
        "the class has constraints(q, t, phi) and no constraint has a name, expected one name for "
        "each of their values");
  if (!has_function && names > 0)
    throw std::logic_error(
        std::to_string(names) +
        " constraints have names and the class has no constraints(q, t, phi), expected both");
}

}  // namespace momenta
