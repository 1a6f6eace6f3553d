#include <momenta/core/format/toml/fields.h>
#include <momenta/core/format/toml/set_numbers.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/algebra/structure/assignment.h>
#include <momenta/dae/analysis/equations/equation_file.h>
#include <momenta/dae/analysis/equations/equation_system.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace momenta {
namespace {

using namespace reading;

constexpr int most_unknowns = 450;

using structure::at;

class Reader {
 public:
  Reader(const Value& root, const std::string& file)
      : root_(root), file_(file), parameters_(root, file), fields_(root, "", file, &parameters_) {}

  EquationFile read() {
    fields_.allow({"dae", "parameters", "require", "run", "reference"});
    check_requirements(root_, parameters_, file_);
    const auto dae = fields_.table("dae");
    if (!dae) fail(file_, {1, 1}, "key 'dae' is missing, expected a table [dae] of equations");
    dae->allow(
        {"name", "variables", "definitions", "equations", "values", "rates", "scales", "hold"});
    out_.file = file_;
    out_.name = dae->text("name", "");
    read_variables(*dae);
    for (std::size_t i = 0; i < parameters_.names().size(); ++i)
      out_.parameters.push_back(parameters_[i]);
    read_definitions(*dae);
    read_equations(*dae);
    out_.values = by_variable(*dae, "values", {}, 0);
    out_.rates = by_variable(*dae, "rates", {}, 0);
    out_.scales = by_variable(*dae, "scales", {"", Bound::positive}, 1);
    out_.held = chosen(*dae, "hold", false);
    if (const auto run = fields_.table("run")) read_run(*run);
    if (const auto reference = fields_.table("reference")) read_reference(*reference);
    expect_assignment();
    return std::move(out_);
  }

 private:
  void read_variables(const Fields& dae) {
    out_.variables = dae.texts("variables");
    const Value* list = dae.find("variables");
    if (out_.variables.empty())
      fail(file_, list ? list->at : dae.at(),
           list ? "dae.variables is empty, expected the names of the unknowns"
                : "key 'dae.variables' is missing, expected the names of the unknowns");
    if (out_.variables.size() > at(most_unknowns))
      dae.fail_key("variables", "has " + std::to_string(out_.variables.size()) +
                                    " names, expected at most " + std::to_string(most_unknowns));
    for (std::size_t i = 0; i < out_.variables.size(); ++i) {
      const std::string& name = out_.variables[i];
      const Location place = list->items[i].at;
      const std::string what = "dae.variables[" + std::to_string(i) + "] is " + in_quotes(name);
      expect_name(name, place, what);
      if (std::find(out_.variables.begin(), out_.variables.begin() + static_cast<long>(i), name) !=
          out_.variables.begin() + static_cast<long>(i))
        fail(file_, place, what + " for the second time, expected each variable once");
    }
    std::vector<std::string> names{"t"};
    names.insert(names.end(), out_.variables.begin(), out_.variables.end());
    for (const std::string& name : out_.variables) names.push_back("der(" + name + ")");
    names.insert(names.end(), parameters_.names().begin(), parameters_.names().end());
    definitions_ = Definitions(std::move(names));
  }

  void expect_name(const std::string& name, Location place, const std::string& what) const {
    if (!is_plain_name(name) || name == "t" || name == "pi" || name == "der" || name == "and" ||
        name == "or" || name == "not" || name == "if")
      fail(file_, place,
           what +
               ", expected letters, digits and _, a letter first, and none of t, pi, der, "
               "and, or, not, if");
    const auto& parameters = parameters_.names();
    if (std::find(parameters.begin(), parameters.end(), name) != parameters.end())
      fail(file_, place, what + ", and so is a parameter, expected another name");
  }

  /// A definition takes those above it in the file.
  void read_definitions(const Fields& dae) {
    const Value* table = dae.find("definitions");
    if (!table) return;
    if (!dae.table("definitions")) return;  // throws
    for (std::size_t i = 0; i < table->entries.size(); ++i) {
      const auto& [name, place, value] = table->entries[i];
      const std::string what = "dae.definitions." + name;
      expect_name(name, place, what + " is " + in_quotes(name));
      if (std::find(out_.variables.begin(), out_.variables.end(), name) != out_.variables.end())
        fail(file_, place, what + " is a variable too, expected another name");
      if (value.type != Value::Type::text)
        fail(file_, value.at,
             what + " is " + std::string(described(value.type)) + ", expected a formula in quotes");
      const std::string told = what + ", " + in_quotes(value.text);
      try {
        definitions_.add(name, side(value, value.text, 0, told));
      } catch (const SceneError&) {
        expect_none_below(*table, i, told);
        throw;
      }
    }
  }
  /// Blames an unreadable formula for taking what is defined only below it.
  void expect_none_below(const Value& table, std::size_t i, const std::string& told) const {
    std::vector<std::string> names = definitions_.names();
    for (std::size_t k = i; k < table.entries.size(); ++k) names.push_back(table.entries[k].key);
    try {
      const Expression formula(table.entries[i].value.text, names);
      for (const int v : formula.variables())
        if (const auto at = static_cast<std::size_t>(v); at >= definitions_.names().size())
          fail(
              file_, table.entries[i].value.at,
              told + " takes " + in_quotes(names[at]) +
                  (at == definitions_.names().size() ? ", itself" : ", which is defined below it") +
                  ", expected what stands above");
    } catch (const ExpressionError&) {
    }
  }

