// The explicit integrators as their users see them: accuracy under step control, outputs, hooks,
// and failures as values.

#include <gtest/gtest.h>
#include <momenta/dae/integrator/integration.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "equations/tolerance.h"

namespace momenta::dae_solver_explicit {
namespace {

/// A system from a function; counts its hooks.
class Given : public OdeSystem {
 public:
  using Rhs = std::function<bool(double, const double*, double*)>;
  Given(int size, Rhs rhs) : size_(size), rhs_(std::move(rhs)) {}
  int size() const override { return size_; }
  bool rhs(double t, const double* y, double* ydot) override {
    return rhs_(t, y, ydot) || fail("the loop opens at t = " + std::to_string(t));
  }
  bool has_after_step() const override { return bool(correction); }
  bool after_step(double t, double* y, bool& changed) override {
    ++corrections;
    return correction(t, y, changed) || fail("the correction diverged");
  }
  void begin_step(double t, const double*) override { begun.push_back(t); }
  double scale(int i) const override { return scales.empty() ? 1 : scales[std::size_t(i)]; }

  std::function<bool(double, double*, bool&)> correction;
  std::vector<double> begun, scales;
  int corrections = 0;

 private:
  int size_;
  Rhs rhs_;
};

/// Planar Kepler motion with eccentricity 0.5, period 2π.
Given kepler() {
  return Given(4, [](double, const double* y, double* f) {
    const double r2 = y[0] * y[0] + y[1] * y[1], r3 = r2 * std::sqrt(r2);
    f[0] = y[2], f[1] = y[3], f[2] = -y[0] / r3, f[3] = -y[1] / r3;
    return true;
  });
}
const std::vector<double> kepler_start{0.5, 0, 0, std::sqrt(3.0)};
const double period = 2 * M_PI;

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double d = 0;
  for (std::size_t i = 0; i < a.size(); ++i) d = equations::larger(d, std::abs(a[i] - b[i]));
  return d;
}
IntegrationOptions tolerance(double tol) {
  IntegrationOptions o;
  o.rtol = o.atol = tol;
  return o;
}
IntegrationOptions fixed(double step) {
  IntegrationOptions o;
  o.step = step;
  return o;
}
Given decay() {
  return Given(1, [](double, const double* y, double* f) {
    f[0] = -y[0];
    return true;
  });
}

class EveryExplicit : public testing::TestWithParam<const char*> {
 protected:
  /// Fixed steps of 0.1 for rk4, control with tolerance 1e-8 for the others.
  IntegrationOptions options() const {
    return std::string(GetParam()) == "rk4" ? fixed(0.1) : tolerance(1e-8);
  }
  IntegrationResult run(OdeSystem& system, const std::vector<double>& y0,
                        const std::vector<double>& times, const Observer& observer = {}) const {
    return integrate_explicit(GetParam(), system, 0, y0, times, options(), observer);
  }
};
INSTANTIATE_TEST_SUITE_P(Methods, EveryExplicit, testing::Values("rk4", "dp5", "dop853", "vern9"),
                         [](const auto& method) { return std::string(method.param); });

TEST(StepControl, ErrorFollowsTheToleranceOnKepler) {
  for (const std::string method : {"dp5", "dop853", "vern9"}) {
    double last = 1;
    for (const double tol : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
      Given system = kepler();
      const IntegrationResult r =
          integrate_explicit(method, system, 0, kepler_start, {period}, tolerance(tol), {});
      ASSERT_TRUE(r.done) << r.reason;
      const double e = distance(r.y, kepler_start);
      // One revolution amplifies local errors by about 10 to 100.
      EXPECT_LT(e, 300 * tol) << method;
      EXPECT_LT(e, last / 10) << method << ": two digits asked for, less than one gained";
      last = e;
      // Rejections cost a whole step each; a controller that fits has few.
      EXPECT_LT(r.counters.rejected, 0.25 * double(r.counters.steps) + 3) << method;
    }
  }
}

TEST(StepControl, ClosesTheArenstorfOrbit) {
  // Restricted three-body problem (Hairer, Norsett, Wanner I, II.0): close passages of two poles.
  const double mu = 0.012277471, nu = 1 - mu, end = 17.0652165601579625588917206249;
  const std::vector<double> y0{0.994, 0, 0, -2.00158510637908252240537862224};
  for (const std::string method : {"dp5", "dop853", "vern9"}) {
    Given system(4, [=](double, const double* y, double* f) {
      const double d = std::pow(std::hypot(y[0] + mu, y[1]), 3);
      const double e = std::pow(std::hypot(y[0] - nu, y[1]), 3);
      f[0] = y[2], f[1] = y[3];
      f[2] = y[0] + 2 * y[3] - nu * (y[0] + mu) / d - mu * (y[0] - nu) / e;
      f[3] = y[1] - 2 * y[2] - nu * y[1] / d - mu * y[1] / e;
      return true;
    });
    const IntegrationResult r =
        integrate_explicit(method, system, 0, y0, {end}, tolerance(1e-12), {});
    ASSERT_TRUE(r.done) << r.reason;
    // The orbit amplifies errors by about 1e6 (velocities at the pole more than positions).
    EXPECT_LT(std::hypot(r.y[0] - y0[0], r.y[1] - y0[1]), 1e-5) << method;
    EXPECT_LT(r.counters.steps, method == "dp5" ? 3000 : 600) << method;
  }
}

TEST(StepControl, AnInfiniteScaleIsNoTolerance) {
  // The second component oscillates fast and nobody asks for it.
  const Given::Rhs rhs = [](double t, const double* y, double* f) {
    f[0] = -y[0];
    f[1] = 100 * std::cos(100 * t);
    return true;
  };
  Given both(2, rhs), first(2, rhs);
  first.scales = {1, std::numeric_limits<double>::infinity()};
  const auto r2 = integrate_explicit("dp5", both, 0, {1, 0}, {1.0}, tolerance(1e-8), {});
  const auto r1 = integrate_explicit("dp5", first, 0, {1, 0}, {1.0}, tolerance(1e-8), {});
  EXPECT_LT(r1.counters.steps, r2.counters.steps / 5);
  EXPECT_NEAR(r1.y[0], std::exp(-1.0), 1e-7);
}

TEST(StepControl, RespectsTheLongestStep) {
  Given system = decay();
  IntegrationOptions options = tolerance(1e-2);
  options.max_step = 0.01;
  Observer observer;
  double longest = 0;
  observer.step = [&](double t0, double t1, const Interpolant&) {
    longest = std::max(longest, t1 - t0);
    return true;
  };
  EXPECT_TRUE(integrate_explicit("dop853", system, 0, {1}, {1.0}, options, observer).done);
  EXPECT_LE(longest, 0.0101 + 1e-12);  // the last step may take up a remainder of 1 %
}

TEST_P(EveryExplicit, SamplesEveryOutputTimeInOrder) {
  Given system = kepler();
  std::vector<double> times, seen;
  for (int i = 0; i <= 250; ++i) times.push_back(0.013 * i);
  Observer observer;
  double energy_error = 0;
  observer.sample = [&](double t, const double* y, const double* ydot) {
    seen.push_back(t);
    EXPECT_EQ(ydot, nullptr);
    const double energy = (y[2] * y[2] + y[3] * y[3]) / 2 - 1 / std::hypot(y[0], y[1]);
    energy_error = equations::larger(energy_error, std::abs(energy + 0.5));
    return true;
  };
  const IntegrationResult r = run(system, kepler_start, times, observer);
  EXPECT_TRUE(r.done) << r.reason;
  EXPECT_EQ(r.end_time, times.back());
  EXPECT_EQ(seen, times);
  // rk4 with 63 steps a revolution; dense output of dp5 is of the order of its error estimate.
  EXPECT_LT(energy_error, std::string(GetParam()) == "rk4" ? 1e-2 : 1e-6);
}

TEST_P(EveryExplicit, LookingOnDoesNotChangeTheMotion) {
  Given plain = kepler(), watched = kepler();
  const auto correction = [](double, double* y, bool&) {
    y[0] *= 1 + 1e-12;
    return true;
  };
  plain.correction = watched.correction = correction;
  Observer observer;
  observer.step = [](double t0, double t1, const Interpolant& between) {
    double y[4];
    between((t0 + t1) / 2, y);
    return true;
  };
  const IntegrationResult a = run(plain, kepler_start, {3.0});
  const IntegrationResult b = run(watched, kepler_start, {0.5, 1.234, 3.0}, observer);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.counters.steps, b.counters.steps);
}

