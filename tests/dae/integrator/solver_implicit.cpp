// The registry of integrators; limits, stops, failures and bookkeeping of radau5, gauss,
// generalised-alpha and bayo-ledesma; matrices dense and sparse.

#include <gtest/gtest.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/implicit_methods.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/integrator/newton_matrix.h>
#include <momenta/dae/integrator/radau5_stages.h>
#include <momenta/dae/run/run_form.h>

#include "equations/cartesian_pendulum.h"
#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

#include <random>

namespace momenta::dae_solver_implicit {
namespace {

using namespace equations;

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}
IntegrationOptions tolerance(double tol) {
  IntegrationOptions o;
  o.rtol = o.atol = tol;
  return o;
}

TEST(Integrators, EveryNameRunsTheFormsItTakes) {
  const Mechanism mechanism(equations::example("four_bar"));
  const Start start = equations::start_of(mechanism);
  for (const Integrator& method : integrators()) {
    RunRequest request;
    request.settings.form = method.takes == Integrator::Takes::ode ? "momentum" : "momentum-index2";
    if (!method.forms.empty()) request.settings.form = method.forms.front();
    request.settings.integrator = method.name;
    request.settings.gauge = "leak";
    request.settings.step = 0.005;
    request.settings.end_time = 0.5;
    request.settings.samples = 10;
    const RunResult run = run_form(mechanism, start, request);
    EXPECT_EQ(run.status, "done") << method.name << ": " << run.reason;
    EXPECT_LT(run.energy_error_max, 1e-2) << method.name;
    EXPECT_EQ(run.settings.step > 0, method.step == Integrator::Step::fixed) << method.name;
    EXPECT_FALSE(method.method.empty());
    EXPECT_EQ(integrator(method.name).method, method.method);
  }
}

std::string refusal(const Mechanism& mechanism, const std::string& form,
                    const std::string& integrator, const std::string& gauge = "none",
                    bool project = false, double step = 0) {
  RunRequest request = equations::stepped(form, integrator, gauge, step, 0.1, 1);
  request.settings.project = project;
  try {
    const RunResult run = run_form(mechanism, equations::start_of(mechanism), request);
    return run.status;
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
}

TEST(Integrators, RefuseWhatDoesNotFitWithASentence) {
  const Mechanism mechanism(equations::example("four_bar"));
  const auto with = [&](const std::string& form, const std::string& integrator,
                        const std::string& gauge = "none", bool project = false, double step = 0) {
    return refusal(mechanism, form, integrator, gauge, project, step);
  };
  EXPECT_TRUE(says(with("momentum-index2", "dop853"), "expected integrator ida, bdf5, radau5"));
  EXPECT_TRUE(says(with("momentum", "radau5"), "rk4, dp5"));
  EXPECT_TRUE(says(with("momentum", "euler"), "integrator 'euler' is not known; expected rk4, "));
  EXPECT_TRUE(says(with("momentum", "gauss4"), "fixed step"));
  EXPECT_TRUE(says(with("acceleration-index2", "generalised-alpha", "none", false, 0.01),
                   "acceleration-index3"));
  EXPECT_TRUE(says(with("acceleration-index3", "generalised-alpha"), "step"));
  EXPECT_TRUE(says(with("acceleration-index2", "bayo-ledesma", "none", false, 0.01),
                   "acceleration-index3"));
  EXPECT_TRUE(says(with("acceleration-index3", "bayo-ledesma"), "step"));
  EXPECT_TRUE(says(with("momentum", "adams", "none", true), "history"));
  EXPECT_TRUE(says(with("momentum", "bdf", "reset"), "multistep"));
  EXPECT_TRUE(says(with("momentum", "bdf", "flip"), "history"));
  EXPECT_TRUE(says(with("momentum-index2", "radau5", "flip"), "expected none, leak or reset"));
  EXPECT_EQ(with("momentum", "bdf", "none", true), "done");
  EXPECT_TRUE(says(with("acceleration", "rattle", "none", false, 0.01), "is for form momentum"));
  EXPECT_TRUE(says(with("momentum", "rattle", "none", true, 0.01), "--project"));
  EXPECT_TRUE(says(with("momentum", "rattle"), "step > 0"));
}

TEST(Integrators, DefaultGoesByTolerance) {
  for (const auto& [rtol, name] :
       {std::pair(1e-2, "dp5"), std::pair(1e-4, "dp5"), std::pair(1e-5, "dop853"),
        std::pair(1e-8, "dop853"), std::pair(1e-9, "vern9"), std::pair(1e-13, "vern9")})
    EXPECT_EQ(default_integrator("momentum", rtol), name) << rtol;
  EXPECT_EQ(default_integrator("momentum-index2", 1e-4), "ida");
}

TEST(Integrators, PropertiesFitEachOther) {
  for (const Integrator& method : integrators()) {
    if (method.gauge != Integrator::Preferred::leak) {
      EXPECT_TRUE(method.resets) << method.name;
    }
    for (const std::string& form : method.closes)
      EXPECT_TRUE(method.takes_form(form, is_dae_form(form))) << method.name << ' ' << form;
  }
  EXPECT_EQ(integrator("radau5").gauge, Integrator::Preferred::leak);
  EXPECT_EQ(integrator("bdf5").gauge, Integrator::Preferred::reset);
  EXPECT_EQ(integrator("hem5").gauge, Integrator::Preferred::reset_of_independent);
  EXPECT_EQ(integrator("hem8").gauge, Integrator::Preferred::reset);
}

TEST(Bdf, ProjectedKeepsTheLoopsShut) {
  const Mechanism mechanism(equations::example("four_bar"));
  for (const char* form : {"momentum", "acceleration"}) {
    RunRequest request = equations::adaptive(form, "bdf", "leak", 1e-7, 5, 100);
    const RunResult free = run_form(mechanism, equations::start_of(mechanism), request);
    request.settings.project = true;
    const RunResult kept = run_form(mechanism, equations::start_of(mechanism), request);
    ASSERT_EQ(free.status, "done") << free.reason;
    ASSERT_EQ(kept.status, "done") << kept.reason;
    EXPECT_GT(free.position_drift_max, 1e-8) << form;
    EXPECT_LT(kept.position_drift_max, 1e-13) << form;
    EXPECT_LT(kept.velocity_drift_max, 1e-12) << form;
    EXPECT_LT(kept.counters.steps, 1.3 * static_cast<double>(free.counters.steps)) << form;
  }
}

TEST(Radau5, TransformationDiagonalises) {
  const Eigen::Matrix3d inverse = radau5::coefficients().inverse(), t = radau5::transformation();
  Eigen::Matrix3d lambda = Eigen::Matrix3d::Zero();
  lambda(0, 0) = radau5::gamma;
  lambda.bottomRightCorner<2, 2>() << radau5::alpha, -radau5::beta, radau5::beta, radau5::alpha;
  EXPECT_LT((inverse * t - t * lambda).cwiseAbs().maxCoeff(), 1e-13);
  // Collocation at c: Σ_j a_ij c_j^k = c_i^(k+1)/(k+1).
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i) {
      double sum = 0;
      for (int j = 0; j < 3; ++j)
        sum += radau5::coefficients()(i, j) * std::pow(radau5::c[static_cast<std::size_t>(j)], k);
      EXPECT_NEAR(sum, std::pow(radau5::c[static_cast<std::size_t>(i)], k + 1) / (k + 1), 1e-15);
    }
}

TEST(Radau5, KeepsItsTolerance) {
  for (const int index : {2, 3}) {
    double last = 1;
    for (const double tol : {1e-4, 1e-6, 1e-8}) {
      CartesianPendulum system(index);
      const auto run = integrate_radau5(system, 0, {1.5}, tolerance(tol), {});
      ASSERT_TRUE(run.done) << run.reason;
      const auto truth = CartesianPendulum::exact(1.5);
      const double error = std::hypot(run.y[0] - truth[0], run.y[1] - truth[1]);
      EXPECT_LT(error, 20 * tol) << index;
      EXPECT_LT(error, last / 10) << index;
      last = error;
      EXPECT_GE(run.counters.newton_iterations, run.counters.steps);
      EXPECT_EQ(run.counters.evaluations, 3 * run.counters.newton_iterations);
      EXPECT_EQ(run.counters.factorizations % 2, 0);
      EXPECT_GT(run.counters.jacobians, 0);
      EXPECT_EQ(run.linear_solver, "dense LU");
    }
  }
}

TEST(Radau5, SamplesLieOnTheConstraintsAndChangeNothing) {
  std::vector<double> times;
  for (int i = 0; i <= 150; ++i) times.push_back(0.01 * i);
  CartesianPendulum watched(3), alone(3);
  double opened = 0, off = 0;
  std::vector<double> seen;
  Observer observer;
  observer.sample = [&](double t, const double* y, const double* ydot) {
    seen.push_back(t);
    opened = equations::larger(opened, std::abs(y[0] * y[0] + y[1] * y[1] - 1));
    off = equations::larger(off, std::abs(y[0] - CartesianPendulum::exact(t)[0]));
    EXPECT_NEAR(ydot[0], y[2], 1e-6);
    return true;
  };
  observer.step = [&](double t0, double t1, const Interpolant& between) {
    double y[5];
    between(t0, y);
    EXPECT_NEAR(std::hypot(y[0], y[1]), 1, 1e-8);
    between(t1, y);
    EXPECT_NEAR(std::hypot(y[0], y[1]), 1, 1e-8);
    return true;
  };
  const auto a = integrate_radau5(watched, 0, times, tolerance(1e-7), observer);
  const auto b = integrate_radau5(alone, 0, {1.5}, tolerance(1e-7), {});
  ASSERT_TRUE(a.done) << a.reason;
  EXPECT_EQ(seen, times);
  EXPECT_LT(opened, 1e-8);  // Newton stops at a fraction of the tolerance
  EXPECT_LT(off, 1e-5);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.counters.evaluations, b.counters.evaluations);
  EXPECT_EQ(a.counters.factorizations, b.counters.factorizations);
}

