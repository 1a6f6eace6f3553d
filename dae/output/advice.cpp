#include <momenta/core/text/number_text.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/output/advice.h>
#include <momenta/dae/output/run_label.h>
#include <momenta/dae/run/departures.h>
#include <momenta/dae/study/work_study.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace momenta {

namespace {

/// Options for a run by BDF, whose memory allows no change of the state.
std::string implicit_instead(const RunSettings& s) {
  if (needs_one_step_method(s.form)) return "--form momentum --integrator bdf";
  const bool altering = s.gauge == "reset" || s.gauge == "flip";
  return std::string("--integrator bdf") + (altering ? " --gauge leak" : "");
}

}  // namespace

std::string stiffness_in_words(const RunResult& run) {
  if (std::isnan(run.stiff_from)) return "";
  const RunSettings& s = run.settings;
  const std::string from =
      "Stiff from t = " + compact(run.stiff_from, 4) + " s: steps of " + s.integrator;
  if (changed(run))
    return from + " became as long as its stability allows, shorter than its tolerance asks for; " +
           s.when_stiff + " went on from t = " + compact(run.changed_at, 4) + " s (--integrator " +
           s.integrator + ": no change)";
  return from +
         " are as long as its stability allows, shorter than its tolerance asks for; implicit "
         "methods take fewer: " +
         implicit_instead(s) + ", or a form by ida";
}

namespace {

constexpr std::array<double, 5> targets{1e-4, 1e-6, 1e-8, 1e-10, 1e-12};
constexpr std::size_t others_named = 3;

std::string method(const RunResult& run, const std::string& label) {
  std::string text = "`" + label + "`";
  if (label.find(run.settings.integrator) == std::string::npos)
    text += " with " + run.settings.integrator;
  return text;
}

}  // namespace

std::string advice(const StudyResult& study) {
  if (ambiguity_of(study.runs).differ) return "";
  const bool reference = !study.reference.empty();
  const auto labels = run_labels(study, false);
  if (std::none_of(study.runs.begin(), study.runs.end(),
                   [](const RunResult& run) { return std::isfinite(run.cpu_s); }))
    return "Runs were not timed, so none can be named that takes least.\n";
  std::string text;
  for (const double target : targets) {
    const std::string wanted = scientific(target, 1);
    // Cheapest run of every form that reaches the target.
    std::vector<std::size_t> best;
    for (std::size_t i = 0; i < study.runs.size(); ++i) {
      const RunResult& run = study.runs[i];
      if (run.status != "done" || !reliable(run) || !(judged_error(run, reference) <= target) ||
          !std::isfinite(run.cpu_s))
        continue;
      const auto same = std::find_if(best.begin(), best.end(), [&](std::size_t j) {
        return study.runs[j].settings.form == run.settings.form;
      });
      if (same == best.end())
        best.push_back(i);
      else if (run.cpu_s < study.runs[*same].cpu_s)
        *same = i;
    }
    if (best.empty()) {
      text += "No run reaches " + wanted + ".\n";
      break;
    }
    std::sort(best.begin(), best.end(), [&](std::size_t a, std::size_t b) {
      return study.runs[a].cpu_s < study.runs[b].cpu_s;
    });
    const RunResult& first = study.runs[best[0]];
    text += std::string(reference ? "For an error of " : "For a drift of ") + wanted + " take " +
            method(first, labels[best[0]]) + " at " + tolerance_text(first.settings) + ": " +
            time_text(first.cpu_s);
    for (std::size_t k = 1; k < std::min(best.size(), 1 + others_named); ++k) {
      const RunResult& other = study.runs[best[k]];
      text += std::string(k == 1 ? "; then " : ", ") + method(other, labels[best[k]]) + " times " +
              fixed(other.cpu_s / first.cpu_s, other.cpu_s < 10 * first.cpu_s ? 1 : 0);
    }
    text += ".\n";
  }
  return text;
}

}  // namespace momenta
