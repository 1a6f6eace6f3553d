// Results for other programs: JSON keys and nulls, CSV cells and digits.
#include <dae/output/page/synthetic_study.h>
#include <gtest/gtest.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/output/json.h>
#include <momenta/dae/run/run_quantities.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>

namespace momenta::dae_report_data {
namespace {

std::vector<std::string> keys(const nlohmann::ordered_json& json) {
  std::vector<std::string> names;
  for (const auto& [name, value] : json.items()) names.push_back(name);
  std::sort(names.begin(), names.end());
  return names;
}

using Names = std::vector<std::string>;

TEST(SummaryJson, HasThePublicKeys) {
  const auto json = summary_json(synthetic::run_of({}), synthetic::study_of({}).environment);
  Names expected{"scene",        "form",           "integrator",    "gauge",
                 "rtol",         "atol",           "step",          "end_time",
                 "status",       "reason",         "counters",      "time",
                 "drift",        "energy",         "error",         "environment",
                 "jacobian",     "linear_solver",  "kkt",           "project",
                 "stopped_at",   "stiff_from",     "faded_rows",    "beta",
                 "penalty",      "partitions",     "least_pivot",   "singular_crossings",
                 "undetermined", "passages",       "changed_to",    "changed_at",
                 "rank",         "dependent_rows", "residue",       "weak_evaluations",
                 "stiffness",    "integrated",     "passed_limits", "multiplier_difference_max",
                 "events",       "event_remarks",  "stops",         "reaction_errors",
                 "departure"};
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(keys(json), expected);
  EXPECT_EQ(keys(json["counters"]),
            (Names{"detours", "evaluations", "factorizations", "jacobians", "newton_iterations",
                   "ode_restarts", "rejected", "steps"}));
  EXPECT_EQ(keys(json["time"]), (Names{"cpu_s", "repeats", "untimed", "wall_s"}));
  EXPECT_EQ(keys(json["drift"]),
            (Names{"angle_between_steps_max", "angle_exponent", "angle_max", "angle_rate_exponent",
                   "angle_rate_max", "between_steps_max", "position_exponent", "position_max",
                   "unit", "velocity_exponent", "velocity_max"}));
  EXPECT_EQ(keys(json["energy"]), (Names{"error_max", "turned_over"}));
  EXPECT_EQ(keys(json["error"]),
            (Names{"effort_max", "force_max", "impulse_max", "momentum_max", "multiplier_max",
                   "position_max", "reaction_max", "velocity_max", "work_max"}));
  EXPECT_EQ(json["environment"]["versions"]["SUNDIALS"], "6.4.1");
  EXPECT_EQ(json["counters"]["steps"], 43000);
}

TEST(SummaryJson, HasExponentsOfPowersAlone) {
  RunResult run = synthetic::run_of({});
  EXPECT_FALSE(summary_json(run, {})["drift"]["position_exponent"].is_null());
  run.position_growth.half_range = 5.3;
  EXPECT_TRUE(summary_json(run, {})["drift"]["position_exponent"].is_null());
}

TEST(SummaryJson, NotMeasuredIsNull) {
  RunResult run;
  run.energy_error_max = std::numeric_limits<double>::infinity();
  const auto json = summary_json(run, {});
  EXPECT_TRUE(json["drift"]["position_max"].is_null());
  EXPECT_TRUE(json["error"]["velocity_max"].is_null());
  EXPECT_TRUE(json["time"]["cpu_s"].is_null());
  EXPECT_TRUE(json["energy"]["error_max"].is_null());
  EXPECT_TRUE(json["rtol"].is_number());
}

TEST(StudyJson, IsAnArrayOfSummariesThatParsesBack) {
  const auto json = nlohmann::ordered_json::parse(study_json(synthetic::all_forms()).dump());
  ASSERT_EQ(json.size(), form_names().size());
  EXPECT_EQ(json[5]["form"], "acceleration");
  EXPECT_EQ(json[8]["status"], "failed");
}

TEST(Csv, QuotesOnlyWhereACellNeedsIt) {
  EXPECT_EQ(csv_cell("plain text"), "plain text");
  EXPECT_EQ(csv_cell("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_cell("say \"no\""), "\"say \"\"no\"\"\"");
  EXPECT_EQ(csv_cell("two\nlines"), "\"two\nlines\"");
}

TEST(Csv, TrajectoryKeepsEveryDigitAndLeavesNanEmpty) {
  EXPECT_EQ(trajectory_head({"t [s]", "O.q [rad]", "x, y"}), "t [s],O.q [rad],\"x, y\"\n");
  EXPECT_EQ(trajectory_line({0, 1.0 / 3.0, not_measured}), "0,0.3333333333333333,\n");
  EXPECT_EQ(trajectory_line({0.1, -2e-300, 4}), "0.1,-2e-300,4\n");
}

/// The cells of one row, as a reader of CSV sees them.
std::vector<std::string> cells_of(const std::string& row) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < row.size(); ++i)
    if (quoted && row[i] == '"' && i + 1 < row.size() && row[i + 1] == '"')
      cells.back() += row[i++];
    else if (row[i] == '"')
      quoted = !quoted;
    else if (row[i] == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += row[i];
  EXPECT_FALSE(quoted) << row;
  return cells;
}

TEST(Csv, StudyHasOneRowPerRunAndEachCellUnderItsName) {
  RunResult measured = synthetic::failed(synthetic::run_of({}, 1, 10), 0.5, "a, \"b\", c");
  measured.counters = {11, 12, 13, 14, 15, 16};
  measured.repeats = 17;
  measured.velocity_error_max = 0.25;
  const StudyResult study = synthetic::study_of({measured, RunResult{}});
  std::istringstream lines(study_csv(study));
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(lines, line);) rows.push_back(cells_of(line));
  ASSERT_EQ(rows.size(), 3u);
  for (const std::size_t i : {1u, 2u}) ASSERT_EQ(rows[i].size(), rows[0].size());
  const auto cell = [&](std::size_t run, const std::string& name) {
    const auto at = std::find(rows[0].begin(), rows[0].end(), name);
    EXPECT_NE(at, rows[0].end()) << name;
    return at == rows[0].end() ? name
                               : rows[run + 1][static_cast<std::size_t>(at - rows[0].begin())];
  };
  EXPECT_EQ(cell(0, "form"), "momentum");
  EXPECT_EQ(cell(0, "gauge"), "leak:10");
  EXPECT_EQ(cell(0, "status"), "failed");
  EXPECT_EQ(cell(0, "stopped_at [s]"), "0.5");
  EXPECT_EQ(cell(0, "reason"), "a, \"b\", c");
  for (const auto& [name, value] :
       {std::pair{"position_drift_max [m]", measured.position_drift_max},
        std::pair{"velocity_drift_max [m/s]", measured.velocity_drift_max},
        std::pair{"energy_error_max [J]", measured.energy_error_max},
        std::pair{"velocity_error_max", 0.25}, std::pair{"cpu [s]", measured.cpu_s},
        std::pair{"wall [s]", measured.wall_s}}) {
    EXPECT_EQ(std::strtod(cell(0, name).c_str(), nullptr), value) << name;
    EXPECT_EQ(cell(1, name), "") << name;
  }
  EXPECT_EQ(cell(0, "position_error_max"), "");
  int expected = 10;
  for (const char* name : {"steps", "rejected", "evaluations", "jacobians", "factorizations",
                           "newton_iterations", "repeats"})
    EXPECT_EQ(cell(0, name), std::to_string(++expected)) << name;
}

TEST(ResultsPage, NamesEveryQuantity) {
  std::ifstream file(std::string(MOMENTA_SOURCE_DIR) + "/docs/reference/results.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  std::string columns;
  for (const RunQuantity& quantity : run_quantities()) {
    if (quantity.column) columns += (columns.empty() ? "`" : ", `") + quantity.heading("m") + "`";
    if (!quantity.pointer) continue;
    std::string key = quantity.pointer + 1;
    std::replace(key.begin(), key.end(), '/', '.');
    const std::string last = key.substr(key.find('.') + 1);
    EXPECT_TRUE(page.find("`" + key + "`") != std::string::npos ||
                (last != key && page.find("`." + last + "`") != std::string::npos))
        << key;
  }
  EXPECT_NE(page.find("\n" + columns + ".\n"), std::string::npos) << columns;
}

}  // namespace
}  // namespace momenta::dae_report_data
