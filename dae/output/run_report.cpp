#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/advice.h>
#include <momenta/dae/output/conclusion.h>
#include <momenta/dae/output/run_report.h>
#include <momenta/dae/output/table.h>
#include <momenta/dae/run/measure/rank.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/topology/assembly/start_accelerations.h>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace momenta {
namespace {

/// The first `most` of them.
std::string first_of(const std::vector<std::string>& all, std::size_t most, const char* between) {
  std::string text;
  for (std::size_t i = 0; i < all.size() && i < most; ++i) text += (i == 0 ? "" : between) + all[i];
  return text;
}

std::string singular_poses(const RunResult& result) {
  constexpr std::size_t most = 12;
  const auto& crossings = result.singular_crossings;
  if (crossings.empty()) return "";
  std::vector<std::string> times;
  for (const RunResult::SingularCrossing& crossing : crossings)
    times.push_back(compact(crossing.t, 4));
  std::string text = "\nClose to singular poses at t = " + first_of(times, most, ", ") +
                     (times.size() > most ? ", …" : "") + " s, least pivot " +
                     scientific(result.least_pivot, 1) + "\n";
  const auto ambiguous =
      std::find_if(crossings.begin(), crossings.end(), [](const auto& c) { return c.ambiguous; });
  if (ambiguous != crossings.end()) text += "Ambiguous: " + ambiguous_from(ambiguous->t) + "\n";
  return text;
}

/// Rank at the start, what redundant equations leave, and singular poses of the run.
std::string ranks(const Mechanism& mechanism, const Assembly& a, const RunResult& result) {
  std::string text;
  if (a.rank < mechanism.m()) {
    constexpr std::size_t most = 6;
    std::vector<std::string> rows;
    for (const int row : a.dependent_rows) rows.push_back(row_in_words(mechanism, row));
    text += "\nLoop equations: rank " + std::to_string(a.rank) + " of " +
            std::to_string(mechanism.m()) +
            " at the start, redundant: " + first_of(rows, most, "; ") +
            (rows.size() > most ? "; …" : "") + "\n";
  }
  if (!a.residue.empty()) text += "\n" + a.residue + "\n";
  if (result.weak_evaluations > 0)
    text += "\nNear a singular pose, or with equations that are nearly redundant, in " +
            std::to_string(result.weak_evaluations) + " of " +
            std::to_string(result.counters.evaluations) +
            " right-hand sides: more loop equations faded there than are redundant at the start "
            "(faded_rows)\n";
  return text;
}

/// "C.lambda1, C.lambda2": columns that are not unique, and at how many samples.
std::string undetermined(const RunResult& result) {
  std::map<long, std::string> by_samples;
  for (const RunResult::Undetermined& u : result.undetermined) {
    std::string& names = by_samples[u.samples];
    names += (names.empty() ? "" : ", ") + u.column.substr(0, u.column.rfind(" ["));
  }
  std::string text;
  for (const auto& [samples, names] : by_samples)
    text += "\nNot unique at " +
            (samples == static_cast<long>(result.series.t.size())
                 ? "any sample"
                 : std::to_string(samples) + " samples") +
            ": " + names + "\n";
  return text;
}

/// Events with number and times.
std::string events(const Scene& scene, const RunResult& result) {
  constexpr std::size_t most = 8;
  std::string text = scene.events.empty() ? "" : "\n";
  for (std::size_t i = 0; i < scene.events.size(); ++i) {
    const std::string name = name_of(scene.events[i], i);
    std::vector<std::string> times;
    for (const FoundEvent& e : result.events)
      if (e.name == name) times.push_back(compact(e.t, 8) + (e.up ? " up" : " down"));
    text += "Event '" + name + "': " +
            (times.empty() ? "not met"
                           : std::to_string(times.size()) + ", at t [s] = " +
                                 first_of(times, most, ", ") + (times.size() > most ? ", …" : "")) +
            "\n";
  }
  if (result.status == "event") text += result.reason + "\n";
  return text;
}

/// Impacts of rigid stops, and times at which they held their coordinates.
std::string stops(const RunResult& result) {
  std::map<std::pair<std::string, double>, std::vector<const StopContact*>> by_stop;
  for (const StopContact& s : result.stops) by_stop[{s.joint, s.limit}].push_back(&s);
  std::string text = by_stop.empty() ? "" : "\n";
  for (const auto& [stop, all] : by_stop) {
    std::size_t impacts = 0;
    std::string first, held;
    for (const StopContact* s : all) {
      if (s->what == "impact" && impacts++ == 0) first = compact(s->t, 8);
      if (s->what == "held") held += (held.empty() ? "" : ", ") + compact(s->t, 8) + " s";
      if (s->what == "released") held += " to " + compact(s->t, 8) + " s";
    }
    text += "Stop of joint '" + stop.first + "' at " + compact(stop.second, 6) + ": " +
            std::to_string(impacts) + " impacts" +
            (first.empty() ? "" : ", the first at t = " + first + " s") +
            (held.empty() ? "" : "; held from t = " + held) + "\n";
  }
  return text;
}

}  // namespace

std::string integrated_in_words(const StudyResult& study) {
  if (study.runs.empty() || study.runs.front().integrated.empty()) return "";
  return "\nIntegrated in place of the scene as written, for less work: " +
         study.runs.front().integrated + " (--cut scene: as written)\n";
}

std::string run_report(const StudyResult& study, const Mechanism& mechanism,
                       const Assembly& assembly) {
  const RunResult& result = study.runs.front();
  std::string text = reservations(study);
  if (!text.empty()) text += "\n\n";
  text += drift_table(study) + integrated_in_words(study) + ranks(mechanism, assembly, result) +
          singular_poses(result) + undetermined(result) + events(mechanism.scene(), result) +
          stops(result);
  if (const std::string stiff = stiffness_in_words(result); !stiff.empty())
    text += "\n" + stiff + "\n";
  if (!assembly.branch.empty()) text += "Started from " + assembly.branch + "\n";
  return text;
}

}  // namespace momenta
