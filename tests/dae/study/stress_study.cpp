// The study under extremes: which forms survive each ladder, which are wrong in silence, which are
// slow and why; what it counts, and that neither threads nor an interruption change what it has.

#include <gtest/gtest.h>
#include <momenta/dae/output/stress_report.h>

#include "equations/examples.h"

namespace momenta::dae_stress_study {
namespace {

Scene four_bar(double end) {
  Scene s = equations::example("four_bar");
  s.run.end_time = end;
  s.run.samples = 100;
  return s;
}

StressRequest climb(const Scene& scene, Extreme extreme, const std::vector<double>& factors,
                    std::vector<Contestant> contestants) {
  StressRequest r;
  r.ladders.push_back(ladder_of(scene, extreme, factors));
  r.contestants = std::move(contestants);
  r.reference_cpu_limit = 0;
  return r;
}

TEST(StressStudy, AFormThatDriftsIsWrongInSilenceAndLeavesTheLadder) {
  // The loops of the acceleration form open like t²: within the bound for a second, not for long.
  StressRequest request = climb(four_bar(1), Extreme::duration, {1, 300, 600},
                                {{"acceleration", "rk4"}, {"momentum", "rk4"}});
  for (Rung& r : request.ladders[0].rungs) r.scene.run.step = 0.01;
  const StressResult result = run_stress_study(request);
  ASSERT_TRUE(result.complete);
  const auto& drifting = result.ladders[0].runs[0];
  ASSERT_EQ(drifting.size(), 2u);
  EXPECT_EQ(drifting[0].verdict, Verdict::survived);
  EXPECT_EQ(drifting[1].verdict, Verdict::wrong);
  EXPECT_GT(drifting[1].at, 0);
  EXPECT_LT(drifting[1].at, 300);
  EXPECT_NE(drifting[1].cause.find("loops open by"), std::string::npos) << drifting[1].cause;
  const auto& sound = result.ladders[0].runs[1];
  ASSERT_EQ(sound.size(), 3u);
  for (const StressRun& r : sound) {
    EXPECT_EQ(r.verdict, Verdict::survived) << r.cause;
    EXPECT_LT(r.position_drift, 1e-12);
    EXPECT_LT(r.velocity_drift, 1e-12);
  }
  EXPECT_EQ(tally(result, 0).wrong, 1);
  EXPECT_EQ(tally(result, 1).survived, 3);
}

TEST(StressStudy, OnlyLaddersOfAllAreCounted) {
  StressRequest request =
      climb(four_bar(1), Extreme::duration, {1, 2}, {{"momentum", ""}, {"projected", ""}});
  Scene pendulum = equations::example("pendulum");
  pendulum.run.end_time = 1;
  request.ladders.push_back(ladder_of(pendulum, Extreme::duration, {1, 2, 3}));
  const StressResult result = run_stress_study(request);
  EXPECT_EQ(result.ladders[1].runs[0].size(), 3u);  // an open chain: momentum alone
  EXPECT_TRUE(result.ladders[1].runs[1].empty());
  EXPECT_EQ(tally(result, 0).survived, 2);
  EXPECT_EQ(tally(result, 1).survived, 2);
  EXPECT_EQ(tally(result, 0).rungs, 2);
  // Who is not alone at the top is not called the only one.
  EXPECT_NE(stress_page(result, "t").find(" and 1 other survived most: 2 of 2 rungs"),
            std::string::npos);
}

TEST(StressStudy, StiffnessMakesExplicitMethodsSlowAndTheCauseIsTold) {
  Scene scene = four_bar(10);
  scene.joints[2].damping = 1;
  StressRequest request = climb(scene, Extreme::damping, {1e8}, {{"momentum", "dop853"}});
  request.cpu_limit = 0.05;
  const StressResult result = run_stress_study(request);
  const StressRun& r = result.ladders[0].runs[0].at(0);
  EXPECT_EQ(r.verdict, Verdict::slow);
  EXPECT_LT(r.at, 10);
  EXPECT_NE(r.cause.find("of processor time"), std::string::npos) << r.cause;
}

TEST(StressStudy, ErrorIsJudgedAgainstAReferenceInQuadruplePrecision) {
  StressRequest request = climb(four_bar(2), Extreme::duration, {1}, {{"momentum", "dop853"}});
  request.reference_cpu_limit = 60;
  request.rtol = 1e-9;
  const StressResult result = run_stress_study(request);
  EXPECT_LT(result.ladders[0].reference[0], 1e-12);
  EXPECT_LT(result.ladders[0].runs[0].at(0).error, 1e-6);
  EXPECT_GT(result.ladders[0].runs[0].at(0).error, 1e-14);
  // The same run held to less than it reaches is wrong.
  request.bound = 1e-13;
  const StressResult strict = run_stress_study(request);
  EXPECT_EQ(strict.ladders[0].runs[0].at(0).verdict, Verdict::wrong);
}

TEST(StressStudy, WhereNothingMovesRoundingIsNoFailure) {
  Scene still = four_bar(1);
  still.gravity.setZero();
  const StressResult result = run_stress_study(
      climb(still, Extreme::duration, {1, 10}, {{"momentum", ""}, {"projected", ""}}));
  for (const auto& runs : result.ladders[0].runs)
    for (const StressRun& r : runs) EXPECT_EQ(r.verdict, Verdict::survived) << r.cause;
}

TEST(StressStudy, ASceneWithoutAStartIsRefusedWithItsReason) {
  Scene torn = four_bar(1);
  torn.loops[0].origin_parent = {200, 0, 0};
  const StressResult result =
      run_stress_study(climb(torn, Extreme::duration, {1}, {{"momentum", ""}}));
  EXPECT_NE(result.ladders[0].refused[0].find("cannot be assembled"), std::string::npos);
  EXPECT_TRUE(result.ladders[0].runs[0].empty());
  EXPECT_NE(stress_table(result).find("has no start"), std::string::npos);
}

TEST(StressStudy, ThreadsChangeNothing) {
  StressRequest request = climb(four_bar(2), Extreme::mass_ratio, {1, 1e3, 1e6},
                                {{"momentum", ""}, {"baumgarte", ""}, {"projected", ""}});
  request.cpu_limit = 1000;
  request.threads = 1;
  const StressResult one = run_stress_study(request);
  request.threads = 3;
  const StressResult three = run_stress_study(request);
  for (std::size_t c = 0; c < 3; ++c) {
    ASSERT_EQ(one.ladders[0].runs[c].size(), three.ladders[0].runs[c].size());
    for (std::size_t k = 0; k < one.ladders[0].runs[c].size(); ++k) {
      const StressRun &a = one.ladders[0].runs[c][k], &b = three.ladders[0].runs[c][k];
      EXPECT_EQ(a.verdict, b.verdict);
      EXPECT_EQ(a.energy, b.energy);
      EXPECT_EQ(a.position_drift, b.position_drift);
      EXPECT_EQ(a.run.counters.evaluations, b.run.counters.evaluations);
    }
  }
}

TEST(StressStudy, InterruptedStudyKeepsWhatItHas) {
  StressRequest request = climb(four_bar(1), Extreme::duration, {1, 2, 4}, {{"momentum", ""}});
  int calls = 0;
  request.progress = [&](int, int, const std::string&) { return ++calls <= 4; };
  const StressResult result = run_stress_study(request);
  EXPECT_FALSE(result.complete);
  EXPECT_EQ(result.ladders[0].runs[0].size(), 1u);
}

TEST(StressStudy, RefusesWhatDoesNotGoTogether) {
  EXPECT_THROW(run_stress_study(climb(four_bar(1), Extreme::duration, {1}, {{"momentum", "ida"}})),
               std::invalid_argument);
  EXPECT_THROW(run_stress_study(climb(four_bar(1), Extreme::duration, {1}, {{"projected", "bdf"}})),
               std::invalid_argument);
  EXPECT_THROW(run_stress_study(climb(four_bar(1), Extreme::duration, {1}, {{"nonsense", ""}})),
               std::invalid_argument);
}

TEST(StressStudy, ReportsAgree) {
  StressRequest request = climb(four_bar(1), Extreme::duration, {1, 300},
                                {{"acceleration", "rk4"}, {"momentum", "rk4"}});
  for (Rung& r : request.ladders[0].rungs) r.scene.run.step = 0.02;
  const StressResult result = run_stress_study(request);
  const auto json = stress_json(result);
  const auto& runs = json["ladders"][0]["runs"];
  ASSERT_EQ(runs.size(), 4u);
  const std::string csv = stress_csv(result), table = stress_table(result),
                    page = stress_page(result, "a <title>");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  EXPECT_NE(page.find("a &lt;title&gt;"), std::string::npos);
  EXPECT_EQ(page.find("{{"), std::string::npos);
  for (const auto& run : runs) {
    EXPECT_NE(csv.find(run["verdict"].get<std::string>()), std::string::npos);
    if (run["verdict"] == "survived") continue;
    EXPECT_NE(table.find(run["cause"].get<std::string>()), std::string::npos);
    EXPECT_NE(page.find(run["cause"].get<std::string>()), std::string::npos);
  }
}

}  // namespace
}  // namespace momenta::dae_stress_study
