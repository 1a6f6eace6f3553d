#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/run_label.h>
#include <momenta/dae/output/table.h>
#include <momenta/dae/run/measure/growth.h>
#include <momenta/dae/run/run_quantities.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace momenta {

namespace {

constexpr std::size_t text_columns = 5;  // left-aligned; numbers are right-aligned
using Row = std::vector<std::string>;

constexpr std::ptrdiff_t after_drifts = 7;

std::string growth(const Growth& g) {
  if (std::isnan(g.exponent)) return "-";
  if (!g.is_power()) return "no power";
  const double exponent = std::abs(g.exponent) < 0.005 ? 0 : g.exponent;  // no −0.00
  if (std::isnan(g.half_range)) return fixed(exponent, 2);
  return fixed(exponent, 2) + "±" + fixed(g.half_range, 2).substr(1);  // below 0.5
}

std::string count(long n) {
  return n < 10'000'000 ? std::to_string(n) : scientific(static_cast<double>(n), 3);
}

/// `both`: drifts of angles too.
Row row_of(const RunResult& run, bool both) {
  const RunSettings& s = run.settings;
  Row row{s.form + (s.project ? "+project" : ""),
          s.integrator + (changed(run) ? "," + s.when_stiff : ""),
          s.gauge.empty() ? "-" : s.gauge,
          s.step > 0 ? "h=" + compact(s.step, 3) : tolerance_text(s),
          run.status == "time limit" ? "limit" : run.status,
          scientific(run.position_drift_max, 2),
          scientific(run.velocity_drift_max, 2),
          scientific(run.energy_error_max, 2),
          growth(run.position_growth),
          growth(run.velocity_growth),
          scientific(run.position_error_max, 2),
          count(run.counters.steps),
          count(run.counters.evaluations),
          compact(run.cpu_s, 3)};
  if (both)
    row.insert(row.begin() + after_drifts,
               {scientific(run.angle_drift_max, 2), scientific(run.angle_rate_drift_max, 2)});
  return row;
}

}  // namespace

std::string drift_table(const StudyResult& study) {
  const std::string unit = study.runs.empty() ? "m" : drift_unit(study.runs.front());
  const bool both = std::any_of(study.runs.begin(), study.runs.end(), has_both_drifts);
  std::vector<Row> rows{{"", "integ-", "", "tol or", "", "pos.", "vel.", "energy", "growth",
                         "growth", "error", "", "evalu-", ""},
                        {"", "rator", "", "step", "", "drift", "drift", "error", "pos.", "vel.",
                         "to", "", "ations", "CPU"},
                        {"form", "", "gauge", "", "status", "[" + unit + "]", "[" + unit + "/s]",
                         "[J]", "t^", "t^", "ref.", "steps", "", "[s]"}};
  if (both) {
    const char* const more[3][2]{{"angle", "rate"}, {"drift", "drift"}, {"[rad]", "[rad/s]"}};
    for (std::size_t i = 0; i < 3; ++i)
      rows[i].insert(rows[i].begin() + after_drifts, {more[i][0], more[i][1]});
  }
  for (const RunResult& run : study.runs) rows.push_back(row_of(run, both));

  const std::size_t error = rows.front().size() - 4;  // before steps, evaluations and CPU time
  if (std::all_of(rows.begin() + 3, rows.end(), [&](const Row& row) { return row[error] == "-"; }))
    for (Row& row : rows) row.erase(row.begin() + static_cast<std::ptrdiff_t>(error));
  const std::size_t columns = rows.front().size();
  std::vector<std::size_t> widest(columns);
  for (const Row& row : rows) {
    for (std::size_t c = 0; c < columns; ++c) widest[c] = std::max(widest[c], width(row[c]));
  }

  std::string text;
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < columns; ++c) {
      const std::string padding(widest[c] - width(row[c]), ' ');
      if (c > 0) line += ' ';
      line += c < text_columns ? row[c] + padding : padding + row[c];
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }

  const auto labels = run_labels(study);
  const auto& runs = study.runs;
  const bool as_one =
      runs.size() > 1 && !finished(runs.front()) &&
      std::all_of(runs.begin(), runs.end(), [&](const RunResult& run) {
        return run.reason == runs.front().reason && run.stopped_at == runs.front().stopped_at;
      });
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const RunResult& run = runs[i];
    if (finished(run) && !reliable(run))
      text += labels[i] + " is not to be relied on: " + run.departure + '\n';
    if (finished(run) || (as_one && i > 0)) continue;
    text += (as_one ? "all " + std::to_string(runs.size()) + " runs" : labels[i]) + " stopped at " +
            compact(run.stopped_at, 4) + " s: " + (run.reason.empty() ? run.status : run.reason) +
            '\n';
  }
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (!runs[i].untimed.empty()) text += labels[i] + " is not timed: " + runs[i].untimed + '\n';
  return text;
}

