// Times of finished runs: when a median counts as settled, what each way of timing leaves in the
// results, and that a study that goes on takes no time twice.

#include "equations/ensemble.h"
#include "equations/examples.h"

#include <gtest/gtest.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/study/timing.h>
#include <momenta/dae/topology/assembly/assembly.h>
#include <momenta/dae/topology/cut/integrated_scene.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <stdexcept>
#include <string>
#include <tuple>

namespace momenta::dae_timing {
namespace {

/// Rounds until the median of times around 1 s with normal scatter `sigma` has settled; the mean of
/// 200 series.
double rounds_with(double sigma) {
  std::mt19937 random(1);
  std::normal_distribution<double> scatter(1, sigma);
  double sum = 0;
  for (int series = 0; series < 200; ++series) {
    std::vector<double> times;
    while (times.size() < 1000 && !is_settled(times)) times.push_back(std::abs(scatter(random)));
    sum += static_cast<double>(times.size());
  }
  return sum / 200;
}

TEST(Timing, MediansOfSteadyTimesSettleAtOnceAndOthersWithTheSquareOfTheirScatter) {
  EXPECT_FALSE(is_settled({}));
  EXPECT_FALSE(is_settled({1}));
  EXPECT_EQ(rounds_with(0), 2);
  EXPECT_LT(rounds_with(0.005), 2.5);
  // 0.93 · 1.35 σ / √n = 0.02
  EXPECT_NEAR(rounds_with(0.1) / std::pow(0.93 * 1.35 * 0.1 / 0.02, 2), 1, 0.4);
  EXPECT_NEAR(rounds_with(0.2) / rounds_with(0.1), 4, 1.5);
}

class TimedStudy : public testing::Test {
 protected:
  const Mechanism mechanism{equations::example("four_bar")};
  const Start start = equations::start_of(mechanism);
  std::vector<RunResult> runs;

  TimedStudy() {
    for (const char* form : {"momentum", "baumgarte"}) {
      RunRequest request;
      request.settings = default_settings(mechanism.scene().run, form, "dp5", 1e-6);
      request.settings.end_time = 1;
      runs.push_back(run_form(mechanism, start, request));
    }
    runs.push_back(runs[0]);
    runs.back().status = "failed";
  }
};

TEST_F(TimedStudy, SaysHowOftenItWasTimed) {
  const RunResult failed = runs.back();
  auto once = runs, rounds = runs, none = runs;
  time_runs(mechanism, start, once, {.how = Timing::once, .going_on = {}, .at_step = {}});
  time_runs(mechanism, start, rounds, {.going_on = {}, .at_step = {}});
  time_runs(mechanism, start, none, {.how = Timing::none, .going_on = {}, .at_step = {}});
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(once[i].repeats, 1);
    EXPECT_GT(once[i].cpu_s, 0);
    EXPECT_GE(rounds[i].repeats, 2);
    EXPECT_EQ(none[i].repeats, 0);
    EXPECT_TRUE(std::isnan(none[i].cpu_s));
    EXPECT_TRUE(std::isnan(none[i].wall_s));
    EXPECT_EQ(once[i].counters.steps, rounds[i].counters.steps);
  }
  EXPECT_EQ(rounds[2].repeats, failed.repeats);
}

TEST_F(TimedStudy, HasNoTimesOfRigidStopsWhereNoneAreAskedFor) {
  Scene scene = mechanism.scene();
  scene.joints[0].limits = {{-100.0, 100.0}};
  scene.joints[0].restitution = 0.5;
  auto none = runs, once = runs;
  time_runs(Mechanism(scene), start, none, {.how = Timing::none, .going_on = {}, .at_step = {}});
  time_runs(Mechanism(scene), start, once, {.how = Timing::once, .going_on = {}, .at_step = {}});
  EXPECT_TRUE(std::isnan(none[0].cpu_s));
  EXPECT_EQ(once[0].cpu_s, runs[0].cpu_s);
  EXPECT_EQ(once[0].repeats, 0);
}

TEST_F(TimedStudy, TakesNoTimeTwice) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("momenta_timing_" + std::to_string(getpid()));
  const Journal::Study study{"digest", "build", "command"};
  auto first = runs, stopped = runs, again = runs;
  int asked = 0;
  {
    Journal journal(folder / "journal", study);
    // Interrupted in the second round, it goes on from there.
    time_runs(
        mechanism, start, stopped,
        {.journal = &journal, .going_on = [&](std::size_t) { return ++asked < 4; }, .at_step = {}});
    EXPECT_EQ(asked, 4);
    EXPECT_EQ(stopped[0].repeats, 2);
    EXPECT_EQ(stopped[1].repeats, 1);
  }
  {
    Journal journal(folder / "journal", study);
    asked = 0;
    time_runs(
        mechanism, start, first,
        {.journal = &journal, .going_on = [&](std::size_t) { return ++asked > 0; }, .at_step = {}});
    EXPECT_EQ(asked, first[0].repeats + first[1].repeats - 3);
  }
  {
    Journal journal(folder / "journal", study);
    time_runs(mechanism, start, again,
              {.journal = &journal,
               .going_on =
                   [&](std::size_t) {
                     ADD_FAILURE() << "timed again";
                     return true;
                   },
               .at_step = {}});
    for (int i = 0; i < 2; ++i) {
      EXPECT_EQ(again[i].repeats, first[i].repeats);
      EXPECT_EQ(again[i].cpu_s, first[i].cpu_s);
      EXPECT_EQ(again[i].counters.evaluations, first[i].counters.evaluations);
    }
    journal.remove();
  }
  std::filesystem::remove_all(folder);
}