TEST_P(EveryExplicit, InterpolantMeetsBothEnds) {
  Given system = decay();
  double last = 1;
  Observer observer;
  observer.step = [&](double t0, double t1, const Interpolant& between) {
    double y;
    between(t0, &y);
    EXPECT_NEAR(y, last, 4e-16);
    between(t1, &y);
    last = y;
    return true;
  };
  const IntegrationResult r = run(system, {1}, {1.0}, observer);
  EXPECT_NEAR(r.y[0], last, 4e-16);
}

TEST_P(EveryExplicit, AHookSeesEachAcceptedStepOnce) {
  Given system = kepler();
  std::vector<double> starts;
  system.correction = [](double, double*, bool&) { return true; };
  Observer observer;
  observer.step = [&](double t0, double, const Interpolant&) {
    starts.push_back(t0);
    return true;
  };
  const IntegrationResult r = run(system, kepler_start, {period}, observer);
  EXPECT_EQ(system.begun, starts);
  EXPECT_EQ(system.corrections, r.counters.steps);
}

TEST_P(EveryExplicit, ACorrectionShowsInSamplesAtStepEndsOnly) {
  Given system(1, [](double, const double*, double* f) {
    f[0] = 0;
    return true;
  });
  system.correction = [](double, double* y, bool& changed) {
    y[0] += 1;
    changed = true;
    return true;
  };
  std::vector<double> sampled;
  double shown = -1;
  Observer observer;
  observer.sample = [&](double, const double* y, const double*) {
    sampled.push_back(y[0]);
    return true;
  };
  observer.step = [&](double, double t1, const Interpolant& between) {
    between(t1, &shown);
    return true;
  };
  IntegrationOptions options = fixed(0.5);
  const IntegrationResult r =
      integrate_explicit(GetParam(), system, 0, {0}, {0, 0.25, 0.5, 0.75, 1.0}, options, observer);
  EXPECT_EQ(sampled, (std::vector<double>{0, 0, 1, 1, 2}));
  EXPECT_EQ(shown, 1) << "the interpolant of the second step is that of the unaltered step";
  EXPECT_EQ(r.y[0], 2);
}

