// The table on the terminal, and the numbers as text that every report is made of.
#include <dae/output/page/synthetic_study.h>
#include <gtest/gtest.h>
#include <momenta/core/text/number_text.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/output/run_label.h>
#include <momenta/dae/output/table.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <sstream>

namespace momenta::dae_report_table {
namespace {

TEST(NumberText, RoundTripReadsBackToTheSameDouble) {
  for (const double value : {0.1, 1.0 / 3.0, 5e-324, 1.7976931348623157e308, -2.5e-8, 0.0}) {
    EXPECT_EQ(std::strtod(round_trip(value).c_str(), nullptr), value);
  }
  EXPECT_EQ(round_trip(0.1), "0.1");
  EXPECT_EQ(round_trip(not_measured), "");
}

TEST(NumberText, CompactKeepsTheDigitsAskedFor) {
  EXPECT_EQ(compact(0.2711, 2), "0.27");
  EXPECT_EQ(compact(0.0996, 2), "0.1");
  EXPECT_EQ(compact(9.99, 2), "10");
  EXPECT_EQ(compact(1000, 4), "1000");
  EXPECT_EQ(compact(12345, 3), "1.23e4");
  EXPECT_EQ(compact(-2.5e-5, 2), "-2.5e-5");
  EXPECT_EQ(compact(0, 2), "0");
  EXPECT_EQ(compact(not_measured, 2), "-");
}

TEST(NumberText, ScientificAlwaysHasAnExponent) {
  EXPECT_EQ(scientific(0.27, 2), "2.7e-1");
  EXPECT_EQ(scientific(3, 2), "3e0");
  EXPECT_EQ(scientific(1e-8, 3), "1e-8");
  EXPECT_EQ(scientific(4.6e-16, 2), "4.6e-16");
  EXPECT_EQ(scientific(2e100, 2), "2e100");
  EXPECT_EQ(scientific(-std::numeric_limits<double>::infinity(), 2), "-inf");
}

TEST(NumberText, FixedHasNoNegativeZero) {
  EXPECT_EQ(fixed(1.984, 2), "1.98");
  EXPECT_EQ(fixed(-0.001, 2), "0.00");
  EXPECT_EQ(fixed(-0.01, 2), "-0.01");
  EXPECT_EQ(fixed(not_measured, 2), "-");
}

TEST(NumberText, LengthsHaveTheirPrefix) {
  EXPECT_EQ(length_text(0.27), "0.27 m");
  EXPECT_EQ(length_text(0.027), "27 mm");
  EXPECT_EQ(length_text(3.5e-6), "3.5 µm");
  EXPECT_EQ(length_text(0.99999e-6), "1 µm");
  EXPECT_EQ(length_text(12e-9), "12 nm");
  EXPECT_EQ(length_text(2e-12), "2 pm");
  EXPECT_EQ(length_text(4.4e-14), "4.4e-14 m");
  EXPECT_EQ(length_text(0), "0 m");
  EXPECT_EQ(time_text(0.031), "31 ms");
}

TEST(RunLabels, NameWhatDiffersWithinAForm) {
  StudyResult study =
      synthetic::study_of({synthetic::run_of({}, 1, 10), synthetic::run_of({}, 1, 10),
                           synthetic::run_of({"acceleration"}, 1, 10)});
  study.runs[1].settings.gauge = "none";
  study.runs[2].settings.integrator = "adams";
  EXPECT_EQ(run_labels(study), (std::vector<std::string>{"momentum, leak:10",
                                                         "momentum, gauge none", "acceleration"}));
  study.runs[1].settings.rtol = 1e-6;
  study.runs[1].settings.atol = 1e-7;
  EXPECT_EQ(run_labels(study)[1], "momentum, gauge none, 1e-6/1e-7");
  EXPECT_EQ(run_labels(study, false)[1], "momentum, gauge none");
}

TEST(RunLabels, AllRunsOfADriftStudyAreDrawnAndOneOfEachLadder) {
  EXPECT_EQ(runs_with_curves(synthetic::all_forms()).size(), form_names().size());
  EXPECT_EQ(runs_with_curves(synthetic::ladder()),
            (std::vector<std::size_t>{0, 5, 10, 15, 20, 25}));
}

TEST(DriftTable, HasARowPerRunWithinTheTerminal) {
  // The study that reports are tested on has all forms there are.
  std::vector<std::string> forms;
  for (const RunResult& run : synthetic::all_forms().runs) forms.push_back(run.settings.form);
  EXPECT_TRUE(
      std::is_permutation(forms.begin(), forms.end(), form_names().begin(), form_names().end()));
  const std::string table = drift_table(synthetic::all_forms());
  std::istringstream lines(table);
  std::vector<std::string> rows;
  for (std::string line; std::getline(lines, line);) rows.push_back(line);
  ASSERT_EQ(rows.size(), 3u + forms.size() + 2u);  // header, runs, failures
  for (std::size_t i = 0; i < 3 + forms.size(); ++i) {
    const auto seen =
        std::count_if(rows[i].begin(), rows[i].end(), [](char c) { return (c & 0xC0) != 0x80; });
    EXPECT_LE(seen, 120) << rows[i];
  }
  EXPECT_EQ(rows[8].rfind("acceleration ", 0), 0u) << rows[8];
  EXPECT_NE(rows[8].find("2.00±.03"), std::string::npos) << rows[8];
  EXPECT_NE(
      rows[3 + forms.size()].find("acceleration-index3 stopped at 31.4 s: IDA could not converge"),
      std::string::npos);
}

TEST(DriftTable, HasNoExponentWhereThereIsNoPower) {
  RunResult run = synthetic::run_of({});
  run.position_growth = {3.03, 5.30, 1, 10};
  const std::string table = drift_table(synthetic::study_of({run}));
  EXPECT_NE(table.find("no power"), std::string::npos) << table;
  EXPECT_EQ(table.find("3.03"), std::string::npos) << table;
}

TEST(DriftTable, TellsWhatIsNotToBeReliedOn) {
  RunResult run = synthetic::run_of({});
  run.departure = "the balance is off";
  const std::string table = drift_table(synthetic::study_of({run}));
  EXPECT_NE(table.find("momentum is not to be relied on: the balance is off\n"), std::string::npos)
      << table;
}

TEST(DriftTable, PrintsADashWhereNothingWasMeasured) {
  RunResult run;
  run.settings.form = "acceleration";
  run.settings.step = 0.005;
  const std::string table = drift_table(synthetic::study_of({run}));
  EXPECT_NE(table.find("h=0.005"), std::string::npos) << table;
  EXPECT_EQ(table.find("nan"), std::string::npos) << table;
  EXPECT_NE(table.find(" - "), std::string::npos) << table;
}

}  // namespace
}  // namespace momenta::dae_report_table
