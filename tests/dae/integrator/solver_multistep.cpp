// CVODE and IDA behind the common face: accuracy, outputs, exact Jacobians dense and sparse,
// limits, and failures as values.

#include <gtest/gtest.h>
#include <momenta/dae/integrator/integration.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "equations/tolerance.h"

namespace momenta::dae_solver_multistep {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

IntegrationOptions tolerance(double tol) {
  IntegrationOptions o;
  o.rtol = o.atol = tol;
  return o;
}

class GivenOde : public OdeSystem {
 public:
  using Rhs = std::function<bool(double, const double*, double*)>;
  GivenOde(int size, Rhs rhs) : size_(size), rhs_(std::move(rhs)) {}
  int size() const override { return size_; }
  bool rhs(double t, const double* y, double* ydot) override {
    return rhs_(t, y, ydot) || fail("the loop opens at t = " + std::to_string(t));
  }
  bool has_after_step() const override { return hooked; }
  /// adams must not alter accepted states; bdf has its projection function for it.
  bool after_step(double, double*, bool&) override {
    ++corrected;
    return true;
  }
  void begin_step(double, const double*) override { ++begun; }
  bool hooked = true;
  long begun = 0, corrected = 0;

 private:
  int size_;
  Rhs rhs_;
};

/// Prothero and Robinson: y' = -1000 (y - cos t) - sin t, y = cos t.
GivenOde stiff_cosine() {
  return GivenOde(1, [](double t, const double* y, double* f) {
    f[0] = -1000 * (y[0] - std::cos(t)) - std::sin(t);
    return true;
  });
}
GivenOde oscillator() {
  return GivenOde(2, [](double, const double* y, double* f) {
    f[0] = y[1], f[1] = -y[0];
    return true;
  });
}

TEST(Cvode, FollowsItsToleranceOnSmoothMotion) {
  for (const std::string method : {"adams", "bdf"}) {
    double last = 1;
    for (const double tol : {1e-4, 1e-7, 1e-10}) {
      GivenOde system = oscillator();
      const auto r = integrate_cvode(method, system, 0, {1, 0}, {10.0}, tolerance(tol), {});
      ASSERT_TRUE(r.done) << r.reason;
      EXPECT_EQ(r.end_time, 10);
      const double e = std::hypot(r.y[0] - std::cos(10.0), r.y[1] + std::sin(10.0));
      EXPECT_LT(e, 300 * tol) << method;  // the error of a multistep run is its steps' sum
      EXPECT_LT(e, last / 10) << method;
      last = e;
    }
  }
}

TEST(Cvode, BdfTakesStiffDecayInFewSteps) {
  GivenOde system = stiff_cosine();
  const auto bdf = integrate_cvode("bdf", system, 0, {2}, {10.0}, tolerance(1e-6), {});
  ASSERT_TRUE(bdf.done) << bdf.reason;
  EXPECT_NEAR(bdf.y[0], std::cos(10.0), 1e-5);
  EXPECT_LT(bdf.counters.steps, 600);
  EXPECT_GT(bdf.counters.jacobians, 0);
  EXPECT_GT(bdf.counters.factorizations, 0);
  EXPECT_GE(bdf.counters.newton_iterations, bdf.counters.steps);
  EXPECT_EQ(bdf.linear_solver, "dense LU");
  EXPECT_EQ(bdf.jacobian, "difference quotient");
  const auto adams = integrate_cvode("adams", system, 0, {2}, {10.0}, tolerance(1e-6), {});
  EXPECT_GT(adams.counters.steps, 10 * bdf.counters.steps);
  EXPECT_EQ(adams.jacobian, "");
  EXPECT_EQ(adams.counters.jacobians, 0);
}

TEST(Cvode, ShowsEachStepAndSamplesBetween) {
  for (const std::string method : {"adams", "bdf"}) {
    GivenOde system = oscillator();
    std::vector<double> times, seen;
    for (int i = 0; i <= 300; ++i) times.push_back(0.02 * i);
    double reached = 0, worst = 0;
    long steps = 0;
    Observer observer;
    observer.sample = [&](double t, const double* y, const double* ydot) {
      EXPECT_EQ(ydot, nullptr);
      seen.push_back(t);
      worst = equations::larger(worst, std::abs(y[0] - std::cos(t)));
      return true;
    };
    observer.step = [&](double t0, double t1, const Interpolant& between) {
      EXPECT_EQ(t0, reached);
      reached = t1;
      ++steps;
      for (const double t : {t0, (t0 + t1) / 2, t1}) {
        double y[2];
        between(t, y);
        worst = equations::larger(worst, std::abs(y[0] - std::cos(t)));
      }
      return true;
    };
    const auto r = integrate_cvode(method, system, 0, {1, 0}, times, tolerance(1e-9), observer);
    ASSERT_TRUE(r.done) << r.reason;
    EXPECT_EQ(seen, times);
    EXPECT_EQ(reached, times.back());
    EXPECT_EQ(steps, r.counters.steps);
    EXPECT_EQ(system.begun, steps);
    EXPECT_EQ(system.corrected > 0, method == "bdf");
    EXPECT_LT(worst, 1e-6) << method;
  }
}

TEST(Cvode, FailuresAreValues) {
  for (const std::string method : {"adams", "bdf"}) {
    for (const bool not_a_number : {false, true}) {
      GivenOde system(1, [=](double t, const double* y, double* f) {
        f[0] = t > 0.5 && not_a_number ? std::nan("") : -y[0];
        return t <= 0.5 || not_a_number;
      });
      std::vector<double> seen;
      Observer observer;
      observer.sample = [&](double t, const double*, const double*) {
        seen.push_back(t);
        return true;
      };
      const auto r =
          integrate_cvode(method, system, 0, {1}, {0.1, 0.4, 0.6}, tolerance(1e-6), observer);
      EXPECT_FALSE(r.done);
      EXPECT_EQ(seen, (std::vector<double>{0.1, 0.4}));
      EXPECT_LE(r.end_time, 0.5);
      EXPECT_GT(r.end_time, 0.4);
      EXPECT_NEAR(r.y[0], std::exp(-r.end_time), 1e-4);
      EXPECT_NE(r.reason.find(method + " stopped at t = 0.5"), std::string::npos) << r.reason;
      EXPECT_NE(r.reason.find(not_a_number ? "not a finite number" : "the loop opens"),
                std::string::npos)
          << r.reason;
    }
    GivenOde never(1, [](double, const double*, double*) { return false; });
    EXPECT_FALSE(integrate_cvode(method, never, 0, {1}, {1.0}, tolerance(1e-6), {}).done);
  }
}

TEST(Cvode, LimitsStopsAndArguments) {
  GivenOde system = oscillator();
  IntegrationOptions options = tolerance(1e-8);
  options.max_steps = 10;
  auto r = integrate_cvode("adams", system, 0, {1, 0}, {1e4}, options, {});
  EXPECT_FALSE(r.done);
  EXPECT_EQ(r.counters.steps, 10);
  options.max_steps = 1'000'000'000;
  options.max_cpu_seconds = 0.02;
  r = integrate_cvode("bdf", system, 0, {1, 0}, {1e9}, options, {});
  EXPECT_EQ(r.reason.rfind("time limit", 0), 0u) << r.reason;
  Observer observer;
  observer.sample = [](double t, const double*, const double*) { return t < 2; };
  r = integrate_cvode("adams", system, 0, {1, 0}, {1.0, 2.0, 3.0}, tolerance(1e-8), observer);
  EXPECT_FALSE(r.done);
  EXPECT_EQ(r.end_time, 2);
  EXPECT_NEAR(r.y[0], std::cos(2.0), 1e-6);
  EXPECT_TRUE(integrate_cvode("adams", system, 0, {1, 0}, {0.0}, tolerance(1e-8), {}).done);
  EXPECT_THROW(integrate_cvode("gear", system, 0, {1, 0}, {1.0}, {}, {}), std::invalid_argument);
  EXPECT_THROW(integrate_cvode("bdf", system, 0, {1}, {1.0}, {}, {}), std::invalid_argument);
  EXPECT_THROW(integrate_cvode("bdf", system, 0, {1, 0}, {1.0}, tolerance(0), {}),
               std::invalid_argument);
}

/// A DAE from functions; its Jacobian is given dense, and stored as asked.
class GivenDae : public DaeSystem {
 public:
  bool sparse = false;
  bool with_failure = false;
  double fails_after = infinity;
  std::vector<bool> is_differential;
  std::vector<double> scales, y0, ydot0;
  std::function<void(double, const double*, const double*, double*)> f;
  /// Column-major ∂F/∂y + c ∂F/∂y'.
  std::function<void(double, const double*, const double*, double, double*)> df;

