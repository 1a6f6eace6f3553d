#pragma once
// Studies made of formulas, for the tests of tables and pages: drift d(t) = amplitude · t^exponent
// with a ripple, an oscillating energy error, counters and times of a plausible size.
// Deterministic.

#include <momenta/dae/run/run_result.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace momenta::synthetic {

struct Law {
  std::string form = "momentum";
  double amplitude = 1e-9;  ///< drift at 1 s [m]
  double exponent = 1;
  double cpu_s = 0.5;
  double energy = 1e-8;  ///< amplitude of the energy error [J]
};

/// A finished run that follows the law over (0, end].
inline RunResult run_of(const Law& law, double end = 1000, int samples = 4000) {
  RunResult run;
  run.scene = "Planar four-bar";
  run.settings.form = law.form;
  run.settings.gauge = law.form.rfind("momentum", 0) == 0 ? "leak:10" : "";
  run.settings.kkt = "dense";
  run.settings.end_time = end;
  run.settings.samples = samples;
  run.stopped_at = end;
  run.cpu_s = law.cpu_s;
  run.wall_s = 1.02 * law.cpu_s;
  run.repeats = 3;
  run.counters = {static_cast<long>(43 * end),  17, static_cast<long>(520 * end), 0,
                  static_cast<long>(520 * end), 0};
  Series& s = run.series;
  for (int i = 0; i <= samples; ++i) {
    const double t = end * i / samples;
    const double ripple = 0.25 + 0.75 * std::abs(std::sin(2.3 * t + law.amplitude));
    s.t.push_back(t);
    s.position_drift.push_back(i == 0 ? 0 : law.amplitude * std::pow(t, law.exponent) * ripple);
    s.velocity_drift.push_back(
        i == 0 ? 0 : 4 * law.amplitude * std::pow(t, std::max(0.0, law.exponent - 0.1)) * ripple);
    s.energy_error.push_back(law.energy * (1 + 0.01 * std::pow(t, 0.8)) * std::sin(1.7 * t));
    s.energy.push_back(12 + s.energy_error.back());
    s.impulse.push_back(1.5 + std::sin(1.7 * t));
  }
  const auto largest = [](const std::vector<double>& y) {
    double m = 0;
    for (const double v : y) m = std::max(m, std::abs(v));
    return m;
  };
  run.position_drift_max = largest(s.position_drift);
  run.velocity_drift_max = largest(s.velocity_drift);
  run.between_steps_max = 1.3 * run.position_drift_max;
  run.energy_error_max = largest(s.energy_error);
  run.position_growth = {law.exponent + 0.004, 0.03, 0.1 * end, end};
  run.velocity_growth = {std::max(0.0, law.exponent - 0.1), 0.05, 0.1 * end, end};
  return run;
}

/// The run as if it had failed at `time`: samples up to there are kept.
inline RunResult failed(RunResult run, double time, std::string reason) {
  Series& s = run.series;
  const auto kept = static_cast<std::size_t>(
      std::count_if(s.t.begin(), s.t.end(), [time](double t) { return t <= time; }));
  for (auto* y :
       {&s.t, &s.position_drift, &s.velocity_drift, &s.energy_error, &s.energy, &s.impulse})
    y->resize(kept);
  run.status = "failed";
  run.reason = std::move(reason);
  run.stopped_at = time;
  run.position_growth = run.velocity_growth = {};
  return run;
}

/// Three links with a loop at C.
inline Picture four_bar() {
  using Eigen::Vector3d;
  Picture p;
  p.planar = true;
  p.length = 2;
  const auto link = [&](const char* name, const char* joint, int parent, Vector3d at,
                        double length) {
    Picture::Body body;
    body.name = name;
    body.joint = joint;
    body.joint_kind = "revolute";
    body.parent = parent;
    body.at_parent = std::move(at);
    body.turn = Picture::Turn::about_axis;
    body.com = {0.5 * length, 0, 0};
    body.ends = {Vector3d::Zero(), Vector3d(length, 0, 0)};
    p.bodies.push_back(body);
  };
  link("crank", "O", -1, {0, 0, 0}, 0.7);
  link("coupler", "A", 0, {0.7, 0, 0}, 2);
  link("rocker", "B", -1, {2.5, 0, 0}, 1.3);
  p.loops = {{"C", "revolute", 1, 2, {2, 0, 0}, {1.3, 0, 0}}};
  p.markers = {{"P", 1, {1, 0, 0}}};
  return p;
}

/// The crank turns once a second; the loop opens like t.
inline Motion motion(int run, double end, std::size_t frames) {
  Motion m;
  m.run = run;
  m.every = frames > 1 ? end / static_cast<double>(frames - 1) : 0;
  for (std::size_t k = 0; k < frames; ++k) {
    const double t = m.every * static_cast<double>(k);
    const auto about_z = [](double angle) {
      return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
    };
    Motion::Frame frame;
    frame.turn = {about_z(6.283185307179586 * t), about_z(-6 * t), about_z(2 + std::sin(t))};
    frame.translation = {{0, 0, 0}, {0.7, 0, 0}, {2.5, 0, 0}};
    frame.gap = {Eigen::Vector3d(1e-6 * t, 0, 0)};
    m.frames.push_back(frame);
  }
  return m;
}

