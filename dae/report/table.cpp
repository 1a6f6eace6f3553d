#include <momenta/dae/report/run_label.h>
#include <momenta/dae/report/table.h>
#include <momenta/dae/text/number_text.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace momenta {
namespace {

constexpr std::size_t columns = 14;
constexpr std::size_t text_columns =
    5;  // these stand at the left of their column, numbers at the right
using Row = std::array<std::string, columns>;

std::string growth(const Growth& g) {
  if (std::isnan(g.exponent)) return "-";
  if (std::isnan(g.half_range)) return fixed(g.exponent, 2);
  return fixed(g.exponent, 2) + "±" + fixed(g.half_range, 2);
}

std::string count(long n) {
  return n < 10'000'000 ? std::to_string(n) : scientific(static_cast<double>(n), 3);
}

Row row_of(const RunResult& run) {
  const RunSettings& s = run.settings;
  return {s.form + (s.project ? "+project" : ""),
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
}

}  // namespace

std::string drift_table(const StudyResult& study) {
  std::vector<Row> rows{{"", "integ-", "", "tol or", "", "pos.", "vel.", "energy", "growth",
                         "growth", "error", "", "evalu-", "CPU"},
                        {"form", "rator", "gauge", "step", "status", "drift", "drift", "error",
                         "pos. t^", "vel. t^", "to ref.", "steps", "ations", "[s]"}};
  for (const RunResult& run : study.runs) rows.push_back(row_of(run));

  std::array<std::size_t, columns> widest{};
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
      runs.size() > 1 && runs.front().status != "done" &&
      std::all_of(runs.begin(), runs.end(), [&](const RunResult& run) {
        return run.reason == runs.front().reason && run.stopped_at == runs.front().stopped_at;
      });
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const RunResult& run = runs[i];
    if (run.status == "done" || (as_one && i > 0)) continue;
    text += (as_one ? "all " + std::to_string(runs.size()) + " runs" : labels[i]) + " stopped at " +
            compact(run.stopped_at, 4) + " s: " + (run.reason.empty() ? run.status : run.reason) +
            '\n';
  }
  return text;
}

}  // namespace momenta