  int size() const override { return int(y0.size()); }
  bool residual(double t, const double* y, const double* ydot, double* r) override {
    f(t, y, ydot, r);
    if (t > fails_after && !with_failure) r[0] = std::nan("");
    return !(t > fails_after && with_failure) || fail("the branch is lost");
  }
  bool jacobian(double t, const double* y, const double* ydot, double c, double* values) override {
    const std::size_t n = y0.size();
    std::vector<double> full(n * n, 0.0);
    df(t, y, ydot, c, full.data());
    if (!sparse) {
      std::copy(full.begin(), full.end(), values);
      return true;
    }
    for (std::size_t column = 0, k = 0; column < n; ++column)
      for (; k < std::size_t(pattern_.column_start[column + 1]); ++k)
        values[k] = full[column * n + std::size_t(pattern_.row[k])];
    return true;
  }
  const JacobianPattern& pattern() const override { return pattern_; }
  bool start(double, double* y, double* ydot) override {
    std::copy(y0.begin(), y0.end(), y);
    std::copy(ydot0.begin(), ydot0.end(), ydot);
    return true;
  }
  bool differential(int i) const override { return is_differential[std::size_t(i)]; }
  double scale(int i) const override { return scales[std::size_t(i)]; }

  void make_sparse(std::vector<long> column_start, std::vector<long> row) {
    sparse = true;
    pattern_ = {std::move(column_start), std::move(row)};
  }