/// Cannot be evaluated after t = 0.5 s.
class Breaking final : public CartesianPendulum {
 public:
  Breaking() : CartesianPendulum(2) {}
  bool residual(double t, const double* y, const double* yd, double* r) override {
    return t <= 0.5 ? CartesianPendulum::residual(t, y, yd, r) : fail("the branch is lost");
  }
};

TEST(Radau5, FailuresAreValues) {
  Breaking system;
  std::vector<double> seen;
  Observer observer;
  observer.sample = [&](double t, const double*, const double*) {
    seen.push_back(t);
    return true;
  };
  const auto run = integrate_radau5(system, 0, {0.2, 0.4, 0.6}, tolerance(1e-7), observer);
  EXPECT_FALSE(run.done);
  EXPECT_EQ(seen, (std::vector<double>{0.2, 0.4}));
  EXPECT_GT(run.end_time, 0.4);
  EXPECT_LE(run.end_time, 0.5);
  EXPECT_NEAR(std::hypot(run.y[0], run.y[1]), 1, 1e-5);
  EXPECT_TRUE(says(run.reason, "radau5 stopped at t = 0.5")) << run.reason;
  EXPECT_TRUE(says(run.reason, "the branch is lost")) << run.reason;
}

TEST(Radau5, ASingularMatrixIsAFailure) {
  class Singular final : public CartesianPendulum {
   public:
    Singular() : CartesianPendulum(2) {}
    bool jacobian(double, const double*, const double*, double, double* j) override {
      return std::fill(j, j + 25, 0.0), true;
    }
  } system;
  const auto run = integrate_radau5(system, 0, {1.0}, tolerance(1e-6), {});
  EXPECT_FALSE(run.done);
  EXPECT_EQ(run.end_time, 0);
  EXPECT_TRUE(says(run.reason, "singular")) << run.reason;
}