  void read_equations(const Fields& dae) {
    const std::vector<std::string> texts = dae.texts("equations");
    const Value* list = dae.find("equations");
    if (!list)
      fail(file_, dae.at(), "key 'dae.equations' is missing, expected a list of equations");
    for (std::size_t i = 0; i < texts.size(); ++i)
      out_.equations.push_back({texts[i], list->items[i].at, formula_of(list->items[i], i)});
    if (texts.size() != out_.variables.size())
      dae.fail_key("equations", "has " + std::to_string(texts.size()) +
                                    (texts.size() == 1 ? " equation for " : " equations for ") +
                                    std::to_string(out_.variables.size()) +
                                    " variables, expected as many");
  }

  /// Place of an = that stands alone; npos: none.
  static std::size_t equals_in(const std::string& text, std::size_t from) {
    for (std::size_t i = from; i < text.size(); ++i) {
      if (text[i] != '=') continue;
      if (i + 1 < text.size() && text[i + 1] == '=') {
        ++i;
        continue;
      }
      if (i > 0 && (text[i - 1] == '<' || text[i - 1] == '>' || text[i - 1] == '!')) continue;
      return i;
    }
    return std::string::npos;
  }

  Expression formula_of(const Value& v, std::size_t number) {
    const std::string& text = v.text;
    const std::string told = "equation " + std::to_string(number + 1) + ", " + in_quotes(text);
    const std::size_t equals = equals_in(text, 0);
    if (equals == std::string::npos) return definitions_.in_place(side(v, text, 0, told));
    if (const std::size_t more = equals_in(text, equals + 1); more != std::string::npos)
      fail(file_, place_in(v, more), told + ": a second '=', expected one at most");
    // Each side alone, for the right places in messages; then the difference.
    const std::string left = text.substr(0, equals), right = text.substr(equals + 1);
    side(v, left, 0, told);
    side(v, right, equals + 1, told);
    return definitions_.in_place(
        Expression("(" + left + ") - (" + right + ")", definitions_.names()));
  }
  Expression side(const Value& v, const std::string& text, std::size_t begin,
                  const std::string& told) const {
    try {
      Expression read(text, definitions_.names());
      if (read.is_truth()) fail(file_, v.at, told + ": a comparison, expected numbers");
      return read;
    } catch (const ExpressionError& e) {
      fail(file_, place_in(v, begin + e.place()), told + ": " + e.what());
    }
  }

  std::vector<double> by_variable(const Fields& table, std::string_view key, Quantity quantity,
                                  double otherwise) const {
    std::vector<double> values(out_.variables.size(), otherwise);
    const auto given = table.table(key);
    if (!given) return values;
    const std::vector<std::string_view> known(out_.variables.begin(), out_.variables.end());
    given->allow(known);
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = given->number(out_.variables[i], quantity, otherwise);
    return values;
  }
  /// Whether the list names each variable; without a list `otherwise` for all.
  std::vector<char> chosen(const Fields& table, std::string_view key, bool otherwise) const {
    std::vector<char> all(out_.variables.size(), otherwise ? 1 : 0);
    const Value* list = table.find(key);
    if (!list) return all;
    std::fill(all.begin(), all.end(), 0);
    const std::vector<std::string> names = table.texts(key);
    const std::vector<std::string_view> known(out_.variables.begin(), out_.variables.end());
    for (std::size_t k = 0; k < names.size(); ++k) {
      const auto found = std::find(known.begin(), known.end(), names[k]);
      if (found == known.end()) {
        const std::string near = did_you_mean(names[k], known);
        fail(file_, list->items[k].at,
             std::string(key) + " names " + in_quotes(names[k]) + ", which is no variable" +
                 (near.empty() ? ", expected one of: " + listed(known) : near));
      }
      all[static_cast<std::size_t>(found - known.begin())] = 1;
    }
    return all;
  }

