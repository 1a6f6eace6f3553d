#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/conclusion.h>
#include <momenta/dae/output/run_label.h>
#include <momenta/dae/run/departures.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <optional>

namespace momenta {
namespace {

struct Named {
  const RunResult* run;
  std::string name;  // in backquotes
  bool by_angles = false;
};

// Runs are compared by their drift of lengths, or of angles if lengths are at rounding level in all
// runs and angles are not.
double judged(const Named& n) {
  return n.by_angles ? n.run->angle_drift_max : n.run->position_drift_max;
}
std::string unit_of(const Named& n) {
  return n.by_angles ? "rad" : drift_unit(*n.run);
}
std::string amount(const Named& n, double value) {
  return unit_of(n) == "m" ? length_text(value) : compact(value, 2) + " rad";
}
// Drift, with angles beside lengths.
std::string amount(const Named& n) {
  const bool both = !n.by_angles && !std::isnan(n.run->angle_drift_max);
  return amount(n, judged(n)) + (both ? " and " + compact(n.run->angle_drift_max, 2) + " rad" : "");
}
// Drifts at this level are not compared.
bool is_rounding(const Named& n) {
  return judged(n) < (n.by_angles ? n.run->angle_rounding : n.run->drift_rounding);
}
void choose_drift(std::vector<Named>& runs) {
  const bool lengths = std::any_of(runs.begin(), runs.end(), [](const Named& n) {
    return n.run->position_drift_max >= n.run->drift_rounding;
  });
  const bool angles = std::any_of(runs.begin(), runs.end(), [](const Named& n) {
    return n.run->angle_drift_max >= n.run->angle_rounding;
  });
  for (Named& n : runs) n.by_angles = !lengths && angles;
}

bool same_method(const RunSettings& a, const RunSettings& b) {
  return a.integrator == b.integrator && a.step == b.step && a.rtol == b.rtol && a.atol == b.atol &&
         a.end_time == b.end_time;
}

bool gauged(const RunSettings& s) {
  return !s.gauge.empty() && s.gauge != "none";
}

std::string seconds(double t) {
  return compact(t, 4) + " s";
}

// A reason within a sentence, without its full stop.
std::string clause(std::string reason) {
  while (!reason.empty() && (reason.back() == '.' || reason.back() == ' ')) reason.pop_back();
  return reason;
}

// The largest drift is the gap of loops only if it is there at the end.
bool largest_at_the_end(const Named& n) {
  const auto& all = n.by_angles ? n.run->series.angle_drift : n.run->series.position_drift;
  return all.empty() || !(std::abs(all.back()) < 0.9 * judged(n));
}

std::string growth_clause(const Named& n) {
  const Growth& g = n.by_angles ? n.run->angle_growth : n.run->position_growth;
  if (is_rounding(n) || std::isnan(judged(n)) || std::isnan(g.exponent)) return "";
  if (!g.is_power()) {
    return ", not as a power of t (slopes " + compact(g.exponent - g.half_range, 2) + " to " +
           compact(g.exponent + g.half_range, 2) + ")";
  }
  // 0.05: half range of a flat noisy maximum; smaller exponents are noise.
  if (std::abs(g.exponent) < 0.05) return ", without growing further";
  return ", growing like t^" + fixed(g.exponent, 2);
}

std::string drift_text(const Named& n) {
  return is_rounding(n) ? "rounding level (" + amount(n) + ")" : amount(n);
}

// "After 1000 s the position drift of `a` is 0.27 m, growing like t^1.98"
std::string drift_clause(const Named& n) {
  const std::string start =
      "After " + seconds(n.run->status == "event" ? n.run->stopped_at : n.run->settings.end_time) +
      " the position drift of " + n.name;
  if (is_rounding(n)) return start + " is at " + drift_text(n);
  return start + (largest_at_the_end(n) ? " is " : " reached ") + amount(n) + growth_clause(n);
}

// "`b` 3.5 µm, like t^1.01", after drift_clause() in a sentence.
std::string tail(const Named& n, bool growth_was_said) {
  std::string growth = growth_clause(n);
  const std::string said = ", growing like ";
  if (growth_was_said && growth.rfind(said, 0) == 0)
    growth = ", like " + growth.substr(said.size());
  return n.name + ' ' + (is_rounding(n) ? "stays at " : "") + drift_text(n) + growth;
}

// Two decimals near one, else two digits.
std::string ratio_text(double ratio) {
  return ratio >= 0.1 && ratio < 10 ? fixed(ratio, 2) : compact(ratio, 2);
}

std::string cost_clause(const RunResult& a, const RunResult& b) {
  if (a.cpu_s > 0 && b.cpu_s > 0) {
    const double ratio = b.cpu_s / a.cpu_s;
    if (std::abs(ratio - 1) < 0.005) return ", at equal cost";
    return (ratio > 1.1 ? ", and is slower: " : ", at ") + ratio_text(ratio) + " times the cost";
  }
  if (a.counters.evaluations > 0 && b.counters.evaluations > 0) {
    const double ratio =
        static_cast<double>(b.counters.evaluations) / static_cast<double>(a.counters.evaluations);
    return ", with " + ratio_text(ratio) + " times the evaluations";
  }
  return "";
}

struct Pair {
  Named acceleration, momentum;
};

// For the first sentence: plain forms (no projection) by one method, a momentum run with its gauge
// first; of a ladder, the tightest tolerance at which both finished.
std::optional<Pair> compared_pair(const std::vector<Named>& runs) {
  std::optional<Pair> best;
  const auto better = [](const Pair& a, const Pair& b) {
    const bool ga = gauged(a.momentum.run->settings), gb = gauged(b.momentum.run->settings);
    if (ga != gb) return ga;
    const RunSettings &sa = a.momentum.run->settings, &sb = b.momentum.run->settings;
    return sa.step > 0 && sb.step > 0 ? sa.step < sb.step : sa.rtol < sb.rtol;
  };
  for (const Named& a : runs) {
    if (a.run->settings.form != "acceleration" || a.run->settings.project) continue;
    for (const Named& m : runs) {
      if (m.run->settings.form != "momentum" || m.run->settings.project) continue;
      if (!same_method(a.run->settings, m.run->settings)) continue;
      const Pair pair{a, m};
      if (!best || better(pair, *best)) best = pair;
    }
  }
  return best;
}

std::string pair_sentence(const Pair& pair) {
  const RunResult &a = *pair.acceleration.run, &m = *pair.momentum.run;
  std::string text = drift_clause(pair.acceleration) + "; " +
                     tail(pair.momentum, growth_clause(pair.acceleration).find("growing like") !=
                                             std::string::npos);
  if (!gauged(m.settings)) text += " (no gauge)";
  const double drift_a = judged(pair.acceleration), drift_m = judged(pair.momentum);
  if (!is_rounding(pair.momentum) && drift_m > 1.1 * drift_a) {
    text += drift_a > 0 ? ", which is worse, " + ratio_text(drift_m / drift_a) + " times as much"
                        : ", which is worse";
  }
  return text + cost_clause(a, m) + ".";
}

double score(double value, double floor) {
  return std::isnan(value) ? 0 : std::log10(std::max(value, floor));
}

std::string first_sentence(const std::vector<Named>& done) {
  std::vector<Named> drifting;
  std::copy_if(done.begin(), done.end(), std::back_inserter(drifting),
               [](const Named& n) { return !std::isnan(judged(n)); });
  if (const auto pair = compared_pair(drifting)) return pair_sentence(*pair);
  if (drifting.empty()) {
    return "Position drift was not measured: there are no loops.";
  }
  const auto less = [](const Named& x, const Named& y) { return judged(x) < judged(y); };
  const Named best = *std::min_element(drifting.begin(), drifting.end(), less);
  const Named worst = *std::max_element(drifting.begin(), drifting.end(), less);
  if (drifting.size() == 1) return drift_clause(best) + ".";
  if (is_rounding(worst)) {
    return "After " + seconds(worst.run->settings.end_time) + " the position drift of all " +
           std::to_string(drifting.size()) + " finished runs is at rounding level (" +
           amount(worst, judged(worst)) + " at most).";
  }
  const bool said = growth_clause(worst).find("growing like") != std::string::npos;
  return drift_clause(worst) + ", the most of " + std::to_string(drifting.size()) +
         " finished runs; " + tail(best, said) + ", the least.";
}

std::string time_clause(const RunResult& run) {
  return std::isnan(run.cpu_s) ? "" : " in " + time_text(run.cpu_s) + " of processor time";
}

// " with dop853", unless the name has it.
std::string with_integrator(const Named& n) {
  const std::string& integrator = n.run->settings.integrator;
  return n.name.find(", " + integrator) == std::string::npos ? " with " + integrator : "";
}

std::string best_sentence(const std::vector<Named>& done) {
  const auto best_by = [&](auto measure) -> std::optional<Named> {
    std::optional<Named> best;
    for (const Named& n : done) {
      if (std::isnan(measure(n))) continue;
      if (!best || measure(n) < measure(*best)) best = n;
    }
    return best;
  };
  if (const auto best = best_by([](const Named& n) { return n.run->position_error_max; })) {
    return (done.size() == 1 ? "Against the reference its error is "
                             : "Closest to the reference is " + best->name +
                                   with_integrator(*best) + ": error ") +
           scientific(best->run->position_error_max, 2) + time_clause(*best->run) + ".";
  }
  // Without a reference drift [m] times energy error [J] is compared.
  const auto both = best_by([](const Named& n) {
    if (std::isnan(judged(n)) && std::isnan(n.run->energy_error_max)) return not_measured;
    return score(judged(n), 1e-16) + score(n.run->energy_error_max, 1e-16);
  });
  if (!both) return "";
  const RunResult& r = *both->run;
  const std::string energy = std::isnan(r.energy_error_max)
                                 ? ""
                                 : "energy within " + scientific(r.energy_error_max, 2) + " J";
  if (done.size() == 1) {
    if (energy.empty())
      return std::isnan(r.cpu_s) ? "" : "It took " + time_text(r.cpu_s) + " of processor time.";
    return "It kept its " + energy + time_clause(r) + "; there is no reference to compare with.";
  }
  std::string least = std::isnan(judged(*both)) ? "" : "drift " + amount(*both);
  if (!least.empty() && !energy.empty()) least += ", ";
  return "Without a reference, the least drift times energy error is that of " + both->name +
         with_integrator(*both) + ": " + least + energy + time_clause(r) + ".";
}

std::string failed_clause(const Named& n) {
  return n.name + (n.run->status == "time limit" ? " reached its time limit at " : " stopped at ") +
         seconds(n.run->stopped_at) +
         (n.run->reason.empty() || n.run->status == "time limit"
              ? ""
              : " (" + clause(n.run->reason) + ")");
}

std::string failed_sentence(const std::vector<Named>& failed, std::size_t total) {
  constexpr std::size_t named = 3;  // more are a list: the tables have all
  std::string text;
  if (total == 1) {
    text = "The run did not finish: ";
  } else if (failed.size() == total) {
    text = "None of the " + std::to_string(total) + " runs finished: ";
    if (std::all_of(failed.begin(), failed.end(), [&](const Named& n) {
          const RunResult &a = *n.run, &b = *failed.front().run;
          return a.reason == b.reason && a.status == b.status && a.stopped_at == b.stopped_at;
        }))
      return text + clause(failed.front().run->reason) + ".";
  } else {
    text =
        std::to_string(failed.size()) + " of " + std::to_string(total) + " runs did not finish: ";
  }
  for (std::size_t i = 0; i < std::min(named, failed.size()); ++i) {
    if (i > 0) text += "; ";
    text += failed_clause(failed[i]);
  }
  if (failed.size() > named) text += "; and " + std::to_string(failed.size() - named) + " more";
  return text + ".";
}

template <class Takes>
std::vector<Named> runs_where(const StudyResult& study, Takes takes) {
  const auto labels = run_labels(study);
  std::vector<Named> runs;
  for (std::size_t i = 0; i < study.runs.size(); ++i) {
    if (takes(study.runs[i])) runs.push_back({&study.runs[i], '`' + labels[i] + '`'});
  }
  return runs;
}

std::string as_sentence(std::string clause) {
  clause.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(clause.front())));
  return clause + ".";
}

}  // namespace