TEST(Radau5, LimitsStopsAndArguments) {
  CartesianPendulum system(2);
  IntegrationOptions options = tolerance(1e-7);
  options.max_steps = 10;
  auto run = integrate_radau5(system, 0, {10.0}, options, {});
  EXPECT_FALSE(run.done);
  EXPECT_EQ(run.counters.steps, 10);
  options.max_steps = 1'000'000'000;
  options.max_cpu_seconds = 0.02;
  run = integrate_radau5(system, 0, {1e6}, options, {});
  EXPECT_EQ(run.reason.rfind("time limit", 0), 0u) << run.reason;
  Observer observer;
  observer.sample = [](double t, const double*, const double*) { return t < 0.7; };
  run = integrate_radau5(system, 0, {0.5, 0.7, 1.0}, tolerance(1e-7), observer);
  EXPECT_FALSE(run.done);
  EXPECT_EQ(run.end_time, 0.7);
  EXPECT_TRUE(integrate_radau5(system, 0, {0.0}, tolerance(1e-7), {}).done);
  EXPECT_THROW(integrate_radau5(system, 0, {1.0}, tolerance(0), {}), std::invalid_argument);
}

class Oscillator final : public OdeSystem {
 public:
  explicit Oscillator(double frequency, double breaks = 1e9)
      : square_(frequency * frequency), breaks_(breaks) {}
  int size() const override { return 2; }
  bool rhs(double t, const double* y, double* ydot) override {
    ydot[0] = y[1], ydot[1] = -square_ * y[0];
    return t <= breaks_ || fail("the spring breaks");
  }

