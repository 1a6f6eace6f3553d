// The first sentences of a page must be true of its data, whatever the data are.
#include <dae/output/page/synthetic_study.h>
#include <gtest/gtest.h>
#include <momenta/dae/output/conclusion.h>

namespace momenta::dae_report_conclusion {
namespace {

// A run by its numbers alone, without histories.
RunResult run(const std::string& form, double drift, double exponent, double cpu_s,
              double energy = 1e-8) {
  RunResult r;
  r.settings.form = form;
  r.settings.gauge = form == "momentum" ? "leak:10" : "";
  r.settings.end_time = r.stopped_at = 1000;
  r.position_drift_max = drift;
  r.position_growth = {exponent, 0.05, 100, 1000};
  r.energy_error_max = energy;
  r.cpu_s = cpu_s;
  return r;
}

StudyResult study(std::vector<RunResult> runs) {
  StudyResult s;
  s.runs = std::move(runs);
  return s;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Conclusion, ComparesAccelerationWithMomentum) {
  EXPECT_EQ(
      conclusion(
          study({run("momentum", 3.5e-6, 1.01, 0.52), run("acceleration", 0.27, 1.98, 0.5, 1e-7)})),
      "After 1000 s the position drift of `acceleration` is 0.27 m, growing like t^1.98; "
      "`momentum` 3.5 µm, "
      "like t^1.01, at 1.04 times the cost. Without a reference, the least drift times energy "
      "error is that of "
      "`momentum` with dop853: drift 3.5 µm, energy within 1e-8 J in 0.52 s of processor time.");
}

TEST(Conclusion, PrefersTheRunWithAGaugeAndNamesIt) {
  auto plain = run("momentum", 1e-2, 2.1, 0.5);
  plain.settings.gauge = "none";
  const auto text = conclusion(
      study({run("acceleration", 0.27, 1.98, 0.5), plain, run("momentum", 3.5e-6, 1.01, 0.6)}));
  EXPECT_TRUE(contains(
      text, "; `momentum, leak:10` 3.5 µm, like t^1.01, and is slower: 1.20 times the cost."))
      << text;
}

TEST(Conclusion, SaysWhenThereIsNoGauge) {
  auto plain = run("momentum", 1e-2, 2.1, 0.5);
  plain.settings.gauge = "none";
  const auto text = conclusion(study({run("acceleration", 0.27, 1.98, 0.5), plain}));
  EXPECT_TRUE(contains(text, "`momentum` 10 mm, like t^2.10 (no gauge), at equal cost.")) << text;
}

TEST(Conclusion, SaysWhenMomentumIsWorse) {
  const auto text =
      conclusion(study({run("acceleration", 1e-3, 1, 0.5), run("momentum", 3e-3, 1, 1)}));
  EXPECT_TRUE(contains(
      text,
      "`momentum` 3 mm, like t^1.00, which is worse, 3.00 times as much, and is slower: 2.00 "
      "times the cost."))
      << text;
}

TEST(Conclusion, ClaimsNoPowerLawWhereThereIsNone) {
  auto a = run("acceleration", 0.27, 1.6, 0.5);
  a.position_growth.half_range = 0.8;
  const auto text = conclusion(study({a, run("momentum", 3.5e-6, 1.01, 0.5)}));
  EXPECT_TRUE(contains(text,
                       "is 0.27 m, not as a power of t (slopes 0.8 to 2.4); `momentum` 3.5 µm, "
                       "growing like t^1.01"))
      << text;
}

TEST(Conclusion, ReadsNoGrowthFromRounding) {
  const auto text =
      conclusion(study({run("acceleration", 0.27, 1.98, 0.5), run("momentum", 3e-15, 0.4, 0.5)}));
  EXPECT_TRUE(contains(text, "; `momentum` stays at rounding level (3e-15 m), at equal cost."))
      << text;
  const auto both =
      conclusion(study({run("projected", 2e-15, 0.5, 1), run("partitioned", 3e-15, 0.5, 1)}));
  EXPECT_TRUE(contains(both, "all 2 finished runs is at rounding level (3e-15 m at most)."))
      << both;
}

TEST(Conclusion, SaysUpToWhereTheLoopsHaveClosedAgain) {
  auto a = run("acceleration", 0.27, 1.98, 0.5);
  a.series.position_drift = {0, 0.27, 0.01};
  EXPECT_TRUE(contains(conclusion(study({a})), "reached 0.27 m"));
}

TEST(Conclusion, NeverComparesDifferentMethods) {
  auto m = run("momentum", 3.5e-6, 1.01, 0.5);
  m.settings.integrator = "adams";
  const auto text = conclusion(study({run("acceleration", 0.27, 1.98, 0.5), m}));
  EXPECT_FALSE(contains(text, "the cost")) << text;
  EXPECT_TRUE(
      contains(text,
               "`acceleration` is 0.27 m, growing like t^1.98, the most of 2 finished runs; "
               "`momentum` 3.5 µm, like t^1.01, the least."))
      << text;
}

TEST(Conclusion, RanksByTheReferenceWhereThereIsOne) {
  auto a = run("acceleration", 0.27, 1.98, 0.5), m = run("momentum", 3.5e-6, 1.01, 0.6);
  a.position_error_max = 3e-2;
  m.position_error_max = 4.2e-7;
  const auto text = conclusion(study({a, m}));
  EXPECT_TRUE(
      contains(text,
               " Closest to the reference is `momentum` with dop853: error 4.2e-7 in 0.6 s of "
               "processor time."))
      << text;
}

TEST(Conclusion, NamesFailedRunsWithTimeAndCause) {
  const auto a = synthetic::failed(run("acceleration", 0.27, 1.98, 0.5), 31.4,
                                   "Rank was lost at the dead point.");
  const auto text = conclusion(study({a, run("momentum", 3.5e-6, 1.01, 0.6)}));
  EXPECT_EQ(text.rfind(
                "After 1000 s the position drift of `momentum` is 3.5 µm, growing like t^1.01.", 0),
            0u)
      << text;
  EXPECT_TRUE(contains(
      text,
      "1 of 2 runs did not finish: `acceleration` stopped at 31.4 s (Rank was lost at the dead "
      "point)."))
      << text;
  EXPECT_FALSE(contains(text, "the cost")) << text;
}

TEST(Conclusion, SurvivesThatNothingFinished) {
  const auto a = synthetic::failed(run("acceleration", 0.27, 1.98, 0.5), 2, "Cause.");
  EXPECT_EQ(conclusion(study({a})),
            "The run did not finish: `acceleration` stopped at 2 s (Cause).");
  const auto text = conclusion(study({a, synthetic::failed(run("momentum", 1, 1, 1), 3, "")}));
  EXPECT_EQ(text,
            "None of the 2 runs finished: `acceleration` stopped at 2 s (Cause); `momentum` "
            "stopped at 3 s.");
  EXPECT_EQ(conclusion(study({})), "No run was made.");
}

TEST(Conclusion, NamesThreeFailuresAndCountsTheRest) {
  std::vector<RunResult> runs;
  for (const char* form : {"a", "b", "c", "d", "e"})
    runs.push_back(synthetic::failed(run(form, 1, 1, 1), 1, "x"));
  runs[1].status = "time limit";
  const auto text = conclusion(study(runs));
  EXPECT_TRUE(
      contains(text, "`b` reached its time limit at 1 s; `c` stopped at 1 s (x); and 2 more."))
      << text;
}

TEST(Conclusion, ManagesOneRunAndNoLoops) {
  EXPECT_EQ(conclusion(study({run("momentum", 3.5e-6, 0.01, 0.52)})),
            "After 1000 s the position drift of `momentum` is 3.5 µm, without growing further. "
            "It kept its energy "
            "within 1e-8 J in 0.52 s of processor time; there is no reference to compare with.");
  EXPECT_EQ(conclusion(study({run("momentum", not_measured, not_measured, 0.5)}))
                .rfind("Position drift was not measured", 0),
            0u);
  EXPECT_EQ(conclusion(study({run("momentum", 1e-6, not_measured, not_measured, not_measured)})),
            "After 1000 s the position drift of `momentum` is 1 µm.");
}

TEST(Conclusion, DoesNotCompareRounding) {
  auto a = run("acceleration", 3.2e-13, not_measured, 0.5),
       m = run("momentum", 3.6e-13, not_measured, 0.5);
  EXPECT_TRUE(contains(conclusion(study({a, m})), "worse"));
  a.drift_rounding = m.drift_rounding = 4e-13;
  const auto text = conclusion(study({a, m}));
  EXPECT_TRUE(contains(text,
                       "`acceleration` is at rounding level (3.2e-13 m); `momentum` stays at "
                       "rounding level (3.6e-13 m)"))
      << text;
  EXPECT_FALSE(contains(text, "worse")) << text;
}

TEST(Conclusion, CountsEvaluationsWhereNoTimeWasTaken) {
  auto a = run("acceleration", 0.27, 1.98, not_measured),
       m = run("momentum", 3.5e-6, 1.01, not_measured);
  a.counters.evaluations = 1000;
  m.counters.evaluations = 1100;
  EXPECT_TRUE(contains(conclusion(study({a, m})), "with 1.10 times the evaluations."));
}

TEST(Conclusion, TakesTheTightestRungOfALadder) {
  const auto text = conclusion(synthetic::ladder());
  EXPECT_TRUE(contains(text, "`acceleration, dop853, 1e-12`") ||
              contains(text, "`acceleration, adams, 1e-12`"))
      << text;
}

}  // namespace
}  // namespace momenta::dae_report_conclusion
