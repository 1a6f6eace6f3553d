// Drifts of lengths and of angles are told apart: against Φ and Φ̇ of every sample, row by row; and
// what tables, files and sentences call them.

#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

#include <dae/output/page/synthetic_study.h>
#include <gtest/gtest.h>
#include <momenta/dae/output/conclusion.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/output/json.h>
#include <momenta/dae/output/table.h>
#include <momenta/dae/run/loop_closure_monitor.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/extremes.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <algorithm>
#include <sstream>

namespace momenta::dae_drift_units {
namespace {

using equations::example;

/// Two rods whose angles a coupler ties, one to −0.5, falling from rest.
Scene coupled_rods() {
  Scene scene;
  scene.name = "coupled rods";
  scene.gravity = {0, -9.81, 0};
  scene.bodies = {equations::rod("a"), equations::rod("b")};
  scene.joints = {equations::hinge("A", "ground", "a", {0, 0, 0}, 0),
                  equations::hinge("B", "ground", "b", {3, 0, 0}, 0)};
  LoopSpec coupler;
  coupler.name = "gear";
  coupler.kind = LoopKind::coupler;
  coupler.joints = {"A", "B"};
  coupler.ratios = {1, -0.5};
  scene.loops = {coupler};
  return scene;
}

RunResult run_of(const Mechanism& mechanism, const std::string& form, double end) {
  return run_form(mechanism, assemble(mechanism).start,
                  equations::kept(equations::stepped(form, "rk4", "none", end / 200, end, 20)));
}

std::size_t column(const RunResult& run, const std::string& name) {
  const auto& all = run.trajectory.columns;
  return static_cast<std::size_t>(std::find(all.begin(), all.end(), name) - all.begin());
}

/// Whether the columns behind the status of a table are in these units.
bool has_units(const std::string& table, const std::vector<std::string>& units) {
  std::istringstream words(table.substr(table.find("status") + 6));
  for (const std::string& unit : units) {
    std::string word;
    if (!(words >> word) || word != unit) return false;
  }
  return true;
}

/// Angles by what the rows are called.
bool is_angle(const std::string& what) {
  return what.find("against") != std::string::npos || what.rfind("angle", 0) == 0;
}

TEST(DriftUnits, OfAScenesWithBothAreApart) {
  for (const char* name : {"as it is", "turned"}) {
    Scene scene = example("bricard");
    if (name[0] == 't')
      scene = turned(scene, Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX())));
    const Mechanism mechanism(scene);
    ASSERT_TRUE(mechanism.has_lengths() && mechanism.has_angles()) << name;
    const RunResult run = run_of(mechanism, "acceleration", 1);
    ASSERT_EQ(run.status, "done") << run.reason;
    EXPECT_EQ(run.drift_unit, "m");
    const auto e = mechanism.evaluation<double>();
    Eigen::VectorXd phi(mechanism.m()), rate(mechanism.m());
    double most[4]{};
    const auto first_u = static_cast<std::size_t>(1 + mechanism.nq());
    for (const auto& row : run.trajectory.rows) {
      e->place(row[0], &row[1]);
      e->positions(phi.data());
      e->move(&row[first_u]);
      e->velocities(rate.data());
      double sum[4]{};
      for (int i = 0; i < mechanism.m(); ++i) {
        const bool angle = is_angle(mechanism.rows()[static_cast<std::size_t>(i)].what);
        sum[angle ? 2 : 0] += phi[i] * phi[i];
        sum[angle ? 3 : 1] += rate[i] * rate[i];
      }
      const char* const names[] = {"position_drift [m]", "velocity_drift [m/s]",
                                   "angle_drift [rad]", "angle_rate_drift [rad/s]"};
      for (int k = 0; k < 4; ++k) {
        EXPECT_NEAR(row[column(run, names[k])], std::sqrt(sum[k]), 1e-13) << name << names[k];
        most[k] = std::max(most[k], std::sqrt(sum[k]));
      }
    }
    EXPECT_NEAR(run.position_drift_max, most[0], 1e-13);
    EXPECT_NEAR(run.velocity_drift_max, most[1], 1e-13);
    EXPECT_NEAR(run.angle_drift_max, most[2], 1e-13);
    EXPECT_NEAR(run.angle_rate_drift_max, most[3], 1e-13);
    EXPECT_GT(run.angle_drift_max, 1e-12) << name;
    EXPECT_GT(std::abs(run.angle_drift_max - run.position_drift_max), 1e-12);
    EXPECT_FALSE(std::isnan(run.angle_between_steps_max));

