// The laws of forms that hold their loops by other means than the momentum form's: projection,
// independent coordinates, penalties, position feedback. Each against `momentum` and against what
// its own file promises.

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/parts.h"
#include "equations/random_tree.h"
#include "equations/refusal.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/drift_study.h>

#include <numbers>

namespace momenta::dae_further_forms {
namespace {

using namespace equations;
using Eigen::VectorXd;
using equations::example;

/// The crank-rocker with its crank turning: 7 rad/s at the start, three turns in two seconds.
Scene turning_four_bar() {
  Scene scene = example("four_bar");
  scene.joints[0].velocity = {7};
  return scene;
}
/// Three rods of 1 m over a base of 1.5 m, fast: by Grashof's rule no link turns fully, so that
/// each of the three angles has dead points against the others.
Scene triple_rocker() {
  Scene s;
  s.name = "triple rocker";
  s.gravity = {0, -9.81, 0};
  for (const char* name : {"left", "coupler", "right"}) s.bodies.push_back(rod(name));
  s.joints.push_back(hinge("O", "ground", "left", {0, 0, 0}, 1.2));
  s.joints.push_back(hinge("A", "left", "coupler", {1, 0, 0}, -1.15));
  s.joints.push_back(hinge("C", "ground", "right", {1.5, 0, 0}, 1.7));
  s.joints[0].velocity = {9};
  s.held = {"O"};
  s.loops.push_back(
      equations::make_loop(LoopKind::revolute, "B", "coupler", "right", {1, 0, 0}, {1, 0, 0}));
  return s;
}

RunResult run(const Mechanism& mechanism, RunSettings settings) {
  RunRequest request;
  request.settings = std::move(settings);
  request.keep_trajectory = true;
  return run_form(mechanism, equations::start_of(mechanism), request);
}
RunSettings adaptive(const std::string& form, double tolerance, double end,
                     const std::string& gauge = "") {
  RunSettings s;
  s.form = form;
  s.gauge = gauge;
  s.rtol = s.atol = tolerance;
  s.end_time = end;
  s.samples = 50;
  return s;
}
RunSettings fixed(const std::string& form, double h, double end, const std::string& gauge = "") {
  RunSettings s = adaptive(form, 1e-8, end, gauge);
  s.integrator = "rk4";
  s.step = h;
  return s;
}

/// Largest difference over the samples of the first `columns` columns after t, relative to 1 + |q|.
double apart(const RunResult& a, const RunResult& b, int columns) {
  EXPECT_EQ(a.trajectory.rows.size(), b.trajectory.rows.size());
  double worst = 0;
  for (std::size_t i = 0; i < std::min(a.trajectory.rows.size(), b.trajectory.rows.size()); ++i)
    for (std::size_t k = 1; k <= static_cast<std::size_t>(columns); ++k) {
      const double x = a.trajectory.rows[i][k], y = b.trajectory.rows[i][k];
      worst = equations::larger(worst, std::abs(x - y) / (1 + std::abs(y)));
    }
  return worst;
}

const std::vector<std::pair<std::string, std::string>> further{
    {"projected", ""},
    {"partitioned", ""},
    {"augmented-lagrangian", ""},
    {"augmented-lagrangian-canonical", "leak"},
    {"maximal-coordinates", ""}};

void expect_agreement(const Scene& scene, double end, double bound) {
  const Mechanism mechanism(scene);
  const RunResult tight = run(mechanism, adaptive("momentum", 1e-13, end, "leak"));
  ASSERT_EQ(tight.status, "done") << tight.reason;
  for (const auto& [form, gauge] : further) {
    const RunResult found = run(mechanism, adaptive(form, 1e-11, end, gauge));
    ASSERT_EQ(found.status, "done") << form << ": " << found.reason;
    EXPECT_EQ(found.settings.form, form);
    const double error = apart(found, tight, mechanism.nq() + mechanism.nv());
    EXPECT_LT(error, bound) << form;
    testing::Test::RecordProperty(form, std::to_string(error * 1e12) + "e-12");
  }
}

// Positions and rates.
TEST(FurtherForms, AgreeOnATurningCrankRocker) {
  expect_agreement(turning_four_bar(), 3, 1e-7);
}
TEST(FurtherForms, AgreeOnATripleRocker) {
  expect_agreement(triple_rocker(), 3, 1e-6);
}
TEST(FurtherForms, AgreeOnASliderCrank) {
  expect_agreement(example("slider_crank"), 0.4, 1e-7);
}
TEST(FurtherForms, AgreeOnBricardsLinkageWhoseRedundantRowChanges) {
  expect_agreement(bricard(), 2, 1e-6);
}
TEST(FurtherForms, AgreeOnAStewartPlatform) {
  Scene scene = platform(6);
  for (auto& joint : scene.joints)
    if (joint.kind == JointKind::prismatic) {
      joint.stiffness = 400;
      joint.rest = 1.4;
    }
  expect_agreement(scene, 0.5, 1e-7);
}
TEST(FurtherForms, AgreeOnALongRowWithSparseBlocks) {
  expect_agreement(row_of_four_bars(25, 1.5, -1), 0.5, 1e-7);
}

TEST(FurtherForms, AreOfTheMethodsOrder) {
  const Mechanism mechanism(turning_four_bar());
  const RunResult exact = run(mechanism, adaptive("momentum", 1e-13, 1.5, "leak:3"));
  for (const auto& [form, gauge] : further) {
    std::vector<double> errors;
    for (const double h : {0.001, 0.0005}) {
      const RunResult found = run(mechanism, fixed(form, h, 1.5, gauge));
      ASSERT_EQ(found.status, "done") << form << ": " << found.reason;
      errors.push_back(apart(found, exact, 6));
    }
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), 4, 0.4) << form << " " << errors[1];
  }
}