TEST(StageReuse, LastStageIsKeptUnlessTheStateWasChanged) {
  for (const bool change : {false, true}) {
    Given system = decay();
    system.correction = [=](double, double*, bool& changed) {
      changed = change;
      return true;
    };
    const auto dp5 = integrate_explicit("dp5", system, 0, {1}, {1.0}, fixed(0.1), {});
    EXPECT_EQ(dp5.counters.evaluations, change ? 10 * 6 + 10 : 10 * 6 + 1);
    const auto dop853 = integrate_explicit("dop853", system, 0, {1}, {1.0}, fixed(0.1), {});
    EXPECT_EQ(dop853.counters.evaluations, 10 * 12);
    const auto vern9 = integrate_explicit("vern9", system, 0, {1}, {1.0}, fixed(0.1), {});
    EXPECT_EQ(vern9.counters.evaluations, 10 * 16);
  }
}

TEST(StageReuse, DenseOutputIsPaidOnlyWhereItIsUsed) {
  Given system = decay();
  Observer observer;
  observer.sample = [](double, const double*, const double*) { return true; };
  struct Cost {
    const char* method;
    long step, dense;
  };
  for (const auto& [method, step, dense] : {Cost{"dop853", 12, 3}, Cost{"vern9", 16, 4}}) {
    // Outputs at step ends need nothing, 0.55 and 0.57 lie in one step: 1 + `dense` stages, of
    // which the end derivative serves the next step as well.
    const auto ends = integrate_explicit(method, system, 0, {1}, {0.5, 1.0}, fixed(0.1), observer);
    EXPECT_EQ(ends.counters.evaluations, 10 * step);
    const auto inside =
        integrate_explicit(method, system, 0, {1}, {0.55, 0.57, 1.0}, fixed(0.1), observer);
    EXPECT_EQ(inside.counters.evaluations, 10 * step + dense);
    const auto ignored = integrate_explicit(method, system, 0, {1}, {0.55, 1.0}, fixed(0.1), {});
    EXPECT_EQ(ignored.counters.evaluations, 10 * step);
  }
}