namespace {

using Rungs = std::vector<const RunResult*>;

std::string order_of(const std::vector<double>& steps, const std::vector<double>& errors) {
  const ObservedOrder found = observed_order(steps, errors);
  if (std::isnan(found.order)) return "-";
  return fixed(found.order, 1) + "±" + fixed(found.half_range, 1);
}

/// Order of a member of RunResult.
std::string order_of(const Rungs& ladder, double RunResult::*error) {
  std::vector<double> steps, errors;
  for (const RunResult* run : ladder) {
    steps.push_back(static_cast<double>(run->counters.steps));
    errors.push_back(run->*error);
  }
  return order_of(steps, errors);
}

/// If errors fall like steps^−r, so do differences to the next rung.
std::string order_of_impulses(const Rungs& ladder) {
  const std::string& gauge = ladder.front()->settings.gauge;
  if (gauge.empty() || gauge == "reset" || gauge == "flip") return "-";
  std::vector<double> steps, changes;
  for (std::size_t i = 0; i + 1 < ladder.size(); ++i) {
    const auto &coarse = ladder[i]->series.impulse, &fine = ladder[i + 1]->series.impulse;
    if (coarse.size() != fine.size()) continue;
    double change = 0;
    for (std::size_t k = 0; k < fine.size(); ++k)
      change = std::max(change, std::abs(coarse[k] - fine[k]) / (1 + std::abs(fine[k])));
    steps.push_back(static_cast<double>(ladder[i]->counters.steps));
    changes.push_back(change);
  }
  return order_of(steps, changes);
}

}  // namespace

std::string order_table(const StudyResult& study) {
  std::vector<RunError> told;
  for (const RunError& error : run_errors())
    if (error.always ||
        std::any_of(study.runs.begin(), study.runs.end(),
                    [&](const RunResult& run) { return !std::isnan(run.*error.largest); }))
      told.push_back(error);
  std::vector<std::vector<std::string>> rows{{"observed order of", "", ""}};
  for (const RunError& error : told) rows.front().emplace_back(error.symbol);
  rows.front().emplace_back("σ");
  const auto first = ladders(study);
  for (std::size_t i = 0; i < study.runs.size(); ++i) {
    if (first[i] != i) continue;
    Rungs ladder;
    for (std::size_t j = i; j < study.runs.size(); ++j)
      if (first[j] == i && study.runs[j].status == "done") ladder.push_back(&study.runs[j]);
    if (ladder.empty()) continue;
    const RunSettings& s = ladder.front()->settings;
    std::vector<std::string>& row = rows.emplace_back();
    row = {s.form + (s.project ? "+project" : ""), s.integrator, s.gauge.empty() ? "-" : s.gauge};
    for (const RunError& error : told) row.push_back(order_of(ladder, error.largest));
    row.push_back(order_of_impulses(ladder));
  }
  return in_columns(rows) +
         "Errors fall like steps^-order, ± half the spread of slopes of parts of the ladder. λ of "
         "(3) is computed\nfrom q and u of the run, own λ is the form's, with momenta σ' + κσ.\n";
}

}  // namespace momenta
