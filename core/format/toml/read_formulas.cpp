// Formulas of forces, loops, drives and events, read once the whole scene is known.

#include <momenta/core/format/toml/scene_keys.h>
#include <momenta/core/scene/drive.h>
#include <momenta/core/scene/formula.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <vector>

namespace momenta::reading {
namespace {

/// The value of a key, "law" or "force[1]".
const Value& value_at(const Fields& table, const std::string& key) {
  const std::size_t bracket = key.find('[');
  const Value& value = *table.find(key.substr(0, bracket));
  if (bracket == std::string::npos) return value;
  return value.items[static_cast<std::size_t>(key[bracket + 1] - '0')];
}

/// Reads a formula by read(text); its text then has numbers in place of parameters.
template <class Read>
Formula read_at(const Fields& table, const std::string& key, std::string& text, Scene& scene,
                Read&& read) {
  try {
    Formula formula = read(text);
    for (const int i : formula.parameters)
      scene.parameters[static_cast<std::size_t>(i)].used = true;
    return formula;
  } catch (const ExpressionError& e) {
    table.fail_at(place_in(value_at(table, key), e.place()),
                  key + ", " + in_quotes(text) + ": " + e.what());
  }
}

/// The place in "left = right" of a place in "(left) - (right)", made from it.
std::size_t place_as_typed(const std::string& typed, const std::string& read, std::size_t place) {
  if (typed == read) return place;
  const std::size_t left = read.size() - typed.size();  // added by ") - (" and the brackets
  std::size_t sign = 0;                                 // place of '='
  while (sign < typed.size() && typed[sign] == read[sign + 1]) ++sign;
  return std::min(typed.size(), place <= sign + 1 ? std::max<std::size_t>(place, 1) - 1
                                                  : place - std::min(place, left - 1));
}

bool takes_time(const Formula& formula) {
  return std::any_of(formula.signals.begin(), formula.signals.end(),
                     [](const Signal& s) { return s.kind == Signal::Kind::time; });
}

}  // namespace

void read_formulas(const Fields& root, Scene& scene) {
  const FormulaReader reader(scene);
  std::size_t which = 0;
  for (const Fields& table : root.tables("force", "force")) {
    ForceSpec& force = scene.forces[which++];
    if (!has_formula(force)) continue;
    const std::vector<OwnName> own = reader.own_names(force);
    each_formula(force, [&](const std::string& key, std::string& text) {
      const Formula formula =
          read_at(table, key, text, scene, [&](const auto& t) { return reader.read(t, own); });
      if (const std::string fault = formula_fault(scene, force, formula); !fault.empty())
        table.fail_at(value_at(table, key).at, key + ", " + in_quotes(text) + ", " + fault);
      text = formula.text;
      if (force.kind == "potential" && takes_time(formula))
        scene.remarks.push_back(
            (force.name.empty() ? "a potential" : "potential " + in_quotes(force.name)) +
            " takes the time, so that it keeps no energy: ∂V/∂t counts as work of forces without "
            "potential");
    });
  }
  which = 0;
  for (const Fields& table : root.tables("loop", "loop")) {
    LoopSpec& loop = scene.loops[which++];
    if (!has_equation(loop)) continue;
    std::string as_typed = table.text("equation");
    const Formula formula = read_at(table, "equation", as_typed, scene, [&](const auto& t) {
      try {
        return reader.read(loop.equation);
      } catch (const ExpressionError& e) {
        throw ExpressionError(e.what(), place_as_typed(t, loop.equation, e.place()));
      }
    });
    if (const std::string fault = equation_fault(scene, loop.kind, formula); !fault.empty())
      table.fail_at(value_at(table, "equation").at,
                    "equation, " + in_quotes(as_typed) + ", " + fault);
    loop.equation = formula.text;
  }
  which = 0;
  if (!scene.lagrangian)  // its formulas have names of their own (lagrangian_formulas.h)
    for (const Fields& table : root.tables("event", "event")) {
      std::string& text = scene.events[which++].when.text;
      const Formula formula =
          read_at(table, "when", text, scene, [&](const auto& t) { return reader.read(t); });
      if (const std::string fault = event_fault(formula); !fault.empty())
        table.fail_at(value_at(table, "when").at, "when, " + in_quotes(text) + ", " + fault);
      text = formula.text;
    }
  which = 0;
  for (const Fields& table : root.tables("drive", "drive")) {
    DriveSpec& drive = scene.drives[which++];
    if (drive.kind != "formula") continue;
    const Formula formula = read_at(table, "law", drive.law, scene,
                                    [&](const auto& t) { return reader.read_of_time(t); });
    drive.law = formula.text;
    for (const int f : formula.functions)
      drive.functions.push_back(scene.functions[static_cast<std::size_t>(f)]);
    if (const std::string fault = law_fault(drive); !fault.empty())
      table.fail_at(value_at(table, "law").at, fault);
    if (const std::string corner = law_corner(drive); !corner.empty())
      scene.remarks.push_back("drive of " +
                              (drive.joint.empty() ? "loop " + in_quotes(drive.loop)
                                                   : "joint " + in_quotes(drive.joint)) +
                              ": " + in_quotes(corner) +
                              " in its law may have corners or jumps, "
                              "where no acceleration exists; expected a smooth law, and functions "
                              "by points of kind cubic");
  }
}

}  // namespace momenta::reading