TEST(FixedSteps, GridTimesTakeTheStepValue) {
  Given system = decay();
  std::vector<double> times, values;
  for (int i = 1; i <= 1000; ++i) times.push_back(0.01 * i);
  Observer observer;
  observer.sample = [&](double, const double* y, const double*) {
    values.push_back(y[0]);
    return true;
  };
  const auto r = integrate_explicit("rk4", system, 0, {1}, times, fixed(0.01), observer);
  EXPECT_EQ(r.counters.steps, 1000);
  EXPECT_EQ(r.counters.evaluations, 4000) << "an end derivative was needed for interpolation";
  double y = 1;
  const double h = 0.01, growth = 1 - h + h * h / 2 - h * h * h / 6 + h * h * h * h / 24;
  for (const double value : values) EXPECT_NEAR(value, y *= growth, 1e-13);
}

TEST(FixedSteps, OnlyTheLastStepIsShortened) {
  Given system = decay();
  std::vector<double> lengths;
  Observer observer;
  observer.step = [&](double t0, double t1, const Interpolant&) {
    lengths.push_back(t1 - t0);
    return true;
  };
  const auto r = integrate_explicit("rk4", system, 0, {1}, {0.15, 0.95}, fixed(0.1), observer);
  ASSERT_EQ(lengths.size(), 10u);
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(lengths[std::size_t(i)], 0.1, 1e-15);
  EXPECT_NEAR(lengths[9], 0.05, 1e-15);
  EXPECT_NEAR(r.y[0], std::exp(-0.95), 1e-6);
}

TEST_P(EveryExplicit, AFailingEvaluationStopsTheRunWithItsReason) {
  Given system(1, [](double t, const double*, double* f) {
    f[0] = 1;
    return t <= 0.5;
  });
  std::vector<double> seen;
  Observer observer;
  observer.sample = [&](double t, const double* y, const double*) {
    EXPECT_NEAR(y[0], t, 1e-12);
    seen.push_back(t);
    return true;
  };
  const IntegrationResult r = run(system, {0}, {0.1, 0.2, 0.3, 0.4, 0.6, 1.0}, observer);
  EXPECT_FALSE(r.done);
  EXPECT_EQ(seen, (std::vector<double>{0.1, 0.2, 0.3, 0.4}));
  EXPECT_NEAR(r.end_time, 0.5, 1e-12);
  EXPECT_NEAR(r.y[0], 0.5, 1e-12);
  EXPECT_NE(r.reason.find("the loop opens"), std::string::npos) << r.reason;
  EXPECT_NE(r.reason.find("t = 0.5"), std::string::npos) << r.reason;
  EXPECT_NE(r.reason.find(GetParam()), std::string::npos) << r.reason;
}