TEST(Projected, HoldsPositionsAndRatesAtRounding) {
  const Mechanism mechanism(example("four_bar"));
  for (const double h : {0.005, 0.02}) {
    const RunResult r = run(mechanism, fixed("projected", h, 100));
    ASSERT_EQ(r.status, "done") << r.reason;
    EXPECT_LT(r.position_drift_max, 1e-14) << h;
    EXPECT_LT(r.velocity_drift_max, 1e-13) << h;
    EXPECT_GT(r.between_steps_max, 1e-13) << h;  // before the correction there is something to do
  }
}
TEST(Projected, IsWhatAccelerationWithProjectionIs) {
  const Mechanism mechanism(example("four_bar"));
  RunSettings s = fixed("acceleration", 0.005, 2);
  s.project = true;
  const RunResult a = run(mechanism, s), b = run(mechanism, fixed("projected", 0.005, 2));
  EXPECT_EQ(a.settings.form, "projected");
  EXPECT_FALSE(a.settings.project);
  EXPECT_EQ(a.trajectory.rows, b.trajectory.rows);
}
TEST(Projected, RepeatsLargeCorrections) {
  // Pulled far off, a form that corrects once keeps the square of it; this one does not.
  const Mechanism mechanism(example("four_bar"));
  const Start start = equations::start_of(mechanism);
  for (const bool iterated : {true, false}) {
    FormOptions options;
    options.project = true;
    const auto form = make_form(iterated ? "projected" : "baumgarte", mechanism, options, start);
    auto y = form->initial(start);
    y[1] += 1e-2;
    bool changed = false;
    ASSERT_TRUE(form->ode()->after_step(0, y.data(), changed));
    const auto e = mechanism.evaluation<double>();
    VectorXd phi(mechanism.m());
    e->place(0, y.data());
    e->positions(phi.data());
    if (iterated) {
      EXPECT_LT(phi.norm(), 1e-15);
    } else {
      EXPECT_GT(phi.norm(), 1e-7);
    }
  }
}

