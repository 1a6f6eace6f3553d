#include <momenta/core/format/toml/fields.h>
#include <momenta/core/format/toml/parameters.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace momenta::reading {
namespace {

/// Values of parameters, each after those in its formula.
class Resolver {
 public:
  Resolver(const Value& table, const std::vector<std::string>& names, const std::string& file)
      : table_(table), names_(names), file_(file), formulas_(names.size()) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      const Value& v = table.entries[i].value;
      if (v.type != Value::Type::text) continue;
      try {
        formulas_[i].emplace(v.text, names);
      } catch (const ExpressionError& e) {
        fail(file, place_in(v, e.place()), told(i) + e.what());
      }
      if (formulas_[i]->is_truth())
        fail(file, v.at, told(i) + "is a comparison, expected a formula of a number");
    }
  }

  void resolve(std::vector<double>& values, std::vector<char>& used) {
    std::vector<char> state(names_.size(), fresh);
    for (std::size_t i = 0; i < names_.size(); ++i) visit(i, state, values, used);
  }

 private:
  enum State : char { fresh, under_way, done };
  std::string told(std::size_t i) const {
    const Value& v = table_.entries[i].value;
    return "parameter " + in_quotes(names_[i]) + ", " + in_quotes(v.text) + ": ";
  }

  /// Depth first, without recursion: chains of parameters may be long.
  void visit(std::size_t first, std::vector<char>& state, std::vector<double>& values,
             std::vector<char>& used) {
    std::vector<std::size_t> way{first};
    while (!way.empty()) {
      const std::size_t i = way.back();
      const Value& v = table_.entries[i].value;
      bool waits = false;
      if (state[i] == fresh && formulas_[i])
        for (const int k : formulas_[i]->variables()) {
          const auto other = static_cast<std::size_t>(k);
          used[other] = 1;
          if (state[other] == done) continue;
          if (other == i || state[other] == under_way) fail_circle(i, other, way);
          way.push_back(other);
          waits = true;
          break;
        }
      if (waits) {
        on_way(way, state);
        continue;
      }
      values[i] = formulas_[i] ? (*formulas_[i])(values) : v.number;
      if (!std::isfinite(values[i]))
        fail(file_, v.at,
             "parameter " + in_quotes(names_[i]) + " is " + digits(values[i]) +
                 ", expected a finite number");
      state[i] = done;
      way.pop_back();
      if (!way.empty()) state[way.back()] = fresh;  // looks for further ones to wait for
    }
  }
  /// Marks all on the way but the last as waiting.
  static void on_way(const std::vector<std::size_t>& way, std::vector<char>& state) {
    state[way[way.size() - 2]] = under_way;
  }
  [[noreturn]] void fail_circle(std::size_t i, std::size_t other,
                                const std::vector<std::size_t>& way) const {
    std::string circle;
    for (auto k = std::find(way.begin(), way.end(), other); k != way.end(); ++k)
      circle += in_quotes(names_[*k]) + " of ";
    fail(file_, table_.entries[i].value.at,
         "parameters depend on each other: " + circle + in_quotes(names_[other]) +
             ", expected one of them as a number");
  }

  const Value& table_;
  const std::vector<std::string>& names_;
  const std::string& file_;
  std::vector<std::optional<Expression>> formulas_;
};

}  // namespace

Location place_in(const Value& text, std::size_t character) {
  return place_in(text.text, text.at, character);
}

Parameters::Parameters(const Value& root, const std::string& file) {
  const Value* table = find(root, "parameters");
  if (!table) return;
  if (table->type != Value::Type::table)
    fail(file, table->at,
         "parameters is " + std::string(described(table->type)) + ", expected a table");
  for (const Entry& e : table->entries) {
    if (!is_plain_name(e.key) || e.key == "pi" || e.key == "t" || e.key == "and" || e.key == "or" ||
        e.key == "not" || e.key == "if")
      fail(file, e.at,
           "parameter " + in_quotes(e.key) +
               " has a name that formulas cannot take, expected letters, digits and _, a letter "
               "first, and none of pi, t, and, or, not, if");
    if (!is_number(e.value) && e.value.type != Value::Type::text)
      fail(file, e.value.at,
           "parameter " + in_quotes(e.key) + " is " + std::string(described(e.value.type)) +
               ", expected a number or a formula in quotes");
    names_.push_back(e.key);
  }
  values_.resize(names_.size());
  used_.resize(names_.size());
  Resolver(*table, names_, file).resolve(values_, used_);
}

Expression Parameters::formula(std::string_view text) const {
  Expression read(text, names_);
  for (const int i : read.variables()) used_[static_cast<std::size_t>(i)] = 1;
  return read;
}

void check_requirements(const Value& root, const Parameters& parameters, const std::string& file) {
  const Fields scene(root, "", file);
  for (const Fields& t : scene.tables("require", "requirement")) {
    t.allow({"that", "because"});
    const std::string that = t.text("that"), because = t.text("because", "");
    const Value& at = *t.find("that");
    try {
      const Expression formula = parameters.formula(that);
      if (!formula.is_truth())
        t.fail_key("that", "is a number, expected a comparison such as \"a < b\"");
      if (parameters.value(formula) != 0) continue;
      std::string values;
      for (const int i : formula.variables())
        values += (values.empty() ? ", with " : ", ") +
                  parameters.names()[static_cast<std::size_t>(i)] + " = " +
                  digits(parameters[static_cast<std::size_t>(i)]);
      t.fail_key("that", "does not hold: " + on_one_line(that) + values +
                             (because.empty() ? ", expected parameters for which it does"
                                              : ": " + on_one_line(because)));
    } catch (const ExpressionError& e) {
      t.fail_at(place_in(at, e.place()), "that, " + in_quotes(that) + ": " + e.what());
    }
  }
}

}  // namespace momenta::reading
