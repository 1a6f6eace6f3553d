// Every example assembles, and what has a reference meets it. The tolerances are those of each
// integrator's promise with room for the growth of local errors over the run.
#include "equations/ensemble.h"
#include "equations/runs.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/run/run_form.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

namespace momenta::dae_examples {
namespace {

const std::filesystem::path examples = std::filesystem::path(MOMENTA_SOURCE_DIR) / "examples";

RunResult run_against_reference(const std::string& example, const std::string& form,
                                const std::string& gauge, double tol, double end,
                                const std::string& scene = "scene.toml", int samples = 10,
                                bool project = false) {
  const Mechanism mechanism(read_scene(examples / example / scene));
  Reference reference(examples / example / "reference.csv");
  reference.bind(trajectory_columns(mechanism));
  RunRequest request = equations::adaptive(form, "dop853", gauge, tol, end, samples);
  request.settings.project = project;
  request.reference = &reference;
  const RunResult run = run_form(mechanism, equations::start_of(mechanism), request);
  EXPECT_EQ(run.status, "done") << run.reason;
  return run;
}

TEST(Examples, EverySceneAssembles) {
  int scenes = 0;
  for (const auto& folder : std::filesystem::directory_iterator(examples)) {
    if (!folder.is_directory()) continue;
    for (const auto& file : std::filesystem::directory_iterator(folder)) {
      if (file.path().extension() != ".toml") continue;
      SCOPED_TRACE(file.path().string());
      ++scenes;
      const Mechanism mechanism(read_scene(file.path()));
      const Assembly a = assemble(mechanism);
      EXPECT_LE(a.position_residual, 1e-12);
      EXPECT_LE(a.velocity_residual, 1e-11);
      // The folder's reference is that of its scene, however written; the swing and the pendulum in
      // space are others.
      if (const auto csv = folder.path() / "reference.csv";
          std::filesystem::exists(csv) && file.path().filename() != "swing.toml" &&
          file.path().filename() != "in_space.toml") {
        EXPECT_NO_THROW(Reference(csv).bind(trajectory_columns(mechanism)));
      }
    }
  }
  EXPECT_GE(scenes, 11);
}

// The IVP Test Set's start is consistent to all digits of a double, and its crank acceleration is
// known.
TEST(Examples, AndrewsStartsAsPublished) {
  const Mechanism mechanism(read_scene(examples / "andrews" / "scene.toml"));
  const auto e = mechanism.evaluation<double>();
  Eigen::VectorXd phi(mechanism.m());
  e->place(0, mechanism.tree().q0.data());
  e->positions(phi.data());
  EXPECT_LE(phi.lpNorm<Eigen::Infinity>(), 1e-16);

  const Assembly a = assemble(mechanism);
  EXPECT_EQ(a.mobility, 1);
  EXPECT_EQ(a.rank, 6);
  const int crank =
      mechanism.tree().bodies[static_cast<std::size_t>(mechanism.tree().carried_by("O"))].u;
  EXPECT_NEAR(a.start.udot[crank] / 14222.4439199541387, 1, 1e-13);
}

TEST(Examples, AndrewsMeetsItsReference) {
  EXPECT_LE(
      run_against_reference("andrews", "momentum", "leak:300", 1e-10, 0.03).position_error_max,
      1e-8);
  const RunResult tight = run_against_reference("andrews", "momentum", "leak:300", 1e-12, 0.03);
  EXPECT_LE(tight.position_error_max, 1e-10);
  EXPECT_LE(tight.velocity_error_max,
            1e-7);  // rates are 1e3 times the angles here, and change in 1e-4 s
  EXPECT_LE(tight.energy_error_max, 1e-10);
  EXPECT_LE(run_against_reference("andrews", "acceleration", "", 1e-12, 0.03).position_error_max,
            1e-10);
}

TEST(Examples, FourBarMeetsItsReference) {
  const RunResult run = run_against_reference("four_bar", "momentum", "leak:3", 1e-12, 10);
  EXPECT_LE(run.position_error_max, 1e-8);
  EXPECT_LE(run.velocity_error_max, 1e-7);
  EXPECT_LE(run.position_drift_max, 1e-10);
}

// Through seven bifurcations in ten seconds, on the wanted branch.
TEST(Examples, SliderCrankKeepsItsBranch) {
  for (const auto& [form, gauge] : {std::pair("momentum", "reset"), std::pair("projected", "")}) {
    SCOPED_TRACE(form);
    const RunResult run =
        run_against_reference("slider_crank", form, gauge, 1e-10, 10, "scene.toml", 10, true);
    EXPECT_LE(run.position_error_max, 1e-6);
    EXPECT_LE(run.energy_error_max, 1e-6);
  }
}

TEST(Examples, SpatialSliderCrankMeetsItsReference) {
  const RunResult run =
      run_against_reference("spatial_slider_crank", "momentum", "reset", 1e-12, 5);
  EXPECT_LE(run.position_error_max, 1e-8);
  EXPECT_LE(run.energy_error_max, 1e-9);
  // Its start in closed form.
  const Mechanism mechanism(read_scene(examples / "spatial_slider_crank" / "scene.toml"));
  const Eigen::VectorXd u = assemble(mechanism).start.u;
  EXPECT_NEAR(u[1], 0.24, 1e-12);
  EXPECT_NEAR(u[2], 1.92, 1e-12);
  EXPECT_NEAR(u[3], std::hypot(0.96, 0.48), 1e-12);
}

TEST(Examples, BricardMeetsItsReference) {
  const RunResult run =
      run_against_reference("bricard", "momentum", "reset", 1e-12, 10, "scene.toml", 10, true);
  EXPECT_LE(run.position_error_max, 1e-8);
  EXPECT_LE(run.energy_error_max, 1e-9);
  EXPECT_LE(run.position_drift_max, 1e-13);
}

RunRequest tightest_four_bar(double tol, double end, int samples) {
  return equations::adaptive("momentum", "vern9", "reset", tol, end, samples);
}

// What is left at such tolerances is rounding: 1.6e-13 to 1.3e-12 from one tolerance to the next,
// so that one run tells nothing; in the mean 7.5e-13 without fused multiply-adds, less with them.
// Sums that carry nothing and a reset by M u leave 2.6e-12 and 4.5e-12.
TEST(Examples, FourBarMeetsItsReferenceToRounding) {
  const Mechanism mechanism(read_scene(examples / "four_bar" / "scene.toml"));
  Reference reference(examples / "four_bar" / "reference.csv");
  reference.bind(trajectory_columns(mechanism));
  const std::vector<double> tolerances{3e-14, 2e-14, 1.4e-14, 1e-14, 7e-15, 5e-15, 4e-15, 3e-15};
  double digits = 0;
  for (const double tol : tolerances) {
    RunRequest request = tightest_four_bar(tol, 10, 1000);
    request.reference = &reference;
    const RunResult run = run_form(mechanism, equations::start_of(mechanism), request);
    ASSERT_EQ(run.status, "done") << run.reason;
    digits += std::log10(run.position_error_max);
  }
#ifdef __FMA__
  constexpr double least = 7e-13;
#else
  constexpr double least = 1e-12;
#endif
  EXPECT_LE(std::pow(10, digits / static_cast<double>(tolerances.size())), least);
}

// One degree of freedom, no losses, a start at rest: the motion repeats itself. Its period is read
// off reference.csv to 19 digits.
TEST(Examples, FourBarReturnsAfterAThousandSeconds) {
  const Mechanism mechanism(read_scene(examples / "four_bar" / "scene.toml"));
  Reference reference(examples / "four_bar" / "reference_1000s.csv");
  reference.bind(trajectory_columns(mechanism));
  const double period = 3.78905311436032861;
  const Start start = equations::start_of(mechanism);
  RunRequest request = tightest_four_bar(1e-13, 1000, 100);
  request.settings.project = true;
  request.reference = &reference;
  const RunResult judged = run_form(mechanism, start, request);
  ASSERT_EQ(judged.status, "done") << judged.reason;
  EXPECT_LE(judged.position_error_max, 1e-6);
  EXPECT_GT(judged.position_error_max, 1e-12);  // something was compared
  request = tightest_four_bar(1e-13, 263 * period, 1);
  request.keep_trajectory = true;
  const RunResult run = run_form(mechanism, start, request);
  ASSERT_EQ(run.status, "done") << run.reason;
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(run.trajectory.rows.back()[1 + i], start.q[static_cast<Eigen::Index>(i)], 1e-6);
}

TEST(Examples, DrivenMeetsItsReference) {
  EXPECT_LE(run_against_reference("driven", "momentum", "reset", 1e-12, 10).position_error_max,
            1e-9);
  EXPECT_LE(run_against_reference("driven", "acceleration", "", 1e-12, 10).position_error_max,
            1e-8);
}

TEST(Examples, PendulumMeetsItsReference) {
  EXPECT_LE(run_against_reference("pendulum", "momentum", "none", 1e-12, 10).position_error_max,
            1e-10);
  EXPECT_LE(run_against_reference("pendulum", "momentum", "leak:3", 1e-12, 10, "cartesian.toml")
                .position_error_max,
            1e-10);
}

// Samples between the reference's times, and beyond its end, carry no error and hide none.
TEST(Examples, LargestErrorIsThatOfTheSeries) {
  const RunResult run =
      run_against_reference("four_bar", "momentum", "leak:3", 1e-6, 10.5, "scene.toml", 1050 * 7);
  double largest = 0;
  for (double error : run.series.position_error)
    if (error > largest) largest = error;  // false for what was not measured
  EXPECT_GT(largest, run.series.position_error.front());
  EXPECT_EQ(run.position_error_max, largest);
}

// It turns over every 5 s and spends the time between near an unstable axis, where errors grow like
// exp(2.9 t).
TEST(Examples, FreeBodyMeetsItsReference) {
  EXPECT_LE(run_against_reference("free_body", "momentum", "none", 1e-12, 20).position_error_max,
            1e-8);
}

TEST(Examples, ChainMeetsItsReference) {
  EXPECT_LE(run_against_reference("chain", "momentum", "none", 1e-12, 5).position_error_max, 1e-7);
}

/// An open chain of examples/extremes against its reference.
RunResult run_extreme(const std::string& name, const std::string& form, double tol) {
  const auto folder = examples / "extremes";
  const Mechanism mechanism(read_scene(folder / (name + ".toml")));
  Reference reference(folder / (name + ".csv"));
  reference.bind(trajectory_columns(mechanism));
  RunRequest request = equations::adaptive(form, "dop853", "none", tol, 10, 10);
  request.reference = &reference;
  const RunResult run = run_form(mechanism, equations::start_of(mechanism), request);
  EXPECT_EQ(run.status, "done") << run.reason;
  return run;
}

TEST(Examples, SpringPendulumMeetsItsReference) {
  for (const char* form : {"momentum", "acceleration"}) {
    EXPECT_LE(run_extreme("spring_pendulum", form, 1e-10).position_error_max, 1e-8) << form;
    EXPECT_LE(run_extreme("spring_pendulum", form, 1e-13).position_error_max, 1e-10) << form;
  }
}

TEST(Examples, LightCartMeetsItsReference) {
  for (const char* form : {"momentum", "acceleration"}) {
    const RunResult run = run_extreme("light_cart", form, 1e-12);
    EXPECT_LE(run.position_error_max, 1e-6) << form;
    EXPECT_GT(run.counters.steps, 100) << form;
  }
}

}  // namespace
}  // namespace momenta::dae_examples