TEST(MaximalCoordinates, IsBaumgartesMotion) {
  for (const char* name : {"four_bar", "andrews", "spatial_slider_crank", "bricard"}) {
    const Mechanism mechanism(example(name));
    const double end = name == std::string("andrews") ? 0.01 : 1;
    const RunResult a = run(mechanism, adaptive("maximal-coordinates", 1e-10, end)),
                    b = run(mechanism, adaptive("baumgarte", 1e-10, end));
    ASSERT_EQ(a.status, "done") << a.reason;
    EXPECT_EQ(a.settings.baumgarte_alpha, b.settings.baumgarte_alpha);
    EXPECT_LT(apart(a, b, mechanism.nq()), 1e-7) << name;
    EXPECT_NEAR(static_cast<double>(a.counters.steps), static_cast<double>(b.counters.steps), 3);
  }
}
TEST(MaximalCoordinates, SolvesTreesToo) {
  for (const char* name : {"pendulum", "free_body", "chain"}) {
    const Mechanism mechanism(example(name));
    const RunResult a = run(mechanism, adaptive("maximal-coordinates", 1e-11, 1)),
                    b = run(mechanism, adaptive("acceleration", 1e-11, 1));
    ASSERT_EQ(a.status, "done") << a.reason;
    EXPECT_LT(apart(a, b, mechanism.nq() + mechanism.nv()), 1e-7) << name;
  }
}

TEST(Partitioned, ChoosesAnewWhereNoChoiceServesForLong) {
  const Mechanism mechanism(triple_rocker());
  const RunResult r = run(mechanism, fixed("partitioned", 0.0005, 20));
  ASSERT_EQ(r.status, "done") << r.reason;
  EXPECT_GT(r.partitions, 50);
  EXPECT_LT(r.position_drift_max, 1e-14);
  EXPECT_LT(r.between_steps_max, 1e-14);
  EXPECT_LT(r.velocity_drift_max, 1e-12);
  EXPECT_LT(r.energy_error_max, 1e-2);  // of 79 J; what a step errs in q_i comes back magnified
  RecordProperty("partitions", static_cast<int>(r.partitions));
}
TEST(Partitioned, KeepsOneWhereOneServes) {
  // A crank that turns fully has no dead point.
  const Mechanism mechanism(turning_four_bar());
  const RunResult r = run(mechanism, fixed("partitioned", 0.002, 10));
  ASSERT_EQ(r.status, "done") << r.reason;
  EXPECT_EQ(r.partitions, 1);
}
TEST(Partitioned, IsTheAccelerationFormWithoutLoops) {
  for (const char* name : {"pendulum", "free_body"}) {
    const Mechanism mechanism(example(name));
    const RunResult a = run(mechanism, adaptive("partitioned", 1e-11, 1)),
                    b = run(mechanism, adaptive("acceleration", 1e-11, 1));
    ASSERT_EQ(a.status, "done") << a.reason;
    EXPECT_LT(apart(a, b, mechanism.nq() + mechanism.nv()), 1e-8) << name;
  }
}
TEST(Partitioned, LooksWithoutTouching) {
  // A state read in between, or a step tried and rejected, leaves no trace.
  const Mechanism mechanism(turning_four_bar());
  const Start start = equations::start_of(mechanism);
  const auto watched = make_form("partitioned", mechanism, {}, start),
             alone = make_form("partitioned", mechanism, {}, start);
  const auto y = watched->initial(start);
  ASSERT_EQ(y, alone->initial(start));
  std::vector<double> a(y.size()), b(y.size()), elsewhere = y;
  elsewhere[0] += 0.05;
  Snapshot seen;
  ASSERT_TRUE(watched->read(0, elsewhere.data(), nullptr, seen));
  ASSERT_TRUE(watched->ode()->rhs(0.01, elsewhere.data(), a.data()));
  elsewhere[0] += 40;
  watched->ode()->rhs(0, elsewhere.data(), a.data());
  ASSERT_TRUE(watched->ode()->rhs(0, y.data(), a.data()));
  ASSERT_TRUE(alone->ode()->rhs(0, y.data(), b.data()));
  EXPECT_EQ(a, b);
}
TEST(Partitioned, StopsAtSingularPosesWithTheirTime) {
  // A row of equal links lies flat after 0.72 s. The closer the steps, the surer no partition
  // passes; which steps come how close is chance.
  const Mechanism mechanism(row_of_four_bars(5, std::numbers::pi / 2, -1));
  int stopped = 0;
  for (const Start& start : equations::starts_of(mechanism, 10)) {
    RunRequest request;
    request.settings = adaptive("partitioned", 1e-11, 0.75);
    const RunResult r = run_form(mechanism, start, request);
    if (r.status == "done") {
      EXPECT_LT(r.position_drift_max, 1e-9);
      continue;
    }
    ++stopped;
    EXPECT_EQ(r.status, "failed");
    EXPECT_NE(r.reason.find("singular"), std::string::npos) << r.reason;
    EXPECT_NE(r.reason.find("t = "), std::string::npos) << r.reason;
    EXPECT_NEAR(r.stopped_at, 0.72, 0.05);
  }
  EXPECT_GE(stopped, 1);
}
TEST(Partitioned, IsRefusedToMethodsWithMemory) {
  const Mechanism mechanism(example("four_bar"));
  for (const char* integrator : {"adams", "bdf"})
    for (const char* form : {"partitioned", "projected"}) {
      RunSettings s = adaptive(form, 1e-8, 1);
      s.integrator = integrator;
      EXPECT_TRUE(equations::says(
          equations::thrown<std::invalid_argument>([&] { run(mechanism, s); }), "multistep"))
          << form << " " << integrator;
    }
}