std::string reservations(const StudyResult& study) {
  const auto off =
      runs_where(study, [](const RunResult& r) { return finished(r) && !reliable(r); });
  std::string text;
  if (study.runs.size() == 1 && !off.empty()) {
    text = as_sentence(off.front().run->departure);
  } else if (!off.empty()) {
    constexpr std::size_t named = 3;
    text = std::to_string(off.size()) + " of " + std::to_string(study.runs.size()) +
           " runs are done and not to be relied on, and are not compared: ";
    for (std::size_t i = 0; i < std::min(named, off.size()); ++i)
      text += (i > 0 ? "; " : "") + off[i].name + ", " + off[i].run->departure;
    if (off.size() > named) text += "; and " + std::to_string(off.size() - named) + " more";
    text += ".";
  }
  if (const Ambiguity ambiguity = ambiguity_of(study.runs); ambiguity.differ)
    text += (text.empty() ? "" : " ") + as_sentence(in_words(ambiguity));
  return text;
}

std::string answer(const StudyResult& study) {
  if (study.runs.empty()) return "No run was made.";
  auto done = runs_where(study, reliable);
  std::string text = reservations(study);
  if (done.empty() || ambiguity_of(study.runs).differ) return text;
  choose_drift(done);
  for (const std::string& sentence : {first_sentence(done), best_sentence(done)})
    if (!sentence.empty()) text += (text.empty() ? "" : " ") + sentence;
  return text;
}

std::string failures(const StudyResult& study) {
  const auto failed = runs_where(study, [](const RunResult& r) { return !finished(r); });
  return failed.empty() ? "" : failed_sentence(failed, study.runs.size());
}

std::string conclusion(const StudyResult& study) {
  const std::string first = answer(study), last = failures(study);
  return first + (first.empty() || last.empty() ? "" : " ") + last;
}

}  // namespace momenta
