// [lagrangian]: a system of coordinates and formulas, without bodies.

#include <momenta/core/scene/toml/read_tables.h>
#include <momenta/core/text/near_name.h>

namespace momenta::reading {
namespace {

FormulaSpec formula_of(const Fields& table, std::string_view key) {
  FormulaSpec formula;
  if (!table.has(key)) return formula;
  formula.text = table.text(key);
  formula.at = table.find(key)->at;
  if (formula.text.empty()) table.fail_key(key, "is empty, expected a formula");
  return formula;
}

/// The list, required to have one entry for each coordinate.
template <class List>
List of_size(const Fields& table, std::string_view key, List list, std::size_t size) {
  if (list.size() != size)
    table.fail_key(key, "has " + std::to_string(list.size()) + " entries, expected " +
                            std::to_string(size) + ", one for each coordinate");
  return list;
}

void read_coordinates(const Fields& table, LagrangianSpec& spec) {
  const std::vector<std::string> names = table.texts("coordinates");
  if (names.empty())
    table.fail_at(table.has("coordinates") ? table.find("coordinates")->at : table.at(),
                  "lagrangian has no coordinates, expected coordinates = [\"x\", ...]");
  const std::size_t n = names.size();
  std::vector<double> position(n), velocity(n);
  std::vector<std::string> units(n, "1");
  if (table.has("position"))
    position = of_size(table, "position", table.numbers("position", {}), n);
  if (table.has("velocity"))
    velocity = of_size(table, "velocity", table.numbers("velocity", {}), n);
  if (table.has("units")) units = of_size(table, "units", table.texts("units"), n);
  for (std::size_t i = 0; i < n; ++i)
    spec.coordinates.push_back({names[i], units[i], position[i], velocity[i]});
}

void read_forces(const Fields& table, LagrangianSpec& spec) {
  const std::optional<Fields> forces = table.table("force");
  if (!forces) return;
  for (const Entry& e : table.find("force")->entries)
    spec.forces.push_back({e.key, formula_of(*forces, e.key), e.at});
}

LagrangianSpec::Constraint read_constraint(const Fields& table) {
  table.allow({"name", "equation", "unit"});
  LagrangianSpec::Constraint c;
  c.at = table.at();
  c.name = table.text("name");
  (void)table.text("equation");  // required
  c.equation = formula_of(table, "equation");
  const std::string unit = table.text("unit", "m");
  if (unit != "m" && unit != "rad")
    table.fail_key("unit", "is " + in_quotes(unit) + ", expected \"m\" or \"rad\"");
  c.angle = unit == "rad";
  return c;
}

}  // namespace

LagrangianSpec read_lagrangian(const Fields& table) {
  table.allow({"coordinates", "units", "position", "velocity", "lagrangian", "kinetic", "potential",
               "force", "constraints"});
  LagrangianSpec spec;
  spec.at = table.at();
  read_coordinates(table, spec);
  spec.lagrangian = formula_of(table, "lagrangian");
  spec.kinetic = formula_of(table, "kinetic");
  spec.potential = formula_of(table, "potential");
  read_forces(table, spec);
  for (const Fields& t : table.tables("constraints", "constraint"))
    spec.constraints.push_back(read_constraint(t));
  return spec;
}

}  // namespace momenta::reading
