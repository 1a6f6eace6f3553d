#include <momenta/dae/measure/observed_order.h>
#include <momenta/dae/report/order_table.h>
#include <momenta/dae/report/run_label.h>
#include <momenta/dae/study/run_quantities.h>
#include <momenta/dae/text/number_text.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace momenta {
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