 private:
  double square_, breaks_;
};

TEST(Gauss, ConvergesWhereFixedPointIterationDoesNot) {
  // h ω = 5: only Newton's method gets there, and for a linear system energy is kept to rounding.
  for (const int stages : {2, 3}) {
    Oscillator fast(50);
    IntegrationOptions options;
    options.step = 0.1;
    const auto run = integrate_gauss(stages, fast, 0, {1, 0}, {100.0}, options, {});
    ASSERT_TRUE(run.done) << run.reason;
    EXPECT_NEAR(2500 * run.y[0] * run.y[0] + run.y[1] * run.y[1], 2500, 1e-8);
    EXPECT_GT(run.counters.jacobians, 0);
    EXPECT_LT(run.counters.jacobians, 5);
    EXPECT_EQ(run.linear_solver, "dense LU");
    EXPECT_EQ(run.jacobian, "difference quotient");
    Oscillator slow(1);
    const auto easy = integrate_gauss(stages, slow, 0, {1, 0}, {10.0}, options, {});
    ASSERT_TRUE(easy.done);
    EXPECT_EQ(easy.counters.jacobians, 0);
    EXPECT_EQ(easy.jacobian, "");
    EXPECT_NEAR(easy.y[0], std::cos(10.0), stages == 2 ? 1e-5 : 1e-8);
  }
}

TEST(Gauss, FailuresLimitsAndArguments) {
  IntegrationOptions options;
  options.step = 0.03;
  Oscillator breaking(1, 0.5);
  std::vector<double> seen;
  Observer observer;
  observer.sample = [&](double t, const double* y, const double*) {
    seen.push_back(t);
    EXPECT_NEAR(y[0], std::cos(t), 1e-7);
    return true;
  };
  auto run = integrate_gauss(2, breaking, 0, {1, 0}, {0.2, 0.48, 0.6}, options, observer);
  EXPECT_FALSE(run.done);
  EXPECT_EQ(seen, (std::vector<double>{0.2, 0.48}));
  EXPECT_NEAR(run.end_time, 0.48, 1e-12);
  EXPECT_TRUE(says(run.reason, "gauss4 stopped at t = 0.48 s: the spring breaks")) << run.reason;
  Oscillator system(1);
  options.max_steps = 10;
  run = integrate_gauss(3, system, 0, {1, 0}, {1.0}, options, {});
  EXPECT_FALSE(run.done);
  EXPECT_EQ(run.counters.steps, 10);
  options.max_steps = 1'000'000'000;
  options.max_cpu_seconds = 0.02;
  run = integrate_gauss(3, system, 0, {1, 0}, {1e9}, options, {});
  EXPECT_EQ(run.reason.rfind("time limit", 0), 0u) << run.reason;
  EXPECT_THROW(integrate_gauss(4, system, 0, {1, 0}, {1.0}, options, {}), std::invalid_argument);
  EXPECT_THROW(integrate_gauss(2, system, 0, {1}, {1.0}, options, {}), std::invalid_argument);
  options.step = 0;
  EXPECT_THROW(integrate_gauss(2, system, 0, {1, 0}, {1.0}, options, {}), std::invalid_argument);
}