 private:
  JacobianPattern pattern_;
};

/// Index 1: y' = -y + z, 0 = z - y² + sin t; a toy whose algebraic equation is nonlinear.
GivenDae index_one() {
  GivenDae s;
  s.is_differential = {true, false};
  s.scales = {1, 1};
  s.y0 = {0.5, 0.25};
  s.ydot0 = {-0.25, 0};
  s.f = [](double t, const double* y, const double* yd, double* r) {
    r[0] = yd[0] + y[0] - y[1];
    r[1] = y[1] - y[0] * y[0] + std::sin(t);
  };
  s.df = [](double, const double* y, const double*, double c, double* j) {
    j[0] = c + 1, j[1] = -2 * y[0];
    j[2] = -1, j[3] = 1;
  };
  return s;
}

/// Cartesian pendulum of length 1 at g = 9.81, constraint at the velocity level (index 2):
/// x' = u, y' = v, u' = -λx, v' = -λy - g, 0 = x u + y v; unknowns x y u v λ.
GivenDae pendulum() {
  constexpr double g = 9.81;
  GivenDae s;
  s.is_differential = {true, true, true, true, false};
  s.scales = {1, 1, 1, 1, infinity};
  s.y0 = {1, 0, 0, 0, 0};
  s.ydot0 = {0, 0, 0, -g, 0};
  s.f = [](double, const double* y, const double* yd, double* r) {
    r[0] = yd[0] - y[2];
    r[1] = yd[1] - y[3];
    r[2] = yd[2] + y[4] * y[0];
    r[3] = yd[3] + y[4] * y[1] + g;
    r[4] = y[0] * y[2] + y[1] * y[3];
  };
  s.df = [](double, const double* y, const double*, double c, double* j) {
    j[0] = c, j[2] = y[4], j[4] = y[2];
    j[5 + 1] = c, j[5 + 3] = y[4], j[5 + 4] = y[3];
    j[10 + 0] = -1, j[10 + 2] = c, j[10 + 4] = y[0];
    j[15 + 1] = -1, j[15 + 3] = c, j[15 + 4] = y[1];
    j[20 + 2] = y[0], j[20 + 3] = y[1];
  };
  return s;
}
void make_pendulum_sparse(GivenDae& s) {
  s.make_sparse({0, 3, 6, 9, 12, 14}, {0, 2, 4, 1, 3, 4, 0, 2, 4, 1, 3, 4, 2, 3});
}

/// The same pendulum by its angle from the horizontal, φ'' = -g cos φ.
std::vector<double> pendulum_by_angle(double end) {
  GivenOde angle(2, [](double, const double* y, double* f) {
    f[0] = y[1], f[1] = -9.81 * std::cos(y[0]);
    return true;
  });
  const auto r = integrate_cvode("adams", angle, 0, {0, 0}, {end}, tolerance(1e-12), {});
  return {std::cos(r.y[0]), std::sin(r.y[0])};
}

TEST(Ida, IndexOneAgainstTheReducedOde) {
  for (const double tol : {1e-5, 1e-8}) {
    GivenDae system = index_one();
    const auto r = integrate_ida(system, 0, {2.0}, tolerance(tol), {});
    ASSERT_TRUE(r.done) << r.reason;
    GivenOde ode(1, [](double t, const double* y, double* f) {
      f[0] = -y[0] + y[0] * y[0] - std::sin(t);
      return true;
    });
    ode.hooked = false;
    const auto truth = integrate_explicit("dop853", ode, 0, {0.5}, {2.0}, tolerance(1e-13), {});
    EXPECT_NEAR(r.y[0], truth.y[0], 100 * tol);
    EXPECT_NEAR(r.y[1], r.y[0] * r.y[0] - std::sin(2.0), 10 * tol);
    EXPECT_EQ(r.linear_solver, "dense LU");
    EXPECT_EQ(r.jacobian, "dual numbers");
    EXPECT_GT(r.counters.jacobians, 0);
    EXPECT_GE(r.counters.factorizations, r.counters.jacobians);
    EXPECT_GE(r.counters.evaluations, r.counters.newton_iterations);
    EXPECT_GE(r.counters.newton_iterations, r.counters.steps);
  }
}

TEST(Ida, PendulumOfIndexTwoDenseAndSparse) {
  const std::vector<double> truth = pendulum_by_angle(2);
  for (const double tol : {1e-5, 1e-7, 1e-9}) {
    GivenDae dense = pendulum(), sparse = pendulum();
    make_pendulum_sparse(sparse);
    const auto d = integrate_ida(dense, 0, {2.0}, tolerance(tol), {});
    const auto s = integrate_ida(sparse, 0, {2.0}, tolerance(tol), {});
    ASSERT_TRUE(d.done) << d.reason;
    ASSERT_TRUE(s.done) << s.reason;
    EXPECT_EQ(s.linear_solver, "KLU");
    // Errors of a thousand steps or so add up.
    EXPECT_NEAR(d.y[0], truth[0], 1000 * tol);
    EXPECT_NEAR(d.y[1], truth[1], 1000 * tol);
    // The same Newton matrices up to rounding, which step control amplifies: within the error.
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(d.y[i], s.y[i], 200 * tol);
    EXPECT_NEAR(double(d.counters.steps), double(s.counters.steps), 0.1 * double(s.counters.steps));
  }
}

TEST(Ida, StartsAlsoWithTooLongAFirstStep) {
  GivenDae system = pendulum();
  IntegrationOptions options = tolerance(1e-9);
  options.initial_step = 1;
  const auto r = integrate_ida(system, 0, {1.0}, options, {});
  EXPECT_TRUE(r.done) << r.reason;
  EXPECT_NEAR(r.y[0], pendulum_by_angle(1)[0], 1e-6);
}

TEST(Ida, TriesAgainWithShorterFirstSteps) {
  // More failures in a row than one attempt may have; they count as rejected steps.
  class Stubborn : public GivenDae {
   public:
    int calls = 0;
    bool residual(double t, const double* y, const double* ydot, double* r) override {
      return ++calls > 25 ? GivenDae::residual(t, y, ydot, r) : fail("not yet");
    }
  } system;
  static_cast<GivenDae&>(system) = pendulum();
  const auto r = integrate_ida(system, 0, {1.0}, tolerance(1e-6), {});
  EXPECT_TRUE(r.done) << r.reason;
  EXPECT_GE(r.counters.rejected, 25);
  EXPECT_NEAR(r.y[0], pendulum_by_angle(1)[0], 1e-3);
}

/// index_one() with an algebraic equation that is rough by `roughness` at the scale of rounding, as
/// one with large terms that cancel.
GivenDae rough_index_one(double roughness) {
  GivenDae s = index_one();
  s.f = [smooth = s.f, roughness](double t, const double* y, const double* yd, double* r) {
    smooth(t, y, yd, r);
    const std::size_t chance = std::hash<double>()(y[0]) ^ (std::hash<double>()(y[1]) << 1);
    r[1] +=
        roughness * (static_cast<double>(std::minstd_rand(chance % 2147483647u)()) * 0x1p-30 - 1);
  };
  return s;
}

TEST(Ida, AcceptsCorrectionsThatOnlyRoundingMakes) {
  // A sixth of the tolerance: five times what Newton's method is to leave.
  const double tol = 1e-7;
  GivenDae smooth = index_one(), rough = rough_index_one(0.15 * tol);
  const auto truth = integrate_ida(smooth, 0, {2.0}, tolerance(1e-11), {});
  const auto r = integrate_ida(rough, 0, {2.0}, tolerance(tol), {});
  ASSERT_TRUE(r.done) << r.reason;
  EXPECT_NEAR(r.y[0], truth.y[0], 100 * tol);
  EXPECT_LT(r.counters.steps, 1000);
}

TEST(Ida, NamesRoundingWhereItIsMoreThanTheTolerance) {
  const double tol = 1e-7;
  GivenDae rough = rough_index_one(1000 * tol);
  const auto r = integrate_ida(rough, 0, {2.0}, tolerance(tol), {});
  EXPECT_FALSE(r.done);
  EXPECT_NE(r.reason.find("the tolerance asks for more than double precision has: rounding of the "
                          "state alone moves Newton's corrections by "),
            std::string::npos)
      << r.reason;
}

TEST(Ida, SamplesCarryRates) {
  GivenDae system = pendulum();
  std::vector<double> times, seen;
  for (int i = 0; i <= 100; ++i) times.push_back(0.01 * i);
  double worst = 0, reached = 0;
  Observer observer;
  observer.sample = [&](double t, const double* y, const double* ydot) {
    seen.push_back(t);
    worst = std::max({worst, std::abs(ydot[0] - y[2]), std::abs(ydot[1] - y[3])});
    return true;
  };
  observer.step = [&](double t0, double t1, const Interpolant& between) {
    EXPECT_EQ(t0, reached);
    reached = t1;
    double y[5];
    between((t0 + t1) / 2, y);
    EXPECT_NEAR(std::hypot(y[0], y[1]), 1, 1e-6);
    return true;
  };
  const auto r = integrate_ida(system, 0, times, tolerance(1e-8), observer);
  ASSERT_TRUE(r.done) << r.reason;
  EXPECT_EQ(seen, times);
  EXPECT_EQ(reached, 1.0);
  // y' of dense output is one order below y.
  EXPECT_LT(worst, 1e-4);
}

TEST(Ida, FailuresAreValues) {
  for (const bool with_failure : {false, true}) {
    GivenDae system = pendulum();
    system.fails_after = 0.5;
    system.with_failure = with_failure;
    std::vector<double> seen;
    Observer observer;
    observer.sample = [&](double t, const double*, const double*) {
      seen.push_back(t);
      return true;
    };
    const auto r = integrate_ida(system, 0, {0.2, 0.4, 0.6}, tolerance(1e-7), observer);
    EXPECT_FALSE(r.done);
    EXPECT_EQ(seen, (std::vector<double>{0.2, 0.4}));
    EXPECT_GT(r.end_time, 0.4);
    EXPECT_LE(r.end_time, 0.5);
    EXPECT_NEAR(std::hypot(r.y[0], r.y[1]), 1, 1e-4);
    EXPECT_NE(r.reason.find("ida stopped at t = 0.5"), std::string::npos) << r.reason;
    EXPECT_NE(r.reason.find(with_failure ? "the branch is lost" : "not a finite number"),
              std::string::npos)
        << r.reason;
  }
}

TEST(Ida, AFailingStartIsAFailure) {
  class Unstartable : public GivenDae {
    bool start(double, double*, double*) override { return fail("loop 'C' does not close"); }
  } system;
  static_cast<GivenDae&>(system) = index_one();
  const auto r = integrate_ida(system, 3, {4.0}, tolerance(1e-6), {});
  EXPECT_FALSE(r.done);
  EXPECT_EQ(r.end_time, 3);
  EXPECT_NE(r.reason.find("loop 'C' does not close"), std::string::npos) << r.reason;
}

TEST(Ida, ASingularNewtonMatrixIsAFailure) {
  for (const bool sparse : {false, true}) {
    GivenDae system = pendulum();
    if (sparse) make_pendulum_sparse(system);
    const auto df = system.df;
    system.df = [=](double t, const double* y, const double* yd, double c, double* j) {
      df(t, y, yd, c, j);
      j[20 + 2] = j[20 + 3] = 0;
    };
    const auto r = integrate_ida(system, 0, {1.0}, tolerance(1e-6), {});
    EXPECT_FALSE(r.done);
    EXPECT_EQ(r.end_time, 0);
    EXPECT_FALSE(r.reason.empty());
  }
}

TEST(Ida, LimitsStopsAndArguments) {
  GivenDae system = pendulum();
  IntegrationOptions options = tolerance(1e-7);
  options.max_steps = 10;
  auto r = integrate_ida(system, 0, {10.0}, options, {});
  EXPECT_FALSE(r.done);
  EXPECT_EQ(r.counters.steps, 10);
  options.max_steps = 1'000'000'000;
  options.max_cpu_seconds = 0.02;
  r = integrate_ida(system, 0, {1e5}, options, {});
  EXPECT_EQ(r.reason.rfind("time limit", 0), 0u) << r.reason;
  options = tolerance(1e-7);
  options.max_order = 2;
  const auto low = integrate_ida(system, 0, {2.0}, options, {});
  options.max_order = 0;
  const auto full = integrate_ida(system, 0, {2.0}, options, {});
  EXPECT_GT(low.counters.steps, 2 * full.counters.steps);
  Observer observer;
  int samples = 0;
  observer.sample = [&](double, const double*, const double* ydot) {
    return ++samples > 0 && ydot != nullptr;
  };
  EXPECT_TRUE(integrate_ida(system, 0, {0.0}, options, observer).done);
  EXPECT_EQ(samples, 1);
  EXPECT_THROW(integrate_ida(system, 0, {}, options, {}), std::invalid_argument);
  EXPECT_THROW(integrate_ida(system, 0, {1.0}, tolerance(0), {}), std::invalid_argument);
}

}  // namespace

}  // namespace momenta::dae_solver_multistep