TEST(AugmentedLagrangian, StaysAtALevelSetByThePenaltyAndThenByTheFeedback) {
  const Mechanism mechanism(example("four_bar"));
  const double feedback = run(mechanism, fixed("baumgarte", 0.005, 100)).position_drift_max;
  double before = 1;
  for (const double penalty : {1e0, 1e1, 1e2, 1e7}) {
    RunSettings s = fixed("augmented-lagrangian", 0.005, 100);
    s.penalty = penalty;
    const RunResult r = run(mechanism, s);
    // A penalty of 1 dissipates as much as the motion turns over.
    ASSERT_EQ(r.status, penalty > 1 ? "done" : "came apart") << r.reason;
    EXPECT_EQ(r.settings.penalty, penalty);
    if (penalty < 1e3) {
      EXPECT_LT(r.position_drift_max, 0.2 * before) << penalty;
    } else {
      EXPECT_NEAR(r.position_drift_max, feedback, 0.01 * feedback);
    }
    before = r.position_drift_max;
  }
}
TEST(AugmentedLagrangian, CanonicalFormNeedsTheGaugeAsMuch) {
  const Mechanism mechanism(example("four_bar"));
  const RunResult bare =
                      run(mechanism, fixed("augmented-lagrangian-canonical", 0.005, 100, "none")),
                  leak =
                      run(mechanism, fixed("augmented-lagrangian-canonical", 0.005, 100, "leak"));
  ASSERT_EQ(bare.status, "done") << bare.reason;
  ASSERT_EQ(leak.status, "done") << leak.reason;
  EXPECT_GT(bare.energy_error_max, 20 * leak.energy_error_max);
  EXPECT_GT(bare.series.impulse.back(), 20 * leak.series.impulse.back());
  const RunResult momentum = run(mechanism, fixed("momentum", 0.005, 100, "leak"));
  EXPECT_LT(leak.position_drift_max, 0.1 * momentum.position_drift_max);
}