TEST(GeneralisedAlpha, ConditionDoesNotGrowAsStepsShrink) {
  // Newton's iterations a step at h and h/1000, at the same tolerance.
  const Mechanism mechanism(equations::example("four_bar"));
  const Start start = equations::start_of(mechanism);
  for (const double h : {1e-3, 1e-6}) {
    const auto form = make_form("acceleration-index3", mechanism, {}, start);
    IntegrationOptions options = tolerance(1e-9);
    options.step = h;
    const auto run = integrate_generalised_alpha(*form->dae(), 0, {100 * h}, options, {});
    ASSERT_TRUE(run.done) << run.reason;
    EXPECT_LE(run.counters.newton_iterations, 4 * run.counters.steps) << h;
    EXPECT_LE(run.counters.jacobians, 3) << h;
    Snapshot end;
    ASSERT_TRUE(form->read(100 * h, run.y.data(), nullptr, end));
    EXPECT_LT((end.multipliers - start.lambda).norm(), 1e-2 * start.lambda.norm() + 1e3 * h) << h;
  }
}

TEST(GeneralisedAlpha, SamplesBetweenStepsKeepTheLoopsShut) {
  const Mechanism mechanism(equations::example("four_bar"));
  const RunResult run = run_form(
      mechanism, equations::start_of(mechanism),
      equations::stepped("acceleration-index3", "generalised-alpha", "none", 0.0101, 2, 77));
  ASSERT_EQ(run.status, "done") << run.reason;
  EXPECT_EQ(run.counters.steps, 199);
  EXPECT_LT(run.position_drift_max, 1e-9);
  EXPECT_GT(run.velocity_drift_max, 1e-7);  // order 2, not a constraint of the method
}

TEST(BayoLedesma, HoldsPositionsRatesAndAccelerations) {
  // The last of the three by what projections are for: v̇ and λ of the trapezoidal rule alone swing
  // from step to step.
  for (const Scene& scene :
       {equations::example("four_bar"), equations::row_of_four_bars(12, 1.2)}) {
    const Mechanism mechanism(scene);
    const Start start = equations::start_of(mechanism);
    const auto form = make_form("acceleration-index3", mechanism, {}, start);
    const auto e = mechanism.evaluation<double>();
    IntegrationOptions options = tolerance(1e-9);
    options.step = 0.003;
    double position = 0, rate = 0, acceleration = 0;
    Eigen::VectorXd phi(mechanism.m()), forces(mechanism.nv());
    Observer look;
    look.sample = [&](double t, const double* y, const double* ydot) {
      const double *q = y, *v = y + mechanism.nq();
      e->place(t, q);
      e->positions(phi.data());
      position = equations::larger(position, phi.cwiseAbs().maxCoeff());
      e->move(v);
      e->velocities(phi.data());
      rate = equations::larger(rate, phi.cwiseAbs().maxCoeff());
      e->joint_forces(q, v, ydot + mechanism.nq(), nullptr, forces.data());
      e->accelerations(phi.data());
      acceleration = equations::larger(acceleration, phi.cwiseAbs().maxCoeff());
      return true;
    };
    std::vector<double> times;
    for (int i = 1; i <= 50; ++i) times.push_back(0.02 * i);
    const auto run = integrate_bayo_ledesma(*form->dae(), 0, times, options, look);
    ASSERT_TRUE(run.done) << run.reason;
    EXPECT_EQ(run.linear_solver, mechanism.nv() > 20 ? "KLU" : "dense LU");
    EXPECT_LT(position, 1e-11) << scene.name;
    EXPECT_LT(rate, 1e-12) << scene.name;
    EXPECT_LT(acceleration, 1e-10) << scene.name;
    EXPECT_LE(run.counters.newton_iterations, 5 * run.counters.steps) << scene.name;
  }
}

