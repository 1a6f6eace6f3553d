#include <momenta/dae/report/run_label.h>
#include <momenta/dae/text/number_text.h>

#include <algorithm>
#include <array>
#include <tuple>

namespace momenta {
namespace {

std::array<std::string, 5> details(const RunSettings& s) {
  return {s.integrator, s.gauge, tolerance_text(s), s.project ? "projected" : "", s.kkt};
}

}  // namespace

std::string tolerance_text(const RunSettings& s) {
  if (s.step > 0) return "h = " + compact(s.step, 4) + " s";
  const std::string relative = scientific(s.rtol, 3);
  return s.rtol == s.atol ? relative : relative + '/' + scientific(s.atol, 3);
}

std::vector<std::string> run_labels(const StudyResult& study, bool with_tolerance) {
  const auto& runs = study.runs;
  std::vector<std::string> labels;
  for (const RunResult& run : runs) {
    const auto own = details(run.settings);
    std::string label = run.settings.form;
    for (std::size_t k = 0; k < own.size(); ++k) {
      const bool differs = std::any_of(runs.begin(), runs.end(), [&](const RunResult& other) {
        return other.settings.form == run.settings.form && details(other.settings)[k] != own[k];
      });
      if (differs && !own[k].empty() && (with_tolerance || k != 2)) {
        label += ", ";
        if (k == 1 && own[k] == "none") label += "gauge ";
        label += own[k];
      }
    }
    labels.push_back(label);
  }
  return labels;
}

std::vector<std::size_t> ladders(const StudyResult& study) {
  const auto key = [](const RunResult& run) {
    const RunSettings& s = run.settings;
    return std::tie(s.form, s.integrator, s.gauge, s.project);
  };
  std::vector<std::size_t> first(study.runs.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    std::size_t j = 0;
    while (key(study.runs[j]) != key(study.runs[i])) ++j;
    first[i] = j;
  }
  return first;
}

std::vector<std::size_t> runs_with_curves(const StudyResult& study) {
  const auto first = ladders(study);
  std::vector<std::size_t> drawn;
  for (std::size_t i = 0; i < study.runs.size(); ++i) {
    if (study.drift_study || first[i] == i) drawn.push_back(i);
  }
  return drawn;
}

}  // namespace momenta