TEST_F(TimedStudy, HasNoTimesOfAnotherCourse) {
  auto other = runs;
  ++other[0].counters.rejected;
  time_runs(mechanism, start, other, {.how = Timing::once, .going_on = {}, .at_step = {}});
  EXPECT_EQ(other[0].repeats, 0);
  EXPECT_TRUE(std::isnan(other[0].cpu_s));
  EXPECT_NE(other[0].untimed.find("a repeat without measuring took"), std::string::npos)
      << other[0].untimed;
  EXPECT_EQ(other[1].untimed, "");
  EXPECT_EQ(other[1].repeats, 1);
}

TEST_F(TimedStudy, EndsARepeatAtTheLimitOfItsRun) {
  auto limited = runs;
  limited[0].settings.end_time = 50;  // the clock is looked at once in 64 steps
  time_runs(mechanism, start, limited,
            {.how = Timing::once, .max_cpu_seconds = 1e-9, .going_on = {}, .at_step = {}});
  EXPECT_TRUE(std::isnan(limited[0].cpu_s));
  EXPECT_NE(limited[0].untimed.find("time limit"), std::string::npos) << limited[0].untimed;
}

// What faded rows are centred on, singularity handling and stages for dense output are all of the
// step under way: a run that is looked at in every step, from whatever tree is swept, takes the
// steps of one that is not. Through flat and singular poses, where such things count.
class Repeats : public testing::TestWithParam<const char*> {};

TEST_P(Repeats, TakeTheStepsOfTheMeasuredRun) {
  const std::string method = GetParam();
  const bool multistep = method == "adams" || method == "bdf";
  int compared = 0;
  for (const char* file : {"extremes/three_cranks.toml", "slider_crank/scene.toml",
                           "models/epr_robot_delta/robot.urdf"}) {
    const Mechanism mechanism(equations::example(file));
    const Start start = assemble(mechanism).start;
    const IntegratedScene integrated(mechanism, start);
    for (const std::string& form : form_names())
      for (const char* gauge : {"none", "leak", "reset"}) {
        if (!takes_gauge(form) && std::string(gauge) != "none") continue;
        RunRequest request;
        request.integrated = &integrated;
        request.settings = default_settings(mechanism.scene().run, form, method, 1e-6);
        if (takes_gauge(form)) request.settings.gauge = gauge;
        if (multistep) request.settings.project = false;
        if (integrator(method).step == Integrator::Step::fixed) request.settings.step = 2e-3;
        request.settings.end_time = 0.7;
        request.settings.samples = 70;
        request.max_cpu_seconds = 5;
        RunResult run;
        try {
          run = run_form(mechanism, start, request);
        } catch (const std::invalid_argument&) {
          continue;  // the method does not take this form or gauge
        }
        if (run.status != "done") continue;
        const std::string name = std::string(file) + " " + form + " " + gauge;
        const TimedRun repeat =
            time_run(integrated.mechanism(), integrated.start(), run.settings, 10);
        EXPECT_EQ(repeat.counters.steps, run.counters.steps) << name;
        EXPECT_EQ(repeat.counters.rejected, run.counters.rejected) << name;
        EXPECT_EQ(repeat.counters.newton_iterations, run.counters.newton_iterations) << name;
        ++compared;
      }
  }
  EXPECT_GE(compared, 3);
}

INSTANTIATE_TEST_SUITE_P(Timing, Repeats,
                         testing::Values("dp5", "dop853", "vern9", "rk4", "adams", "bdf", "gauss4",
                                         "ida", "bdf5", "radau5", "hem5", "hem8",
                                         "generalised-alpha"));

TEST(Timing, NamesWhatItKnows) {
  EXPECT_EQ(timing_named("once"), Timing::once);
  EXPECT_THROW(timing_named("twice"), std::invalid_argument);
}

}  // namespace
}  // namespace momenta::dae_timing
