#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/output/json.h>
#include <momenta/dae/output/stress_report.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

std::string label(const Contestant& c) {
  return c.form + ", " + c.integrator;
}

/// "ok 2.1e-9", "wrong 3e-1", "stopped 0.31 s"
std::string verdict_text(const StressRun& r) {
  switch (r.verdict) {
    case Verdict::survived:
    case Verdict::wrong:
      return std::string(r.verdict == Verdict::wrong ? "wrong " : "ok ") +
             scientific(worst_measure(r), 1);
    case Verdict::stopped:
    case Verdict::slow:
      return std::string(name_of(r.verdict)) + " " + compact(r.at, 2) + " s";
    case Verdict::untried:
      break;
  }
  return "";
}

}  // namespace

double worst_measure(const StressRun& r) {
  double worst = not_measured;
  for (const double x : {r.position_drift, r.angle_drift, r.energy, r.error})
    if (std::isfinite(x) && !(x <= worst)) worst = x;
  return worst;
}

Tally tally(const StressResult& study, std::size_t contestant) {
  const auto common = [](const LadderResult& ladder) {
    return std::none_of(ladder.runs.begin(), ladder.runs.end(),
                        [](const auto& climb) { return climb.empty(); });
  };
  const bool any = std::any_of(study.ladders.begin(), study.ladders.end(), common);
  Tally t;
  for (const LadderResult& ladder : study.ladders) {
    if (any && !common(ladder)) continue;
    t.rungs +=
        static_cast<int>(std::count(ladder.refused.begin(), ladder.refused.end(), std::string()));
    for (const StressRun& r : ladder.runs[contestant]) {
      t.survived += r.verdict == Verdict::survived;
      t.wrong += r.verdict == Verdict::wrong;
      t.stopped += r.verdict == Verdict::stopped;
      t.slow += r.verdict == Verdict::slow;
    }
  }
  return t;
}

std::string stress_table(const StressResult& study) {
  std::string text;
  std::size_t name_width = 10;
  for (const Contestant& c : study.contestants) name_width = std::max(name_width, width(label(c)));
  for (const LadderResult& ladder : study.ladders) {
    std::vector<std::size_t> widths;
    for (std::size_t k = 0; k < ladder.rungs.size(); ++k) {
      std::size_t w = width(ladder.rungs[k]);
      for (const auto& climb : ladder.runs)
        for (const StressRun& r : climb)
          if (r.rung == static_cast<int>(k)) w = std::max(w, width(verdict_text(r)));
      widths.push_back(w + 2);
    }
    std::string line = "  " + padded("", name_width + 2);
    for (std::size_t k = 0; k < widths.size(); ++k) line += padded(ladder.rungs[k], widths[k]);
    text += ladder.name + "\n" + line + "\n";
    for (std::size_t c = 0; c < study.contestants.size(); ++c) {
      if (ladder.runs[c].empty()) continue;
      std::vector<std::string> cells(widths.size());
      for (const StressRun& r : ladder.runs[c])
        cells[static_cast<std::size_t>(r.rung)] = verdict_text(r);
      line = "  " + padded(label(study.contestants[c]), name_width + 2);
      for (std::size_t k = 0; k < widths.size(); ++k) line += padded(cells[k], widths[k]);
      line.erase(line.find_last_not_of(' ') + 1);
      text += line + "\n";
    }
    for (std::size_t k = 0; k < ladder.refused.size(); ++k)
      if (!ladder.refused[k].empty())
        text += "  " + ladder.rungs[k] + " has no start: " + ladder.refused[k] + "\n";
    text += "\n";
  }
  text +=
      padded("Ladders of all", name_width + 4) + "survived   wrong in silence   stopped   slow\n";
  for (std::size_t c = 0; c < study.contestants.size(); ++c) {
    const Tally t = tally(study, c);
    if (t.tried() == 0) continue;
    text += "  " + padded(label(study.contestants[c]), name_width + 2) +
            padded(std::to_string(t.survived) + " of " + std::to_string(t.rungs), 11) +
            padded(std::to_string(t.wrong), 19) + padded(std::to_string(t.stopped), 10) +
            std::to_string(t.slow) + "\n";
  }
  text += "\nFailures\n";
  for (const LadderResult& ladder : study.ladders)
    for (const auto& climb : ladder.runs)
      for (const StressRun& r : climb)
        if (r.verdict != Verdict::survived)
          text += "  " + ladder.name + ", " + ladder.rungs[static_cast<std::size_t>(r.rung)] +
                  ": " + label(r.contestant) + " " + name_of(r.verdict) + ": " + r.cause + "\n";
  return text;
}

