// The verb `index`: the differentiation index of each form, found numerically.

#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/index_report.h>
#include <momenta/dae/run/state_input.h>

#include <sstream>

#include "equation_verbs.h"
#include "loading.h"
#include "progress.h"
#include "results.h"
#include "verb.h"

namespace momenta::program {
namespace {

int index_verb(const Options& o, const std::string& forms, const std::string& state) {
  const CpuLimit limit(o.cpu_limit.value_or(0));
  const auto mechanism = load(o);
  std::vector<std::string> names;
  std::stringstream list(forms);
  for (std::string form; std::getline(list, form, ',');) names.push_back(form);
  const Start start = start_of(state, *mechanism);
  watch_signals();
  IndexStudy study;
  {
    ProgressLine line(o.quiet);
    study = run_index_study(*mechanism, start, names, [&](const std::string& form) {
      line.show(form);
      return !interrupted();
    });
  }
  const std::string json = index_json(study).dump(2) + "\n";
  if (!o.out.empty() && !write_results({{o.out / "index.json", json}})) return run_failed;
  tell(o, json, index_table(study), "index.json");
  return interrupted() ? run_failed : done;
}

}  // namespace

Verb declare_index(CLI::App& app, Options& o) {
  struct Wanted {
    std::string forms, state;
  };
  const auto own = std::make_shared<Wanted>();
  CLI::App& verb =
      add_verb(app, "index",
               "The differentiation index of each form, by numbers, and its hidden constraints",
               "momenta index examples/four_bar/scene.toml --forms momentum-index2");
  add_scene(verb, o);
  without(verb, {"--at"});
  verb.add_option("--forms", own->forms, "Default: all")->type_name("FORM,...");
  verb.add_option("--at", own->state, "Consistent state, as for evaluate (default: the start)")
      ->type_name("STATE");
  add_cpu_limit(verb, o);
  add_out(verb, o, "Directory for index.json");
  return {&verb, [&o, own] { return index_verb(o, own->forms, own->state); },
          [&o] { return index_of_equations(o); }};
}

}  // namespace momenta::program
