// A run put down between two steps and taken up in new objects gives what the undisturbed run
// gives, to the last bit: samples, measures, counters.

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/linkages.h"

#include <gtest/gtest.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/study/run_record.h>

#include <cstring>
#include <limits>
#include <random>

namespace momenta::dae_going_on {
namespace {

using namespace equations;
using equations::example;

/// All that a run tells but its times, and its rows.
struct Told {
  std::string record, rows;
};
Told told(RunResult run) {
  Told all;
  for (const auto& row : run.trajectory.rows) all.rows += trajectory_line(row);
  run.cpu_s = run.wall_s = 0;
  all.record = record_of(run).dump();
  return all;
}

RunRequest request_of(const Scene& scene, const std::string& form, const std::string& method) {
  RunRequest request;
  request.settings = default_settings(scene.run, form, method, 1e-8);
  request.settings.end_time = std::min(scene.run.end_time, 1.0);
  request.settings.samples = 37;
  if (method == "rk4") request.settings.step = request.settings.end_time / 211;
  request.keep_trajectory = true;
  request.film_intervals = 23;
  return request;
}

/// How often it was put down; each time it goes on to the end as the undisturbed run does. At
/// `times` places: the first step, the last, and between.
int put_down(const Mechanism& mechanism, RunRequest request, int times = 5) {
  const Start start = start_of(mechanism);
  const Told whole = told(run_form(mechanism, start, request));
  int steps = 0;
  request.between_steps = [&](const auto&) { ++steps; };
  EXPECT_EQ(told(run_form(mechanism, start, request)).record, whole.record);
  if (steps == 0) return 0;
  std::vector<std::pair<Checkpoint, std::vector<std::vector<double>>>> kept;
  std::vector<std::vector<double>> rows;
  request.on_row = [&](const std::vector<double>& row) {
    rows.push_back(row);
    return true;
  };
  int step = 0, next = 0;
  request.between_steps = [&](const std::function<Checkpoint()>& make) {
    if (step++ != next * (steps - 1) / (times - 1)) return;
    kept.emplace_back(make(), rows);
    ++next;
  };
  EXPECT_EQ(told(run_form(mechanism, start, request)).record, whole.record);
  request.between_steps = {};
  for (const auto& [checkpoint, rows_before] : kept) {
    SCOPED_TRACE("t = " + std::to_string(checkpoint.t));
    Checkpoint from;
    const auto text = record_of(checkpoint).dump();
    EXPECT_TRUE(read_record(nlohmann::json::parse(text), from));
    from.so_far.trajectory.rows = rows_before;
    rows.clear();
    request.from = &from;
    const Told again = told(run_form(mechanism, start, request));
    EXPECT_EQ(again.record, whole.record);
    EXPECT_EQ(again.rows, whole.rows);
    EXPECT_EQ(rows.size() + rows_before.size(), 38u);
  }
  return static_cast<int>(kept.size());
}

TEST(GoingOn, EveryFormAndExplicitMethodToTheLastBit) {
  for (const char* name : {"four_bar", "bricard", "driven", "free_body", "chain"}) {
    const Mechanism mechanism(example(name));
    for (const std::string& form : form_names()) {
      if (is_dae_form(form)) continue;
      for (const char* method : {"rk4", "dp5", "dop853", "vern9"}) {
        SCOPED_TRACE(std::string(name) + " " + form + " " + method);
        EXPECT_EQ(put_down(mechanism, request_of(mechanism.scene(), form, method)),
                  form == "partitioned" ? 0 : 5);
      }
    }
  }
}

TEST(GoingOn, GaugesCorrectionsAndSolvers) {
  for (const auto kkt : {KktChoice::sweeps, KktChoice::dense, KktChoice::sparse})
    for (const char* name : {"andrews", "four_bar"}) {
      const Mechanism mechanism(example(name), {Algebra::automatic, kkt});
      for (const char* gauge : {"none", "leak:3", "reset", "flip"})
        for (const bool project : {false, true}) {
          SCOPED_TRACE(std::string(name) + " " + gauge + (project ? " project" : ""));
          RunRequest request = request_of(mechanism.scene(), "momentum", "dop853");
          request.settings.gauge = gauge;
          request.settings.project = project;
          EXPECT_EQ(put_down(mechanism, request), 5);
        }
    }
}

TEST(GoingOn, PastSingularPoses) {
  for (const char* name : {"slider_crank", "n_four_bar"})
    for (const char* form : {"momentum", "projected"}) {
      SCOPED_TRACE(std::string(name) + " " + form);
      const Mechanism mechanism(example(name));
      RunRequest request = request_of(mechanism.scene(), form, "dop853");
      request.settings.gauge = "reset";
      request.settings.project = true;
      EXPECT_EQ(put_down(mechanism, request, 12), 12);
    }
}

TEST(GoingOn, DampersAndProblemsThatTurnOutStiff) {
  Scene s;
  s.name = "damped finger";
  s.gravity = {0, -9.81, 0};
  s.bodies = {rod("a"), rod("b")};
  s.joints = {hinge("A", "ground", "a", {0, 0, 0}, 0.5), hinge("B", "a", "b", {1, 0, 0}, 0.2)};
  for (const double damping : {0.1, 3000.0}) {
    s.joints[1].damping = damping;
    const Mechanism mechanism(s);
    RunRequest request = request_of(s, "momentum", "");
    EXPECT_EQ(request.settings.when_stiff, "bdf");
    const int put = put_down(mechanism, request);
    EXPECT_EQ(put, 5) << damping;
  }
}

TEST(GoingOn, LimitsCountWhatWasSpentBefore) {
  const Mechanism mechanism(example("four_bar"));
  RunRequest request = request_of(mechanism.scene(), "momentum", "dp5");
  request.settings.end_time = 20;  // the clock is read every 64 steps
  Checkpoint from;
  request.between_steps = [&](const auto& make) {
    if (from.memory.empty()) from = make();
  };
  ASSERT_EQ(run_form(mechanism, start_of(mechanism), request).status, "done");
  request.between_steps = {};
  request.from = &from;
  request.max_cpu_seconds = 1e6;
  EXPECT_EQ(run_form(mechanism, start_of(mechanism), request).status, "done");
  from.so_far.cpu_s = 2e6;
  EXPECT_EQ(run_form(mechanism, start_of(mechanism), request).status, "time limit");
}

TEST(GoingOn, WhatIsIncompleteIsRefused) {
  const Mechanism mechanism(example("four_bar"));
  RunRequest request = request_of(mechanism.scene(), "momentum", "dp5");
  Checkpoint from;
  request.between_steps = [&](const auto& make) {
    if (from.memory.empty()) from = make();
  };
  run_form(mechanism, start_of(mechanism), request);
  request.from = &from;
  while (!from.memory.empty()) {
    from.memory.pop_back();
    EXPECT_THROW(run_form(mechanism, start_of(mechanism), request), std::invalid_argument);
  }
}

TEST(GoingOn, RowsReadBackBitForBit) {
  std::mt19937_64 random(7);
  std::vector<std::vector<double>> rows(200), back;
  for (auto& row : rows)
    for (int i = 0; i < 5; ++i) {
      const std::uint64_t bits = random();
      double x;
      static_assert(sizeof x == sizeof bits);
      std::memcpy(&x, &bits, sizeof x);
      row.push_back(x);
    }
  rows[3][4] = rows[5][0] = std::numeric_limits<double>::quiet_NaN();
  rows[4][4] = -std::numeric_limits<double>::infinity();
  const auto text_of = [](const auto& all) {
    std::string text = trajectory_head({"t [s]", "\"a,b\" [m]", "c [m]", "d [m]", "e [m]"});
    for (const auto& row : all) text += trajectory_line(row);
    return text;
  };
  const std::string text = text_of(rows);
  ASSERT_TRUE(read_trajectory_rows(text, 5, back));
  ASSERT_EQ(back.size(), rows.size());
  EXPECT_EQ(text_of(back), text);
  EXPECT_TRUE(std::isnan(back[3][4]));
  EXPECT_FALSE(read_trajectory_rows(text, 4, back));
  EXPECT_FALSE(read_trajectory_rows(text.substr(0, text.size() - 1), 5, back));
  EXPECT_FALSE(read_trajectory_rows("t [s]\n1x\n", 1, back));
  EXPECT_TRUE(read_trajectory_rows("", 5, back));
  EXPECT_TRUE(back.empty());
}

}  // namespace
}  // namespace momenta::dae_going_on