std::string stress_csv(const StressResult& study) {
  std::string text =
      "ladder,rung,form,integrator,gauge,project,rtol,step [s],end_time [s],verdict,cause,at [s],"
      "position_drift,velocity_drift,angle_drift,angle_rate_drift,energy,error,reference_accuracy,"
      "steps,evaluations,cpu [s]\n";
  for (const LadderResult& ladder : study.ladders)
    for (const auto& climb : ladder.runs)
      for (const StressRun& r : climb) {
        const auto k = static_cast<std::size_t>(r.rung);
        const RunSettings& s = r.run.settings;
        text += csv_cell(ladder.name) + "," + csv_cell(ladder.rungs[k]) + "," + s.form + "," +
                s.integrator + "," + s.gauge + "," + (s.project ? "true" : "false") + "," +
                round_trip(s.rtol) + "," + round_trip(s.step) + "," + round_trip(s.end_time) + "," +
                name_of(r.verdict) + "," + csv_cell(r.cause) + "," + round_trip(r.at) + "," +
                round_trip(r.position_drift) + "," + round_trip(r.velocity_drift) + "," +
                round_trip(r.angle_drift) + "," + round_trip(r.angle_rate_drift) + "," +
                round_trip(r.energy) + "," + round_trip(r.error) + "," +
                round_trip(ladder.reference[k]) + "," + std::to_string(r.run.counters.steps) + "," +
                std::to_string(r.run.counters.evaluations) + "," + round_trip(r.run.cpu_s) + "\n";
      }
  return text;
}

nlohmann::ordered_json stress_json(const StressResult& study) {
  Json j;
  j["command"] = study.command;
  j["bound"] = study.bound;
  j["rtol"] = study.rtol;
  j["cpu_limit_s"] = study.cpu_limit;
  j["complete"] = study.complete;
  j["contestants"] = Json::array();
  for (std::size_t c = 0; c < study.contestants.size(); ++c) {
    const Tally t = tally(study, c);
    j["contestants"].push_back({{"form", study.contestants[c].form},
                                {"integrator", study.contestants[c].integrator},
                                {"rungs", t.rungs},
                                {"survived", t.survived},
                                {"wrong", t.wrong},
                                {"stopped", t.stopped},
                                {"slow", t.slow}});
  }
  j["ladders"] = Json::array();
  for (const LadderResult& ladder : study.ladders) {
    Json l{{"name", ladder.name}, {"rising", ladder.rising}, {"rungs", Json::array()}};
    for (std::size_t k = 0; k < ladder.rungs.size(); ++k)
      l["rungs"].push_back({{"label", ladder.rungs[k]},
                            {"end_time_s", ladder.end_time[k]},
                            {"refused", ladder.refused[k]},
                            {"reference_accuracy", number_or_null(ladder.reference[k])}});
    l["runs"] = Json::array();
    for (const auto& climb : ladder.runs)
      for (const StressRun& r : climb)
        l["runs"].push_back({{"rung", ladder.rungs[static_cast<std::size_t>(r.rung)]},
                             {"form", r.run.settings.form},
                             {"integrator", r.run.settings.integrator},
                             {"gauge", r.run.settings.gauge},
                             {"project", r.run.settings.project},
                             {"step", r.run.settings.step},
                             {"verdict", name_of(r.verdict)},
                             {"cause", r.cause},
                             {"at", number_or_null(r.at)},
                             {"position_drift", number_or_null(r.position_drift)},
                             {"velocity_drift", number_or_null(r.velocity_drift)},
                             {"angle_drift", number_or_null(r.angle_drift)},
                             {"angle_rate_drift", number_or_null(r.angle_rate_drift)},
                             {"opening", number_or_null(r.position_drift)},     // deprecated
                             {"loop_speed", number_or_null(r.velocity_drift)},  // deprecated
                             {"energy", number_or_null(r.energy)},
                             {"error", number_or_null(r.error)},
                             {"steps", r.run.counters.steps},
                             {"evaluations", r.run.counters.evaluations},
                             {"cpu_s", number_or_null(r.run.cpu_s)}});
    j["ladders"].push_back(std::move(l));
  }
  j["environment"] = environment_json(study.environment);
  return j;
}

}  // namespace momenta