  void read_run(const Fields& run) {
    run.allow({"start", "end", "samples", "integrator"});
    out_.start = run.number("start", {}, 0);
    out_.end = run.number("end", {}, out_.start + 1);
    if (!(out_.end > out_.start))
      run.fail_key(run.has("end") ? "end" : "start",
                   "is " + digits(run.has("end") ? out_.end : out_.start) +
                       ", expected an end after the start");
    out_.samples = run.count("samples", out_.samples);
    out_.integrator = run.text("integrator", "");
    if (!out_.integrator.empty() && out_.integrator != "ida" && out_.integrator != "radau5")
      run.fail_key("integrator",
                   "is " + in_quotes(out_.integrator) + ", expected \"ida\" or \"radau5\"");
  }

  void read_reference(const Fields& table) {
    table.allow({"t", "values", "judged"});
    EquationFile::Reference reference;
    reference.t = table.number("t", {}, out_.end);
    if (!(reference.t > out_.start))
      table.fail_key("t", "is " + digits(reference.t) + ", expected a time after the start, " +
                              digits(out_.start));
    reference.values = by_variable(table, "values", {}, std::numeric_limits<double>::quiet_NaN());
    reference.judged = chosen(table, "judged", true);
    bool any = false;
    for (std::size_t i = 0; i < reference.values.size(); ++i) {
      if (!table.has("judged") && std::isnan(reference.values[i])) reference.judged[i] = 0;
      if (reference.judged[i] && std::isnan(reference.values[i]))
        table.fail_key("judged", "names " + in_quotes(out_.variables[i]) +
                                     ", which has no value here, expected one in values");
      any |= reference.judged[i] != 0;
    }
    if (!any) table.fail_at(table.at(), "reference has no values, expected some of variables");
    out_.reference = std::move(reference);
  }

  std::string names_of(const std::vector<int>& list) const {
    std::vector<std::string> names;
    for (const int j : list) names.push_back(out_.variables[at(j)]);
    return all_in_quotes(names, 6);
  }
  static std::string numbers_of(const std::vector<int>& list) {
    constexpr std::size_t most = 6;
    std::string text;
    for (std::size_t k = 0; k < list.size() && k < most; ++k)
      text += (k == 0 ? "" : k + 1 == list.size() ? " and " : ", ") + std::to_string(list[k] + 1);
    if (list.size() > most) text += " and " + std::to_string(list.size() - most) + " more";
    return text;
  }
  /// Every equation needs a variable of its own.
  void expect_assignment() const {
    const structure::Deficiency d = structure::deficiency(out_.signature());
    if (d.equations.empty()) return;
    const bool one = d.equations.size() == 1;
    fail(file_, out_.equations[at(d.equations.front())].at,
         std::string("structurally singular: equation") + (one ? " " : "s ") +
             numbers_of(d.equations) + (one ? " has " : " have ") +
             (d.their_variables.empty()
                  ? "no variable"
                  : "only the variable" + std::string(d.their_variables.size() == 1 ? " " : "s ") +
                        names_of(d.their_variables)) +
             ", and " + names_of(d.variables) +
             (d.their_equations.empty()
                  ? (d.variables.size() == 1 ? " stands" : " stand") + std::string(" in none")
                  : (d.variables.size() == 1 ? " stands" : " stand") + std::string(" only in ") +
                        numbers_of(d.their_equations)) +
             ", expected an assignment of every equation to a variable of its own");
  }

  const Value& root_;
  const std::string& file_;
  Parameters parameters_;
  Fields fields_;
  Definitions definitions_{{}};
  EquationFile out_;
};

}  // namespace

structure::Signature EquationFile::signature() const {
  const int n = size();
  structure::Signature s(n);
  for (int i = 0; i < n; ++i)
    for (const int v : equations[at(i)].formula.variables())
      if (v >= 1 && v <= 2 * n) {
        int& order = s(i, (v - 1) % n);
        order = std::max(order, v > n ? 1 : 0);
      }
  return s;
}

std::string EquationFile::name_of(int equation) const {
  return "equation " + std::to_string(equation + 1) + ", " +
         in_quotes(equations[at(equation)].text);
}

std::string EquationFile::where(Location place) const {
  Scene scene;
  scene.file = file;
  return scene.where(place);
}

EquationFile parse_equations(std::string_view text, const std::string& file,
                             const std::vector<Setting>& settings) {
  Value root = parse_toml(text, file);
  set_numbers(root, settings);
  return Reader(root, file).read();
}

EquationFile read_equations(const std::filesystem::path& file,
                            const std::vector<Setting>& settings) {
  return parse_equations(text_of(file, "file of equations"), file.string(), settings);
}

}  // namespace momenta
