// [lagrangian]: a system of coordinates and formulas, without bodies.

#include <momenta/core/format/toml/scene_keys.h>
#include <momenta/core/text/quoting.h>

namespace momenta::reading {
namespace {

using Coordinate = LagrangianSpec::Coordinate;

FormulaSpec formula_of(const Fields& table, std::string_view key) {
  FormulaSpec formula;
  if (!table.has(key)) return formula;
  formula.text = table.text(key);
  formula.at = table.find(key)->at;
  if (formula.text.empty()) table.fail_key(key, "is empty, expected a formula");
  return formula;
}

void declare_formula(Keys& t, std::string_view key, FormulaSpec& formula) {
  t.key(
      key, [&](const Fields& in) { formula = formula_of(in, key); },
      [&] { return formula.text.empty() ? "" : toml_text::of(formula.text); });
}

/// A list with one entry for each coordinate, `member` of it. read(table) takes the list.
template <class T, class Read>
void declare_list(Keys& t, std::string_view key, std::vector<Coordinate>& coordinates,
                  T Coordinate::*member, Read&& read) {
  t.key(
      key,
      [&](const Fields& in) {
        if (!in.has(key)) return;
        const std::vector<T> list = read(in);
        if (list.size() != coordinates.size())
          in.fail_key(key, "has " + std::to_string(list.size()) + " entries, expected " +
                               std::to_string(coordinates.size()) + ", one for each coordinate");
        for (std::size_t i = 0; i < list.size(); ++i) coordinates[i].*member = list[i];
      },
      [&] {
        std::vector<T> list;
        for (const Coordinate& c : coordinates) list.push_back(c.*member);
        return toml_text::of(list);
      });
}

void declare_coordinates(Keys& t, std::vector<Coordinate>& coordinates) {
  if (t.reads()) {
    const std::vector<std::string> names = t.in().texts("coordinates");
    if (names.empty())
      t.in().fail_at(t.in().has("coordinates") ? t.in().find("coordinates")->at : t.in().at(),
                     "lagrangian has no coordinates, expected coordinates = [\"x\", ...]");
    coordinates.assign(names.size(), {"", "1", 0, 0});
  }
  const auto texts = [](const char* key) {
    return [key](const Fields& in) { return in.texts(key); };
  };
  const auto numbers = [](const char* key) {
    return [key](const Fields& in) { return in.numbers(key, {}); };
  };
  declare_list(t, "coordinates", coordinates, &Coordinate::name, texts("coordinates"));
  declare_list(t, "units", coordinates, &Coordinate::unit, texts("units"));
  declare_list(t, "position", coordinates, &Coordinate::position, numbers("position"));
  declare_list(t, "velocity", coordinates, &Coordinate::velocity, numbers("velocity"));
}

/// force = { coordinate = formula, .. }
void declare_forces(Keys& t, std::vector<LagrangianSpec::Force>& forces) {
  t.key(
      "force",
      [&](const Fields& in) {
        if (const std::optional<Fields> table = in.table("force"))
          for (const Entry& e : in.find("force")->entries)
            forces.push_back({e.key, formula_of(*table, e.key), e.at});
      },
      [&] {
        std::string all;
        for (const auto& f : forces)
          all += (all.empty() ? "{ " : ", ") + toml_text::of(f.coordinate) + " = " +
                 toml_text::of(f.value.text);
        return all.empty() ? "" : all + " }";
      });
}

}  // namespace

void declare(Keys& t, LagrangianSpec::Constraint& c) {
  t.value("name", c.name);
  t.value("equation", c.equation.text);
  if (t.reads()) c.equation = formula_of(t.in(), "equation");
  std::string unit = c.angle ? "rad" : "m";
  t.value_or("unit", unit, "m");
  if (unit != "m" && unit != "rad")
    t.in().fail_key("unit", "is " + in_quotes(unit) + ", expected \"m\" or \"rad\"");
  c.angle = unit == "rad";
}

void declare(Keys& t, LagrangianSpec& spec) {
  declare_coordinates(t, spec.coordinates);
  declare_formula(t, "lagrangian", spec.lagrangian);
  declare_formula(t, "kinetic", spec.kinetic);
  declare_formula(t, "potential", spec.potential);
  declare_forces(t, spec.forces);
  t.key(
      "constraints",
      [&](const Fields& in) {
        for (const Fields& table : in.tables("constraints", "constraint")) {
          spec.constraints.emplace_back().at = table.at();
          Keys::read(table, [&](Keys& keys) { declare(keys, spec.constraints.back()); });
        }
      },
      [] { return ""; });  // tables of their own
}

}  // namespace momenta::reading
