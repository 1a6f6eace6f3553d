// Adaptive steps of the momentum form: what their error norm sees, when they handle singularities,
// and that errors follow the tolerance through singular poses.

#include "equations/ensemble.h"
#include "equations/linkages.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/integration.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <filesystem>
#include <random>

namespace momenta::dae_singularity_handling {
namespace {

using Eigen::VectorXd;

std::filesystem::path example(const std::string& name) {
  return std::filesystem::path(MOMENTA_SOURCE_DIR) / "examples" / name / "scene.toml";
}

struct Motion {
  Motion(const std::string& name, const std::string& gauge, const std::string& how = "momentum",
         Algebra algebra = Algebra::automatic)
      : mechanism(read_scene(example(name)), {.algebra = algebra}),
        start(equations::start_of(mechanism)) {
    FormOptions options;
    options.gauge = parse_gauge(gauge);
    options.project = true;
    form = make_form(how, mechanism, options, start);
    y = form->initial(start);
  }
  Mechanism mechanism;
  Start start;
  std::unique_ptr<Form> form;
  std::vector<double> y;
};

TEST(SingularityHandling, ErrorNormDoesNotSeeTheGauge) {
  for (const char* name : {"four_bar", "andrews", "slider_crank"}) {
    Motion m(name, "reset");
    OdeSystem& ode = *m.form->ode();
    std::vector<double> rates(m.y.size());
    ode.begin_step(0, m.y.data());
    ASSERT_TRUE(ode.rhs(0, m.y.data(), rates.data()));
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<double> error(m.y.size());
    for (double& x : error) x = 1e-6 * uniform(random);
    const double before = ode.motion_error_squared(0, m.y.data(), error.data(), 1e-6, 1e-6);
    // e_p + Φ_qᵀ c, as large as e_p is.
    VectorXd c(m.mechanism.m()), shift(m.mechanism.nv());
    for (double& x : c) x = uniform(random);
    const auto e = m.mechanism.evaluation<double>();
    e->place(0, m.y.data());
    e->constraint_forces(c.data(), shift.data());
    shift *= 1e-6 / shift.cwiseAbs().maxCoeff();
    for (int i = 0; i < m.mechanism.nv(); ++i)
      error[static_cast<std::size_t>(m.mechanism.nq() + i)] += shift[i];
    const double after = ode.motion_error_squared(0, m.y.data(), error.data(), 1e-6, 1e-6);
    EXPECT_GT(before, 0);
    EXPECT_NEAR(after / before, 1, 1e-7) << name;
    // What does move is seen.
    for (double& x : error) x *= 2;
    EXPECT_NEAR(ode.motion_error_squared(0, m.y.data(), error.data(), 1e-6, 1e-6) / after, 4,
                1e-12);
  }
}

TEST(SingularityHandling, DerivativeThatComesWithAResetIsF) {
  for (const char* name : {"four_bar", "andrews"}) {
    Motion m(name, "reset");
    OdeSystem& ode = *m.form->ode();
    std::vector<double> taken(m.y.size()), evaluated(m.y.size());
    EXPECT_FALSE(ode.first_derivative(taken.data())) << "before any step";
    // A momentum with a gauge part, off the manifold.
    for (std::size_t i = 0; i < m.y.size(); ++i)
      m.y[i] += 1e-5 * std::sin(static_cast<double>(i + 1));
    bool changed = false;
    ASSERT_TRUE(ode.after_step(0, m.y.data(), changed));
    EXPECT_TRUE(changed);
    ASSERT_TRUE(ode.first_derivative(taken.data()));
    EXPECT_FALSE(ode.first_derivative(taken.data())) << "once";
    ode.begin_step(0, m.y.data());
    ASSERT_TRUE(ode.rhs(0, m.y.data(), evaluated.data()));
    double largest = 0;
    for (double x : evaluated) largest = equations::larger(largest, std::abs(x));
    for (std::size_t i = 0; i < taken.size(); ++i)
      EXPECT_NEAR(taken[i], evaluated[i], 1e-12 * largest) << name << " " << i;
  }
}

TEST(SingularityHandling, GrowsTowardsSingularPoses) {
  Motion m("slider_crank", "reset");
  OdeSystem& ode = *m.form->ode();
  std::vector<double> rates(m.y.size());
  ode.begin_step(0, m.y.data());
  ASSERT_TRUE(ode.rhs(0, m.y.data(), rates.data()));
  EXPECT_EQ(ode.wanted_handling(), SingularityHandling::none);
  Observer observer;
  int measured = 0, corrected = 0, steps = 0;
  observer.step = [&](double, double, const Interpolant&) {
    ++steps;
    measured += ode.wanted_handling() != SingularityHandling::none;
    corrected += ode.wanted_handling() == SingularityHandling::position;
    return true;
  };
  const auto run =
      integrate_explicit("dop853", ode, 0, m.y, {10.0}, {.rtol = 1e-9, .atol = 1e-9}, observer);
  ASSERT_TRUE(run.done) << run.reason;
  EXPECT_GT(corrected, 0);
  EXPECT_GT(measured, corrected);
  EXPECT_LT(measured, steps / 2);
}

TEST(SingularityHandling, ErrorsFollowTheToleranceThroughSingularPoses) {
  // The row of four-bars: motion of one angle, known to ten digits, through flat poses.
  // In both kinds of state.
  for (const char* how : {"momentum", "projected"}) {
    Motion m("n_four_bar", "reset", how);
    const auto end_of = [&](double tolerance, long& evaluations) {
      const auto run = integrate_explicit("dop853", *m.form->ode(), 0, m.y, {10.0},
                                          {.rtol = tolerance, .atol = tolerance}, {});
      EXPECT_TRUE(run.done) << run.reason;
      Snapshot end;
      EXPECT_TRUE(m.form->read(10, run.y.data(), nullptr, end));
      evaluations = run.counters.evaluations;
      return end.q[0];
    };
    long evaluations = 0;
    const double exact = end_of(1e-13, evaluations);
    for (const double around : {1e-7, 1e-9, 1e-11}) {
      double worst = 0;
      for (const double factor : {1.0, 0.6, 0.35, 0.2}) {
        worst = equations::larger(worst, std::abs(end_of(around * factor, evaluations) - exact));
        EXPECT_LT(evaluations, 12'000) << around * factor;  // steps do not collapse
      }
      EXPECT_LT(worst, 2e4 * around) << how << ", " << around;
    }
  }
}

// Five equations a hinge, of which two count: more of them than velocities.
TEST(SingularityHandling, RedundantLoopsInSpace) {
  for (const char* how : {"momentum", "projected"}) {
    double end[2];
    for (const Algebra algebra : {Algebra::planar, Algebra::spatial}) {
      Motion m("n_four_bar", "reset", how, algebra);
      ASSERT_EQ(m.mechanism.m() > m.mechanism.nv(), algebra == Algebra::spatial);
      const auto run = integrate_explicit("dop853", *m.form->ode(), 0, m.y, {2.0},
                                          {.rtol = 1e-8, .atol = 1e-8}, {});
      ASSERT_TRUE(run.done) << run.reason;
      end[algebra == Algebra::spatial] = run.y[0];
    }
    EXPECT_NEAR(end[0], end[1], 1e-6) << how;
  }
}

// Without singular poses errors keep the plain norm, however weak the loops are throughout.
TEST(SingularityHandling, LeavesRegularMotionAlone) {
  for (const char* name : {"andrews", "four_bar"}) {
    Motion m(name, "reset");
    Observer observer;
    observer.step = [&](double, double, const Interpolant&) {
      EXPECT_EQ(m.form->ode()->wanted_handling(), SingularityHandling::none) << name;
      return true;
    };
    const auto run = integrate_explicit("dop853", *m.form->ode(), 0, m.y, {0.03},
                                        {.rtol = 1e-9, .atol = 1e-9}, observer);
    EXPECT_TRUE(run.done) << run.reason;
  }
}

// Between steps too: next to a pose no polynomial over a long step follows the motion.
TEST(SingularityHandling, SamplesFollowTheTolerance) {
  const Mechanism mechanism(read_scene(example("n_four_bar")));
  Reference reference(example("n_four_bar").parent_path() / "reference.csv");
  reference.bind(trajectory_columns(mechanism));
  std::vector<double> errors, energies;
  for (const Start& start : equations::starts_of(mechanism, 4))
    for (const double tolerance : {3.16e-6, 1e-6, 1e-8, 1e-10, 1e-11}) {
      RunRequest request = equations::adaptive("momentum", "vern9", "reset", tolerance, 10, 1);
      request.settings.project = true;
      request.reference = &reference;
      const RunResult looked = run_form(mechanism, start, request);
      ASSERT_EQ(looked.status, "done") << looked.reason;
      errors.push_back(looked.position_error_max / tolerance);
      energies.push_back(looked.energy_error_max / tolerance);
      // Looking on changes nothing.
      request.reference = nullptr;
      const RunResult alone = run_form(mechanism, start, request);
      EXPECT_EQ(alone.series.energy.back(), looked.series.energy.back()) << tolerance;
    }
  // Samples that do not follow the tolerance miss by 1e5 tolerances at the tight end.
  EXPECT_LT(equations::quantile(errors, 0.75), 500);
  EXPECT_LT(equations::quantile(errors, 1), 1e4);
  EXPECT_LT(equations::quantile(energies, 0.75), 1e4);
  EXPECT_LT(equations::quantile(energies, 1), 2e5);
}

}  // namespace
}  // namespace momenta::dae_singularity_handling