TEST_P(EveryExplicit, NotANumberIsAFailure) {
  Given system(2, [](double t, const double* y, double* f) {
    f[0] = t > 0.5 ? std::numeric_limits<double>::quiet_NaN() : 1;
    f[1] = -y[1];
    return true;
  });
  const IntegrationResult r = run(system, {0, 1}, {1.0});
  EXPECT_FALSE(r.done);
  EXPECT_LE(r.end_time, 0.5 + 1e-12);
  EXPECT_TRUE(std::isfinite(r.y[0]));
  EXPECT_NE(r.reason.find("not a finite number"), std::string::npos) << r.reason;
}

TEST_P(EveryExplicit, FiniteTimeBlowUpIsAFailure) {
  Given system(1, [](double, const double* y, double* f) {
    f[0] = y[0] * y[0];  // y = 1/(1 - t)
    return true;
  });
  const IntegrationResult r = run(system, {1}, {4.0});
  EXPECT_FALSE(r.done);
  EXPECT_LT(r.end_time, 4);
  EXPECT_FALSE(r.reason.empty());
}

TEST_P(EveryExplicit, AFailingStartIsAFailure) {
  Given system(1, [](double, const double*, double*) { return false; });
  const IntegrationResult r = run(system, {3}, {1.0});
  EXPECT_FALSE(r.done);
  EXPECT_EQ(r.end_time, 0);
  EXPECT_EQ(r.y, std::vector<double>{3});
}

TEST_P(EveryExplicit, AFailingCorrectionIsAFailure) {
  Given system = decay();
  system.correction = [](double t, double* y, bool&) {
    if (t > 0.5) y[0] = 77;
    return t <= 0.5;
  };
  const IntegrationResult r = run(system, {1}, {1.0});
  EXPECT_FALSE(r.done);
  EXPECT_NEAR(r.y[0], std::exp(-r.end_time), 1e-6) << "the state before the correction is kept";
  EXPECT_NE(r.reason.find("the correction diverged"), std::string::npos) << r.reason;
}

TEST_P(EveryExplicit, AFailureOfDenseOutputAloneIsNoticed) {
  // f exists at step ends and fails for good once the step is over: nothing to interpolate with for
  // methods whose dense output takes stages of its own.
  const std::string method = GetParam();
  const bool has_stages = method == "dop853" || method == "vern9";
  bool refuse = false;
  Given system(1, [&](double, const double*, double* f) {
    f[0] = 1;
    return !refuse;
  });
  Observer observer;
  observer.step = [&](double t0, double t1, const Interpolant& between) {
    refuse = has_stages;
    double y;
    between((t0 + t1) / 2, &y);
    EXPECT_EQ(std::isnan(y), refuse);
    return true;
  };
  const IntegrationResult r = run(system, {0}, {1.0}, observer);
  EXPECT_EQ(r.done, !has_stages);
}

TEST_P(EveryExplicit, ObserversCanStopTheRun) {
  Given system = decay();
  Observer sampler, stepper;
  sampler.sample = [](double t, const double*, const double*) { return t < 0.35; };
  IntegrationResult r = run(system, {1}, {0.15, 0.25, 0.35, 1.0}, sampler);
  EXPECT_FALSE(r.done);
  EXPECT_EQ(r.end_time, 0.35);
  EXPECT_NEAR(r.y[0], std::exp(-0.35), 1e-5);
  stepper.step = [](double, double, const Interpolant&) { return false; };
  r = run(system, {1}, {1.0}, stepper);
  EXPECT_FALSE(r.done);
  EXPECT_EQ(r.counters.steps, 1);
  EXPECT_NEAR(r.y[0], std::exp(-r.end_time), 1e-5);
}

