// Files of suites of mechanisms: their keys and what is refused.

#include <momenta/core/format/toml/fields.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/study/scene_suite.h>

namespace momenta {
namespace {

using namespace reading;

/// Names of `key`, each known; `known` throws for one that is not.
template <class Known>
std::vector<std::string> names_in(const Fields& table, const char* key,
                                  const std::vector<std::string>& otherwise, Known&& known) {
  if (!table.has(key)) return otherwise;
  std::vector<std::string> names = table.texts(key);
  for (const std::string& name : names) try {
      known(name);
    } catch (const std::invalid_argument& e) {
      table.fail_key(key, std::string("has ") + in_quotes(name) + ": " + e.what());
    }
  return names;
}
std::vector<std::string> forms_in(const Fields& table, const std::vector<std::string>& otherwise) {
  return names_in(table, "forms", otherwise, [](const std::string& form) { is_dae_form(form); });
}
std::vector<std::string> integrators_in(const Fields& table,
                                        const std::vector<std::string>& otherwise) {
  return names_in(table, "integrators", otherwise, [&](const std::string& name) {
    if (integrator(name).step == Integrator::Step::fixed)
      throw std::invalid_argument("it has fixed steps, expected one with error control");
  });
}
std::vector<double> between(const Fields& table, const char* key,
                            const std::vector<double>& otherwise, double most) {
  if (!table.has(key)) return otherwise;
  std::vector<double> numbers = table.numbers(key, {});
  for (const double x : numbers)
    if (!(x > 0 && x < most))
      table.fail_key(key, "has " + digits(x) + ", expected numbers between 0 and " + digits(most));
  return numbers;
}

std::string opened(const Fields& table, const char* key, const std::filesystem::path& folder,
                   const char* expected) {
  const std::filesystem::path named = table.text(key);
  const std::string file =
      (named.is_absolute() ? named : folder / named).lexically_normal().string();
  if (!std::filesystem::is_regular_file(file))
    table.fail_key(key, "is " + in_quotes(named.string()) + ", expected " + expected);
  return file;
}

std::vector<Setting> settings_in(const Fields& table) {
  std::vector<Setting> settings;
  const Value* set = table.find("set");
  if (!set) return settings;
  if (set->type != Value::Type::table)
    table.fail_key("set", "is " + std::string(described(set->type)) +
                              ", expected a table: { \"joint.O.position\" = 0.1 }");
  for (const Entry& entry : set->entries) {
    if (!is_number(entry.value))
      table.fail_at(entry.at, "set " + in_quotes(entry.key) + " is " +
                                  std::string(described(entry.value.type)) + ", expected a number");
    settings.push_back({entry.key, entry.value.number});
  }
  return settings;
}

void read_times(const Fields& t, SceneProblem& problem) {
  for (const char* key : {"end", "samples"})
    if (t.has(key) && !problem.reference.empty())
      t.refuse(key, "stands beside a reference, which has the times; expected one of them");
  if (t.has("end")) problem.end = t.number("end", {"s", Bound::positive});
  problem.samples = t.count("samples", problem.samples);
  if (problem.samples > most_samples)
    t.fail_key("samples", "is " + std::to_string(problem.samples) + ", expected at most " +
                              std::to_string(most_samples));
}

void read_error(const Fields& t, SceneProblem& problem) {
  const std::string error = t.text("error", "mixed");
  if (error != "mixed" && error != "threshold")
    t.fail_key("error", "is " + in_quotes(error) + ", expected \"mixed\" or \"threshold\"");
  if (error == "threshold") {
    problem.error = BenchmarkError::Kind::threshold;
    problem.threshold = t.number("threshold", {"", Bound::positive}, problem.threshold);
  } else if (t.has("threshold")) {
    t.refuse("threshold", "belongs to error = \"threshold\", expected both or neither");
  }
  problem.columns = t.texts("columns");
  problem.allowed = between(t, "allowed", {}, 1);
}

}  // namespace

bool has_scenes(const std::filesystem::path& suite) {
  try {
    const Value root = parse_toml(text_of(suite, "suite"), suite.string());
    const Value* problems = find(root, "problem");
    if (!problems || problems->type != Value::Type::array) return false;
    for (const Value& problem : problems->items)
      if (problem.type == Value::Type::table && find(problem, "scene")) return true;
  } catch (const SceneError&) {
    // The reader of suites says what is wrong.
  }
  return false;
}

SceneSuite read_scene_suite(const std::filesystem::path& path) {
  const std::string file = path.string();
  const Value root = parse_toml(text_of(path, "suite"), file);
  const Fields table(root, "", file);
  table.allow({"name", "forms", "integrators", "tolerances", "problem"});
  SceneSuite suite;
  suite.file = file;
  suite.name = table.text("name", path.stem().string());
  const std::vector<std::string> forms = forms_in(
      table, {"momentum", "projected", "baumgarte", "momentum-index2", "stabilised-index2"});
  const std::vector<std::string> integrators = integrators_in(table, {});
  const std::vector<double> tolerances = between(table, "tolerances", {1e-4, 1e-6, 1e-8, 1e-10}, 1);
  for (const Fields& t : table.tables("problem", "problem")) {
    if (t.has("file"))
      t.refuse("file", "is of suites of equations, expected 'scene' as of the others");
    t.allow({"scene", "name", "set", "reference", "end", "samples", "columns", "error", "threshold",
             "allowed", "forms", "integrators", "tolerances"});
    SceneProblem problem;
    problem.scene = opened(t, "scene", path.parent_path(), "a scene in TOML");
    problem.name = t.text("name", "");
    problem.set = settings_in(t);
    if (t.has("reference"))
      problem.reference = opened(t, "reference", path.parent_path(), "a reference solution in CSV");
    read_times(t, problem);
    read_error(t, problem);
    problem.forms = forms_in(t, forms);
    problem.integrators = integrators_in(t, integrators);
    problem.tolerances = between(t, "tolerances", tolerances, 1);
    suite.problems.push_back(std::move(problem));
  }
  if (suite.problems.empty())
    fail(file, {1, 1}, "the suite has no problem, expected at least one [[problem]]");
  return suite;
}

}  // namespace momenta
