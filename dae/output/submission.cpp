#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/submission.h>
#include <sys/utsname.h>

#include <cctype>
#include <cmath>

namespace momenta {
namespace {

/// Lower-case letters and digits, others as one "-".
std::string for_a_file(const std::string& name) {
  std::string text;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)))
      text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (!text.empty() && text.back() != '-')
      text += '-';
  }
  while (!text.empty() && text.back() == '-') text.pop_back();
  return text;
}

std::string operating_system() {
  utsname here{};
  if (uname(&here) != 0) return "not known";
  return std::string(here.sysname) + " " + here.release + " " + here.machine;
}

std::string method(const RunSettings& s) {
  std::string text =
      "form " + s.form + ", integrator " + s.integrator + ", rtol = atol = " + compact(s.rtol, 2);
  if (s.project) text += ", positions corrected after each step";
  if (!s.gauge.empty() && s.gauge != "none") text += ", gauge " + s.gauge;
  if (s.baumgarte_alpha > 0 || s.baumgarte_beta > 0)
    text += ", Baumgarte alpha = " + compact(s.baumgarte_alpha, 4) +
            "/s, beta = " + compact(s.baumgarte_beta, 4) + "/s";
  return text;
}

std::string command(const SceneProblemResult& p, const RunSettings& s) {
  std::string text = "momenta run " + p.scene;
  for (const Setting& setting : p.set)
    text += " --set " + setting.place + "=" + round_trip(setting.value);
  text += " --form " + s.form + " --integrator " + s.integrator + " --rtol " + compact(s.rtol, 2) +
          " --atol " + compact(s.atol, 2) + " --end " + compact(p.end, 8) + " --samples " +
          std::to_string(p.samples);
  if (!s.gauge.empty()) text += " --gauge " + s.gauge;
  text += s.project ? " --project" : " --no-project";
  return text + " --out solution";
}

std::string text_of(const SceneProblemResult& p, const RunResult& run, double error,
                    const Environment& made) {
  const std::string accuracy =
      compact(error, 3) + (p.error == BenchmarkError::Kind::threshold
                               ? " (mean error with threshold " + compact(p.threshold, 2) + ")"
                               : " (largest mixed error)");
  std::string versions;
  for (const auto& [library, version] : made.versions)
    versions += (versions.empty() ? "" : ", ") + library + " " + version;
  return "Solution for " + p.name + "\nAuthors:\nEmail:\nAccuracy: " + accuracy + " over " +
         std::to_string(p.samples) + " outputs to " + compact(p.end, 8) + " s; position drift " +
         compact(run.position_drift_max, 2) + ", energy error " + compact(run.energy_error_max, 2) +
         " J\nCPU time: " + (std::isnan(run.cpu_s) ? "not taken" : compact(run.cpu_s, 3) + " s") +
         "\nCPU / GPU: " + made.cpu + ", one core\nOperating System: " + operating_system() +
         "\nMethod description: " + method(run.settings) + "; " +
         std::to_string(run.counters.steps) + " steps, " + std::to_string(run.counters.rejected) +
         " rejected, " + std::to_string(run.counters.evaluations) +
         " evaluations. Reference: " + p.reference + ". " + versions + ", " + made.compiler + ", " +
         made.build_type + "\nMade by: " + command(p, run.settings) + "\n";
}

}  // namespace

std::vector<std::pair<std::string, std::string>> submissions(const SceneSuiteResult& suite,
                                                             const Environment& environment) {
  std::vector<std::pair<std::string, std::string>> files;
  for (std::size_t k = 0; k < suite.problems.size(); ++k) {
    const SceneProblemResult& p = suite.problems[k];
    for (const double allowed : p.allowed) {
      const std::size_t best = cheapest_within(p, allowed);
      if (best >= p.runs.size()) continue;
      files.emplace_back("submission-" + std::to_string(k + 1) + "-" + for_a_file(p.name) + "-" +
                             compact(allowed, 2) + ".txt",
                         text_of(p, p.runs[best], p.errors[best], environment));
    }
  }
  return files;
}

}  // namespace momenta