TEST_P(EveryExplicit, LimitsOnStepsAndTime) {
  Given system = kepler();
  IntegrationOptions limited = options();
  limited.max_steps = 10;
  IntegrationResult r = integrate_explicit(GetParam(), system, 0, kepler_start, {1e3}, limited, {});
  EXPECT_FALSE(r.done);
  EXPECT_EQ(r.counters.steps + r.counters.rejected, 10);
  limited.max_steps = 1'000'000'000;
  limited.max_cpu_seconds = 0.02;
  r = integrate_explicit(GetParam(), system, 0, kepler_start, {1e9}, limited, {});
  EXPECT_FALSE(r.done);
  EXPECT_EQ(r.reason.rfind("time limit", 0), 0u) << r.reason;
}

TEST_P(EveryExplicit, AnEmptyIntervalAndAnEmptyStateAreFine) {
  Given system = decay(), nothing(0, [](double, const double*, double*) { return true; });
  int samples = 0;
  Observer observer;
  observer.sample = [&](double, const double*, const double*) { return ++samples > 0; };
  IntegrationResult r = run(system, {1}, {0.0}, observer);
  EXPECT_TRUE(r.done) << r.reason;
  EXPECT_EQ(samples, 1);
  EXPECT_EQ(r.counters.steps, 0);
  r = run(nothing, {}, {0.5, 1.0}, observer);
  EXPECT_TRUE(r.done) << r.reason;
  EXPECT_EQ(samples, 3);
}

TEST(ExplicitArguments, AreChecked) {
  Given system = decay();
  const auto run = [&](const std::string& method, const std::vector<double>& y0,
                       const std::vector<double>& times, const IntegrationOptions& options) {
    integrate_explicit(method, system, 0, y0, times, options, {});
  };
  EXPECT_THROW(run("euler", {1}, {1}, fixed(0.1)), std::invalid_argument);
  EXPECT_THROW(run("rk4", {1}, {1}, {}), std::invalid_argument);
  EXPECT_THROW(run("rk4", {1}, {1}, fixed(-0.1)), std::invalid_argument);
  EXPECT_THROW(run("dp5", {1, 2}, {1}, {}), std::invalid_argument);
  EXPECT_THROW(run("dp5", {1}, {}, {}), std::invalid_argument);
  EXPECT_THROW(run("dp5", {1}, {2, 1}, {}), std::invalid_argument);
  EXPECT_THROW(run("dp5", {1}, {-1}, {}), std::invalid_argument);
  EXPECT_THROW(run("dp5", {1}, {1}, tolerance(0)), std::invalid_argument);
}

/// y' = 1.
class Clock final : public OdeSystem {
 public:
  int size() const override { return 1; }
  bool rhs(double, const double*, double* ydot) override {
    ydot[0] = 1;
    return true;
  }
};

TEST(Explicit, SumsOfManyStepsLoseNothing) {
  // A hundred thousand steps of 0.1, each rounded off by up to half of 1.8e-12.
  Clock clock;
  IntegrationOptions options;
  options.step = 0.1;
  const auto run = integrate_explicit("rk4", clock, 0, {1.0 / 3}, {1e4}, options, {});
  ASSERT_TRUE(run.done) << run.reason;
  EXPECT_EQ(run.counters.steps, 100000);
  EXPECT_NEAR(run.y[0], 1.0 / 3 + 1e4, 4e-12);
}

// Sliding along a jump: steps are as short as the error of crossing it, for ever.
TEST(ExplicitRuns, EndWhereTheLimitOfStepsIsNearerThanTheEnd) {
  Given relay(1, [](double, const double* y, double* f) {
    f[0] = 1e6 * (y[0] > 0 ? -1.0 : 1.0);
    return true;
  });
  const IntegrationResult run =
      integrate_explicit("dop853", relay, 0, {1}, {1}, tolerance(1e-10), {});
  EXPECT_FALSE(run.done);
  EXPECT_NE(run.reason.find("at that pace the limit of 50000000 steps is reached before the end"),
            std::string::npos)
      << run.reason;
  EXPECT_LT(run.counters.steps + run.counters.rejected, 300'000);
}

}  // namespace

}  // namespace momenta::dae_solver_explicit
