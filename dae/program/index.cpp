// The verb `index`: the differentiation index of each form, found numerically.

#include <momenta/dae/report/index_report.h>
#include <momenta/dae/study/state_input.h>
#include <momenta/dae/text/number_text.h>

#include <sstream>

#include "answers.h"
#include "cpu_limit.h"
#include "loading.h"
#include "progress_line.h"
#include "results.h"

namespace momenta::program {

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

}  // namespace momenta::program