TEST(PositionFeedback, HoldsMomentaAtALevel) {
  const Mechanism mechanism(example("four_bar"));
  RunSettings s = fixed("momentum", 0.005, 200, "leak:3");
  s.samples = 2000;
  const RunResult free = run(mechanism, s);
  s.beta = 1;
  const RunResult held = run(mechanism, s);
  ASSERT_EQ(held.status, "done") << held.reason;
  EXPECT_EQ(held.settings.beta, 1);
  EXPECT_LT(held.position_drift_max, 0.1 * free.position_drift_max);
  EXPECT_LT(held.position_growth.exponent, 0.5);
  EXPECT_LT(held.energy_error_max, 2 * free.energy_error_max);
  // Φ̇ = −βΦ by construction.
  for (std::size_t i = 0; i < held.series.t.size(); ++i)
    EXPECT_NEAR(held.series.velocity_drift[i], held.series.position_drift[i], 1e-13);
}
TEST(PositionFeedback, HoldsIndexOneToo) {
  const Mechanism mechanism(example("four_bar"));
  RunSettings s = adaptive("momentum-index1", 1e-8, 50, "leak");
  s.integrator = "ida";
  const RunResult free = run(mechanism, s);
  s.beta = 1;
  const RunResult held = run(mechanism, s);
  ASSERT_EQ(held.status, "done") << held.reason;
  EXPECT_LT(held.position_drift_max, 0.2 * free.position_drift_max);
  for (std::size_t i = 0; i < held.series.t.size(); ++i)
    EXPECT_NEAR(held.series.velocity_drift[i], held.series.position_drift[i], 1e-13);
}
TEST(PositionFeedback, IsLeftToFormsThatDoNotHoldPositions) {
  const Mechanism mechanism(example("four_bar"));
  for (const char* form : {"momentum-index2", "momentum-stabilised", "momentum-index3"}) {
    RunSettings s = adaptive(form, 1e-6, 0.1, takes_gauge(form) ? "leak" : "");
    s.integrator = "ida";
    s.beta = 1;
    EXPECT_EQ(run(mechanism, s).settings.beta, 0) << form;
  }
}

TEST(MomentumIndexThree, HoldsPositionsAndLetsRatesGo) {
  const Mechanism mechanism(example("four_bar"));
  RunSettings s = adaptive("momentum-index3", 1e-6, 10);
  s.integrator = "ida";
  const RunResult p = run(mechanism, s);
  s.form = "acceleration-index3";
  const RunResult v = run(mechanism, s);
  ASSERT_EQ(p.status, "done") << p.reason;
  EXPECT_EQ(p.settings.gauge, "");
  EXPECT_LT(p.position_drift_max, 1e-5);
  EXPECT_GT(p.velocity_drift_max, 1e-9);  // u of M u = p, not of (7)
  // Of one size with its twin in velocities.
  EXPECT_LT(p.velocity_drift_max, 30 * v.velocity_drift_max);
  EXPECT_GT(p.velocity_drift_max, v.velocity_drift_max / 30);
}

TEST(DriftStudy, ListsEveryFormOnceAndItsTwins) {
  const Mechanism mechanism(example("four_bar"));
  const Start start = equations::start_of(mechanism);
  DriftRequest request;
  request.integrator = "dop853";
  request.rtol = request.atol = 1e-6;
  request.end_time = 0.1;
  request.samples = 5;
  const auto names = [&] {
    std::vector<std::string> all;
    for (const auto& r : run_drift_study(mechanism, start, request))
      all.push_back(r.settings.form + (r.settings.project ? "+project" : ""));
    return all;
  };
  const auto count = [](const std::vector<std::string>& all, const std::string& name) {
    return std::count(all.begin(), all.end(), name);
  };
  const auto plain = names();
  for (const auto& form : form_names())
    EXPECT_EQ(count(plain, form), form == "momentum" ? 3 : 1) << form;
  EXPECT_EQ(count(plain, "momentum+project"), 1);
  EXPECT_EQ(plain.size(), form_names().size() + 3);
  request.project = true;
  const auto projected = names();
  EXPECT_EQ(count(projected, "acceleration"), 0);
  EXPECT_EQ(count(projected, "projected"), 1);
  EXPECT_EQ(count(projected, "momentum+project"), 3);
  request.project = false;
  request.integrator = "adams";
  const auto multistep = names();
  EXPECT_EQ(count(multistep, "projected") + count(multistep, "partitioned"), 0);
  EXPECT_EQ(count(multistep, "acceleration"), 1);
  // With a step, methods of fixed steps beside IDA.
  request.integrator = "rk4";
  request.step = 0.01;
  EXPECT_EQ(count(names(), "acceleration-index3"), 3);
}

}  // namespace
}  // namespace momenta::dae_further_forms