TEST(BayoLedesma, PassesRedundantLoopsAndAnyPenalty) {
  // The motion does not depend on the penalty once the multipliers have settled.
  const Mechanism mechanism(equations::bricard());
  const Start start = equations::start_of(mechanism);
  Eigen::VectorXd before;
  for (const double penalty : {1e4, 1e7, 1e9}) {
    FormOptions settings;
    settings.penalty = penalty;
    const auto form = make_form("acceleration-index3", mechanism, settings, start);
    IntegrationOptions options = tolerance(1e-10);
    options.step = 0.005;
    const auto run = integrate_bayo_ledesma(*form->dae(), 0, {1.0}, options, {});
    ASSERT_TRUE(run.done) << penalty << ": " << run.reason;
    Snapshot end;
    ASSERT_TRUE(form->read(1, run.y.data(), nullptr, end));
    if (before.size() > 0) {
      EXPECT_LT((end.q - before).cwiseAbs().maxCoeff(), 1e-7) << penalty;
    }
    before = end.q;
  }
}

TEST(Rattle, KeepsBothConstraintsEverywhere) {
  const Mechanism planar(equations::example("four_bar"));
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(1.3, Eigen::Vector3d(1, 2, -1).normalized()));
  const Mechanism redundant(turned(equations::example("four_bar"), turn),
                            {.algebra = Algebra::spatial});
  for (const Mechanism* mechanism : {&planar, &redundant}) {
    double error[2];
    for (const int halvings : {0, 1}) {
      const RunResult run = run_form(
          *mechanism, equations::start_of(*mechanism),
          equations::stepped("momentum", "rattle", "none", 0.0101 / (1 << halvings), 5, 77));
      ASSERT_EQ(run.status, "done") << run.reason;
      EXPECT_EQ(run.settings.gauge, "reset");
      ASSERT_EQ(run.series.impulse.size(), 78u);
      EXPECT_LT(run.position_drift_max, 1e-12);
      EXPECT_LT(run.velocity_drift_max, 1e-12);
      EXPECT_LT(*std::max_element(run.series.impulse.begin(), run.series.impulse.end()), 1e-11);
      error[halvings] = run.energy_error_max / run.energy_scale;
    }
    // Of second order: a step half as long leaves a quarter.
    EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.2) << error[0];
    EXPECT_LT(error[1], 1e-3);
  }
}

template <class Scalar>
void expect_same_solutions() {
  // A banded matrix, dense and sparse.
  const int n = 12;
  JacobianPattern dense, band;
  band.column_start.push_back(0);
  for (int column = 0; column < n; ++column) {
    for (int row = std::max(0, column - 2); row < std::min(n, column + 2); ++row)
      band.row.push_back(row);
    band.column_start.push_back(static_cast<long>(band.row.size()));
  }
  const auto a = make_newton_matrix<Scalar>(n, dense), b = make_newton_matrix<Scalar>(n, band);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int round = 0; round < 4; ++round) {
    std::fill_n(a->values(), n * n, Scalar(0));
    for (int column = 0; column < n; ++column)
      for (auto k = band.column_start[static_cast<std::size_t>(column)];
           k < band.column_start[static_cast<std::size_t>(column) + 1]; ++k) {
        Scalar value = any(random);
        if constexpr (!std::is_same_v<Scalar, double>) value += Scalar(0, any(random));
        b->values()[k] = value;
        a->values()[column * n + band.row[static_cast<std::size_t>(k)]] = value;
      }
    ASSERT_TRUE(a->factor());
    ASSERT_TRUE(b->factor());
    std::vector<Scalar> x(n, Scalar(1)), y = x;
    a->solve(x.data());
    b->solve(y.data());
    double size = 0, apart = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      size = std::max(size, std::abs(x[i]));
      apart = equations::larger(apart, std::abs(x[i] - y[i]));
    }
    EXPECT_LT(apart, 1e-10 * size);
  }
  std::fill_n(a->values(), n * n, Scalar(0));
  EXPECT_FALSE(a->factor());
  std::fill_n(b->values(), band.row.size(), Scalar(0));
  EXPECT_FALSE(b->factor());
}

TEST(NewtonMatrix, DenseAndSparseSolveTheSame) {
  expect_same_solutions<double>();
  expect_same_solutions<std::complex<double>>();
}

}  // namespace
}  // namespace momenta::dae_solver_implicit
