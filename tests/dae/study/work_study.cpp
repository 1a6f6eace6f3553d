// What momenta work rests on: the quad-precision motion and its integrator, the front, the words.

#include "equations/ensemble.h"
#include "equations/linkages.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/integrator/extrapolation.h>
#include <momenta/dae/integrator/radau_collocation.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/output/advice.h>
#include <momenta/dae/output/table.h>
#include <momenta/dae/run/force_columns.h>
#include <momenta/dae/run/measure/growth.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/own_reference.h>
#include <momenta/dae/study/quad_motion.h>
#include <momenta/dae/study/work_study.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

namespace momenta::dae_work_study {
namespace {

std::filesystem::path example(const std::string& name, const std::string& file) {
  return std::filesystem::path(MOMENTA_SOURCE_DIR) / "examples" / name / file;
}

TEST(Extrapolation, TurnsAnOscillatorToThirtyDigits) {
  // q'' = −q from (1, 0): after t = 1 q = cos 1.
  std::vector<Quad> y{1.0, 0.0};
  Extrapolation<Quad> method(2);
  const auto rhs = [](double, const Quad* x, Quad* rate) {
    rate[0] = x[1];
    rate[1] = -x[0];
    return true;
  };
  for (int i = 0; i < 8; ++i) ASSERT_TRUE(method.step(0, 0.125, y, 1e-29, rhs));
  EXPECT_LT(std::abs(value_of(y[0] - cos(Quad(1.0)))), 1e-29);
  EXPECT_LT(std::abs(value_of(y[1] + sin(Quad(1.0)))), 1e-29);
}

TEST(Extrapolation, RefusesAStepTooLong) {
  std::vector<double> y{1.0};
  Extrapolation<double> method(1);
  const auto stiff = [](double, const double* x, double* rate) {
    rate[0] = -1e4 * x[0];
    return true;
  };
  EXPECT_FALSE(method.step(0, 1.0, y, 1e-12, stiff));
  EXPECT_EQ(y[0], 1.0);
  EXPECT_FALSE(method.step(0, 1.0, y, 1e-12, [](double, const double*, double*) { return false; }));
}

TEST(RadauCollocation, HasTheNodesAndWeightsOfRadau) {
  const RadauNodes<Quad> two(2), nine(9);
  const double exact[2][2] = {{5.0 / 12, -1.0 / 12}, {3.0 / 4, 1.0 / 4}};
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j) EXPECT_NEAR(value_of(two.a[i][j]), exact[i][j], 1e-16);
  // The last row integrates powers up to 2s − 2, the others up to s − 1.
  for (int power = 0; power <= 16; ++power) {
    Quad sum = 0.0, at_start = 0.0;
    for (std::size_t j = 0; j < 9; ++j) {
      Quad term = 1.0;
      for (int k = 0; k < power; ++k) term *= nine.c[j];
      sum += nine.a[8][j] * term;
      at_start += nine.at_start[j] * term;
    }
    EXPECT_LT(std::abs(value_of(sum - Quad(1.0) / Quad(power + 1.0))), 1e-26) << power;
    if (power < 9) {
      EXPECT_LT(std::abs(value_of(at_start - Quad(power == 0 ? 1.0 : 0.0))), 1e-26) << power;
    }
  }
}

// The problem of Prothero and Robinson, x' = λ (x − cos t) − sin t, x = cos t, and beside it
// y' = −x y: steps are as long as cos t lets them be, whatever λ.
TEST(RadauCollocation, TakesStiffProblemsInLongSteps) {
  for (const double lambda : {-1.0, -1e3, -1e6, -1e9}) {
    std::vector<Quad> y{1.0, 1.0};
    OdeRadauCollocation<Quad> method(2);
    const auto rhs = [&](double t, const Quad* x, Quad* rate) {
      rate[0] = Quad(lambda) * (x[0] - cos(Quad(t))) - sin(Quad(t));
      rate[1] = -x[0] * x[1];
      return true;
    };
    const double h = 0.125;
    for (int i = 0; i < 16; ++i) ASSERT_TRUE(method.step(i * h, h, y, 1e-14, rhs)) << lambda << i;
    // Stages are at times that are doubles.
    EXPECT_LT(std::abs(value_of(y[0] - cos(Quad(2.0)))), 1e-14) << lambda;
    EXPECT_NEAR(value_of(y[1]), std::exp(-std::sin(2.0)), 1e-14) << lambda;
  }
}

TEST(RadauCollocation, RefusesAStepTooLong) {
  std::vector<double> y{1.0};
  OdeRadauCollocation<double> method(1);
  const auto fast = [](double t, const double*, double* rate) {
    rate[0] = std::cos(40 * t);
    return true;
  };
  EXPECT_FALSE(method.step(0, 1.0, y, 1e-12, fast));
  EXPECT_EQ(y[0], 1.0);
  EXPECT_FALSE(method.step(0, 1.0, y, 1e-12, [](double, const double*, double*) { return false; }));
}

TEST(QuadMotion, HasTheRatesOfTheAccelerationForm) {
  for (const char* name : {"four_bar", "andrews", "slider_crank", "free_body", "pendulum"}) {
    const Mechanism mechanism(read_scene(example(name, "scene.toml")));
    const Start start = equations::start_of(mechanism);
    const auto n = static_cast<std::size_t>(mechanism.nq() + mechanism.nv());
    std::vector<Quad> y(start.q.begin(), start.q.end()), rates(n);
    y.insert(y.end(), start.u.begin(), start.u.end());
    const auto motion = make_quad_motion(mechanism);
    ASSERT_TRUE(motion->project(0, y.data()));
    ASSERT_TRUE(motion->rates(0, y.data(), rates.data()));
    const double largest = 1 + start.udot.cwiseAbs().maxCoeff();
    for (int i = 0; i < mechanism.nv(); ++i)
      EXPECT_NEAR(value_of(rates[static_cast<std::size_t>(mechanism.nq() + i)]), start.udot[i],
                  1e-11 * largest)
          << name << " " << i;
  }
}

TEST(OwnReference, AgreesWithThoseOfOthers) {
  // The references of the examples come from other equations, other code and 16 digits or more.
  for (const auto& [name, end, bound] :
       {std::tuple{"andrews", 0.01, 1e-12}, std::tuple{"four_bar", 2.0, 1e-10},
        std::tuple{"pendulum", 2.0, 1e-11}}) {
    const Mechanism mechanism(read_scene(example(name, "scene.toml")));
    const Start start = equations::start_of(mechanism);
    const OwnReference own = own_reference(mechanism, start, end, 20);
    EXPECT_LT(own.accuracy, 1e-14) << name;
    Reference other(example(name, "reference.csv"));
    RunRequest request = equations::adaptive("acceleration", "dop853", "none", 1e-13, end, 20);
    request.settings.project = mechanism.m() > 0;
    request.reference = &own.reference;
    const RunResult by_own = run_form(mechanism, start, request);
    other.bind(trajectory_columns(mechanism));
    request.reference = &other;
    const RunResult by_other = run_form(mechanism, start, request);
    EXPECT_LT(by_own.position_error_max, bound) << name;
    EXPECT_NEAR(by_own.position_error_max, by_other.position_error_max, bound) << name;
  }
}

/// A pendulum of two rods with a damper between them.
Scene finger(double damping) {
  Scene s;
  s.name = "damped finger";
  s.gravity = {0, -9.81, 0};
  s.bodies = {equations::rod("a"), equations::rod("b")};
  s.joints = {equations::hinge("A", "ground", "a", {0, 0, 0}, 0.5),
              equations::hinge("B", "a", "b", {1, 0, 0}, 0.2)};
  s.joints[1].damping = damping;
  return s;
}

/// Errors of runs in doubles are the same by either; only a stiff motion is taken implicitly.
TEST(OwnReference, OfStiffMotionsIsMadeImplicitly) {
  EXPECT_FALSE(
      own_reference(Mechanism(finger(0.1)), equations::start_of(Mechanism(finger(0.1))), 1, 10)
          .implicit);
  Scene bar = read_scene(example("four_bar", "scene.toml"));
  bar.bodies.push_back(equations::rod("finger"));
  bar.joints.push_back(equations::hinge("F", bar.joints.front().child, "finger", {0.2, 0, 0}, 0.2));
  bar.joints.back().damping = 3000;
  for (const Scene& scene : {finger(3000), bar}) {
    const Mechanism mechanism(scene);
    const Start start = equations::start_of(mechanism);
    const OwnReference own = own_reference(mechanism, start, 1, 10);
    EXPECT_TRUE(own.implicit) << scene.name;
    EXPECT_LT(own.accuracy, 1e-14) << scene.name;
    EXPECT_NE(in_words(own).find("Radau"), std::string::npos);
    RunRequest request = equations::adaptive("acceleration", "dop853", "none", 1e-12, 1, 10);
    request.settings.project = mechanism.m() > 0;
    request.reference = &own.reference;
    const RunResult tight = run_form(mechanism, start, request);
    EXPECT_EQ(tight.status, "done") << tight.reason;
    EXPECT_LT(tight.position_error_max, 1e-10) << scene.name;
    EXPECT_LT(tight.velocity_error_max, 1e-8) << scene.name;
  }
}

RunResult run(const std::string& form, double rtol, double error, double cpu) {
  RunResult r;
  r.settings.form = form;
  r.settings.rtol = r.settings.atol = rtol;
  r.position_error_max = error;
  r.cpu_s = cpu;
  return r;
}

TEST(WorkStudy, FrontHoldsWhatNoOtherBeats) {
  std::vector<RunResult> runs{run("momentum", 1e-4, 1e-3, 1), run("momentum", 1e-6, 1e-6, 3),
                              run("acceleration", 1e-4, 1e-2, 2),
                              run("acceleration", 1e-6, 1e-8, 5), run("baumgarte", 1e-6, 1e-9, 4)};
  EXPECT_EQ(pareto_front(runs, true), (std::vector<std::size_t>{0, 1, 4}));
  runs[4].status = "failed";
  EXPECT_EQ(pareto_front(runs, true), (std::vector<std::size_t>{0, 1, 3}));
}

TEST(WorkStudy, AdviceNamesTheCheapestOfEachForm) {
  StudyResult study;
  study.drift_study = false;
  study.reference = "reference.csv";
  study.runs = {run("momentum", 1e-4, 1e-5, 1e-3), run("momentum", 1e-6, 1e-7, 3e-3),
                run("acceleration", 1e-6, 5e-7, 6e-3), run("acceleration", 1e-4, 2e-5, 2e-3)};
  EXPECT_EQ(advice(study),
            "For an error of 1e-4 take `momentum` with dop853 at 1e-4: 1 ms; then `acceleration` "
            "with dop853 times 2.0.\n"
            "For an error of 1e-6 take `momentum` with dop853 at 1e-6: 3 ms; then `acceleration` "
            "with dop853 times 2.0.\n"
            "No run reaches 1e-8.\n");
  study.reference.clear();
  study.runs[0].position_drift_max = 1e-5;
  EXPECT_EQ(advice(study).rfind("For a drift of 1e-4 take `momentum`", 0), 0u);
}

TEST(WorkStudy, LaddersHaveTheirRungsAndErrorsFollow) {
  const Mechanism mechanism(read_scene(example("four_bar", "scene.toml")));
  const Start start = equations::start_of(mechanism);
  const OwnReference own = own_reference(mechanism, start, 1.0, 10);
  WorkRequest request;
  request.forms = {"momentum", "acceleration", "momentum-index2"};
  request.integrators = {"dop853", "rk4"};
  request.tolerances = {1e-5, 1e-7, 1e-9};
  request.steps = {0.02, 0.01};
  request.end_time = 1;
  request.reference = &own.reference;
  const auto runs = run_work_study(mechanism, start, request);
  ASSERT_EQ(runs.size(), 2u * (3 + 2) + 3);
  for (const auto& r : runs) {
    EXPECT_EQ(r.status, "done") << r.settings.form << ": " << r.reason;
    EXPECT_GT(r.repeats, 0);
  }
  EXPECT_LT(runs[2].position_error_max, 1e-2 * runs[0].position_error_max);
  EXPECT_NEAR(std::log2(runs[3].position_error_max / runs[4].position_error_max), 4, 1);  // rk4
}

// C steps^−4 above a floor of rounding that grows with the steps: the floor is left out, and so are
// rungs that do not yet converge, and what was not measured.
TEST(ObservedOrder, IsThatOfAPowerAboveRounding) {
  std::vector<double> steps, errors;
  for (int i = 0; i < 14; ++i) {
    const double n = 25 * std::pow(2, i);
    steps.push_back(n);
    errors.push_back(i < 2 ? 0.5 : 3e4 / std::pow(n, 4) + 1e-16 * n);
  }
  errors[4] = not_measured;
  const ObservedOrder found = observed_order(steps, errors);
  EXPECT_NEAR(found.order, 4, 0.1);
  EXPECT_LT(found.half_range, 0.2);
  EXPECT_GT(found.rungs, 5);
  EXPECT_LT(found.rungs, 11);
  EXPECT_TRUE(std::isnan(observed_order({10, 20}, {1e-3, 1e-4}).order));
  EXPECT_TRUE(std::isnan(observed_order(steps, std::vector<double>(14, not_measured)).order));
}

/// Of one ladder of fixed steps on the four-bar for 1 s.
std::vector<RunResult> rk4_ladder(const Mechanism& mechanism, const std::string& form,
                                  const std::string& gauge, const Reference& reference) {
  WorkRequest request;
  request.forms = {form};
  request.integrators = {"rk4"};
  request.gauge = gauge;
  request.steps = {0.02, 0.01, 0.005, 0.0025, 0.00125};
  request.end_time = 1;
  request.reference = &reference;
  request.timing = Timing::none;
  return run_work_study(mechanism, equations::start_of(mechanism), request);
}

// λ of (3) and σ have the order of the method, and so has an own λ by differences of the sixth
// order; a table that says so has it.
TEST(ObservedOrder, OfForcesAndImpulsesIsThatOfTheMethod) {
  const Mechanism mechanism(read_scene(example("four_bar", "scene.toml")));
  Reference reference(example("four_bar", "multipliers.csv"));
  reference.bind(measured_columns(mechanism));
  const auto runs = rk4_ladder(mechanism, "momentum", "none", reference);
  std::vector<double> steps;
  std::map<std::string, std::vector<double>> errors;
  for (const RunResult& run : runs) {
    ASSERT_EQ(run.status, "done") << run.reason;
    steps.push_back(static_cast<double>(run.counters.steps));
    errors["p"].push_back(run.momentum_error_max);
    errors["λ"].push_back(run.force_error_max);
    errors["reactions"].push_back(run.reaction_error_max);
    errors["own"].push_back(run.multiplier_error_max);
    errors["∫λ"].push_back(run.impulse_error_max);
  }
  StudyResult study;
  study.drift_study = false;
  study.runs = runs;
  std::istringstream lines(order_table(study));
  std::string line, form, method, gauge, q, u, sigma;
  std::getline(lines, line);
  EXPECT_EQ(line.find("efforts"), std::string::npos);  // no drives, no work
  EXPECT_EQ(line.find("work"), std::string::npos);
  lines >> form >> method >> gauge >> q >> u;
  EXPECT_EQ(form, "momentum+project");
  EXPECT_EQ(gauge, "none");
  for (const char* what : {"p", "λ", "reactions", "own", "∫λ"}) {
    std::string told;
    lines >> told;
    EXPECT_NEAR(std::stod(told), observed_order(steps, errors[what]).order, 0.051) << what;
    EXPECT_NEAR(std::stod(told), 4, 0.65) << what;
  }
  lines >> sigma;
  EXPECT_NEAR(std::stod(sigma), 4, 0.6);
  // No impulse of a gauge that resets it, none of velocity forms.
  study.runs = rk4_ladder(mechanism, "momentum", "reset", reference);
  EXPECT_NE(order_table(study).find("  -\n"), std::string::npos) << order_table(study);
}

// What is said of a gauge reads back as that gauge, a leak without a rate too.
TEST(WorkStudy, LeaksAtTheRateOfTheStart) {
  for (const char* text : {"none", "reset", "flip", "leak", "leak:2.5"})
    EXPECT_EQ(parse_gauge(text).text(), text);
  const Mechanism mechanism(read_scene(example("four_bar", "scene.toml")));
  WorkRequest request;
  request.forms = {"momentum"};
  request.gauge = parse_gauge("leak").text();
  request.tolerances = {1e-5};
  request.end_time = 0.1;
  request.timing = Timing::none;
  const auto runs = run_work_study(mechanism, equations::start_of(mechanism), request);
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_EQ(runs.front().status, "done");
  EXPECT_EQ(runs.front().settings.gauge.rfind("leak:", 0), 0u) << runs.front().settings.gauge;
}

// Reactions are linear in u̇ and λ of (3), and have their order.
TEST(ObservedOrder, OfReactionsIsThatOfTheMethod) {
  const Mechanism mechanism(read_scene(example("four_bar", "scene.toml")));
  const auto run = [&](const std::string& integrator, double step, double tolerance) {
    RunRequest request =
        equations::kept(equations::adaptive("momentum", integrator, "reset", tolerance, 1, 20));
    request.settings.step = step;
    request.reactions = true;
    return run_form(mechanism, equations::start_of(mechanism), request).trajectory;
  };
  const Trajectory exact = run("vern9", 0, 1e-13);
  std::vector<double> steps, errors;
  std::size_t compared = 0;
  for (const double h : {0.02, 0.01, 0.005, 0.0025}) {
    const Trajectory found = run("rk4", h, 0);
    double error = 0;
    compared = 0;
    for (std::size_t c = 0; c < found.columns.size(); ++c) {
      const std::string& name = found.columns[c];
      if (name.find("[N") == std::string::npos || name.find("lambda") != std::string::npos)
        continue;
      ++compared;
      for (std::size_t i = 0; i < found.rows.size(); ++i) {
        const double truth = exact.rows[i][c];
        if (!std::isnan(truth))
          error =
              equations::larger(error, std::abs(found.rows[i][c] - truth) / (1 + std::abs(truth)));
      }
    }
    steps.push_back(1 / h);
    errors.push_back(error);
  }
  EXPECT_GE(compared, 12u);
  EXPECT_NEAR(observed_order(steps, errors).order, 4, 0.6);
}

}  // namespace
}  // namespace momenta::dae_work_study