inline StudyResult study_of(std::vector<RunResult> runs) {
  StudyResult study;
  study.scene = "Planar four-bar";
  study.scene_file = "examples/planar-four-bar/scene.toml";
  study.scene_hash = "6f1c2a9d04b7e358";
  study.command =
      "momenta drift examples/planar-four-bar/scene.toml --end 1000 --rtol 1e-8 --gauge leak:10 "
      "--out drift";
  study.plan = {{"kernel", "planar, 3 components"},
                {"gravity", "yes"},
                {"rheonomic terms", "none"},
                {"loops", "1 revolute (2 equations)"},
                {"KKT", "dense"}};
  study.environment = {
      "Example processor at 3.0 GHz",
      "GNU 12.2.0",
      "-O3 -fno-math-errno",
      "Release",
      4,
      {{"momenta", "0.1.0"}, {"SUNDIALS", "6.4.1"}, {"SuiteSparse", "5.12.0"}, {"Eigen", "3.4.0"}},
      "2025-03-01T12:00:00Z"};
  study.picture = four_bar();
  study.motions = {motion(-1, 0, 1)};
  study.runs = std::move(runs);
  return study;
}

/// Every form, two of them failed: what `momenta drift` makes of all forms.
inline StudyResult all_forms() {
  std::vector<RunResult> runs;
  for (const Law& law : std::vector<Law>{{"momentum", 3.5e-9, 1.0, 0.52, 2e-8},
                                         {"momentum-index1", 4.4e-9, 1.1, 1.9, 6e-8},
                                         {"momentum-index2", 2e-11, 0.0, 2.3, 1e-6},
                                         {"momentum-stabilised", 1.1e-12, 0.0, 2.9, 4e-7},
                                         {"momentum-index3", 6e-12, 0.1, 3.4, 2e-6},
                                         {"acceleration", 2.7e-7, 2.0, 0.5, 3e-8},
                                         {"acceleration-index1", 3.1e-7, 2.0, 1.6, 1.5e-7},
                                         {"acceleration-index2", 9e-9, 1.0, 2.0, 5e-7},
                                         {"acceleration-index3", 5e-11, 0.05, 3.1, 3e-6},
                                         {"stabilised-index2", 2.2e-12, 0.0, 3.0, 6e-7},
                                         {"baumgarte", 8e-9, 0.0, 0.61, 8e-8},
                                         {"projected", 4e-16, 0.02, 0.7, 2.5e-8},
                                         {"partitioned", 9e-15, 0.0, 1.2, 3.5e-8},
                                         {"augmented-lagrangian", 6e-10, 0.6, 1.4, 9e-7},
                                         {"augmented-lagrangian-canonical", 5e-10, 0.5, 1.5, 8e-7},
                                         {"maximal-coordinates", 3e-8, 1.9, 2.6, 7e-8}}) {
    runs.push_back(run_of(law));
    RunResult& run = runs.back();
    if (law.form.find("index") != std::string::npos ||
        law.form.find("stabilised") != std::string::npos) {
      run.settings.integrator = "ida";
      run.settings.kkt.clear();
      run.jacobian = "dual numbers";
      run.linear_solver = "KLU";
      run.counters.jacobians = run.counters.factorizations = 2113;
      run.counters.newton_iterations = 61'020;
    }
  }
  runs[10].settings.baumgarte_alpha = runs[10].settings.baumgarte_beta = 20;
  runs[8] = failed(
      runs[8], 31.4,
      "IDA could not converge at t = 31.4 s: the error test failed repeatedly at |h| = 1e-12.");
  runs[12] = failed(
      runs[12], 412.0,
      "No independent coordinates are left at t = 412 s: rank of the loops fell from 2 to 1.");
  return study_of(std::move(runs));
}

/// Errors against a reference over a ladder of tolerances: what `momenta work` makes.
inline StudyResult ladder() {
  std::vector<RunResult> runs;
  for (const std::string form : {"momentum", "acceleration", "projected"}) {
    for (const std::string integrator : {"dop853", "adams"}) {
      const double order = integrator == "dop853" ? 8.0 : 5.0;
      const double start = form == "momentum" ? 0.05 : form == "acceleration" ? 0.045 : 0.07;
      for (int k = 4; k <= 12; k += 2) {
        const double tolerance = std::pow(10.0, -k);
        RunResult run = run_of(
            {form, 1e2 * tolerance, form == "acceleration" ? 2.0 : 1.0, 0, tolerance}, 10, 400);
        run.settings.integrator = integrator;
        run.settings.rtol = run.settings.atol = tolerance;
        run.cpu_s = start * std::pow(10.0, (k - 4) / order) * (order < 8 ? 0.6 : 1.0);
        run.position_error_max = (form == "projected" ? 3 : 12) * tolerance;
        run.velocity_error_max = 4 * run.position_error_max;
        for (const double t : run.series.t) {
          run.series.position_error.push_back(run.position_error_max * t / 10);
        }
        runs.push_back(std::move(run));
      }
    }
  }
  StudyResult study = study_of(std::move(runs));
  study.command =
      "momenta work examples/planar-four-bar/scene.toml --end 10 --reference reference.csv";
  study.reference = "reference.csv";
  study.drift_study = false;
  return study;
}

}  // namespace momenta::synthetic