    StudyResult study;
    study.runs = {run};
    const auto json = summary_json(run, {}).at("drift");
    EXPECT_EQ(json.at("position_max"), run.position_drift_max);
    EXPECT_EQ(json.at("unit"), "m");
    EXPECT_EQ(json.at("angle_max"), run.angle_drift_max);
    EXPECT_EQ(json.at("angle_rate_max"), run.angle_rate_drift_max);
    const std::string table = drift_table(study), csv = study_csv(study);
    EXPECT_TRUE(has_units(table, {"[m]", "[m/s]", "[rad]", "[rad/s]", "[J]"})) << table;
    EXPECT_NE(csv.find("position_drift_max [m]"), std::string::npos);
    EXPECT_NE(csv.find("angle_drift_max [rad]"), std::string::npos);
    EXPECT_NE(answer(study).find(" rad"), std::string::npos) << answer(study);
  }
}

TEST(DriftUnits, OfAnglesAloneAreInRadians) {
  const Mechanism mechanism(coupled_rods());
  EXPECT_FALSE(mechanism.has_lengths());
  const RunResult run = run_of(mechanism, "acceleration", 4);
  ASSERT_EQ(run.status, "done") << run.reason;
  EXPECT_EQ(run.drift_unit, "rad");
  EXPECT_TRUE(std::isnan(run.angle_drift_max));
  EXPECT_TRUE(run.series.angle_drift.empty());
  double most = 0;
  for (const auto& row : run.trajectory.rows)
    most = equations::larger(most, std::abs(row[1] - row[2] / 2));
  EXPECT_NEAR(run.position_drift_max, most, 1e-14);
  EXPECT_LT(column(run, "position_drift [rad]"), run.trajectory.columns.size());
  EXPECT_LT(column(run, "velocity_drift [rad/s]"), run.trajectory.columns.size());
  StudyResult study;
  study.runs = {run};
  EXPECT_NE(study_csv(study).find("position_drift_max [rad],velocity_drift_max [rad/s]"),
            std::string::npos);
  EXPECT_TRUE(has_units(drift_table(study), {"[rad]", "[rad/s]", "[J]"})) << drift_table(study);
  EXPECT_EQ(summary_json(run, {}).at("drift").at("unit"), "rad");
  EXPECT_TRUE(summary_json(run, {}).at("drift").at("angle_max").is_null());
}

TEST(DriftUnits, OfLengthsAloneAreInMetres) {
  const Mechanism mechanism(example("four_bar"));
  EXPECT_FALSE(mechanism.has_angles());
  const RunResult run = run_of(mechanism, "acceleration", 1);
  EXPECT_EQ(run.drift_unit, "m");
  EXPECT_TRUE(std::isnan(run.angle_drift_max));
  StudyResult study;
  study.runs = {run};
  const std::string table = drift_table(study);
  EXPECT_TRUE(has_units(table, {"[m]", "[m/s]", "[J]"})) << table;
}

/// Where lengths stay closed and angles do not, it is these that runs are compared by.
TEST(DriftUnits, ConclusionsAreAboutWhatDrifts) {
  RunResult a = synthetic::run_of({"acceleration", 1e-18}, 10, 100),
            m = synthetic::run_of({"momentum", 1e-18}, 10, 100);
  a.drift_unit = m.drift_unit = "m";
  a.angle_drift_max = 0.03;
  m.angle_drift_max = 0.002;
  a.series.angle_drift = {0, 0.03};
  m.series.angle_drift = {0, 0.002};
  const std::string text = answer(synthetic::study_of({a, m}));
  EXPECT_EQ(text.rfind("After 10 s the position drift of `acceleration` is 0.03 rad", 0), 0u)
      << text;
  EXPECT_NE(text.find("`momentum` 0.002 rad"), std::string::npos) << text;
  a.position_drift_max = 0.5;
  a.series.position_drift.back() = 0.5;
  const std::string both = answer(synthetic::study_of({a, m}));
  EXPECT_EQ(both.rfind("After 10 s the position drift of `acceleration` is 0.5 m and 0.03 rad", 0),
            0u)
      << both;
}

TEST(DriftUnits, WhatComesApartHasItsUnit) {
  const Mechanism mechanism(example("bricard"));
  RunSettings settings;
  settings.integrator = "dop853";
  LoopClosureMonitor apart(mechanism, settings);
  Eigen::VectorXd phi = Eigen::VectorXd::Zero(mechanism.m());
  for (int i = 0; i < mechanism.m(); ++i) {
    phi.setZero();
    phi[i] = 10;
    const std::string said = apart.found(1, phi, true);
    const bool angle = is_angle(mechanism.rows()[static_cast<std::size_t>(i)].what);
    EXPECT_NE(said.find(angle ? "is open by 10 rad," : "of the scene's length,"), std::string::npos)
        << said;
  }
}

}  // namespace
}  // namespace momenta::dae_drift_units
