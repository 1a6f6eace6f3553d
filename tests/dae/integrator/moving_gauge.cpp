// bdf5 and its moving gauge: the polynomials through past values, every order from 1 to 5 on steps
// of changing length, the same motion in whatever gauge the past is told, what no leak allows.

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/refusal.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/bdf_step.h>
#include <momenta/dae/run/run_form.h>

#include <cmath>
#include <numbers>
#include <random>

namespace momenta::dae_moving_gauge {
namespace {

using namespace equations;
using equations::example;

// ω through values of a polynomial is it, with its rate, and its highest difference is its leading
// coefficient.
TEST(PastValues, PolynomialsAreMet) {
  const auto cubic = [](double t) { return 2 + t * (-1 + t * (0.5 + 3 * t)); };
  const auto slope = [](double t) { return -1 + t * (1 + 9 * t); };
  PastValues past(1, nullptr);
  double y = cubic(0.1);
  past.begin(0.1, &y);
  for (const double t : {0.4, 0.55, 1.0, 1.2}) y = cubic(t), past.add(t, &y);
  double value = 0, rate = 0, difference = 0;
  for (const double t : {1.7, 1.1, 1.0}) {
    past.interpolate(t, 3, &value, &rate);
    EXPECT_NEAR(value, cubic(t), 1e-12) << t;
    EXPECT_NEAR(rate, slope(t), 1e-11) << t;
  }
  y = cubic(1.5);
  past.difference(1.5, &y, 3, &difference);
  EXPECT_NEAR(difference, 3, 1e-11);
  past.difference(1.5, &y, 4, &difference);
  EXPECT_NEAR(difference, 0, 1e-10);
}

/// A form, and states of its exact motion without a gauge, by dop853 at 1e-14.
class Motion {
 public:
  Motion(const Scene& scene, std::string form, const char* gauge)
      : mechanism_(scene), start_(equations::start_of(mechanism_)), name_(std::move(form)) {
    options_.gauge = parse_gauge(gauge);
    impulses_ = name_.rfind("momentum", 0) == 0;
  }
  std::unique_ptr<Form> form() const { return make_form(name_, mechanism_, options_, start_); }
  /// y = (q, x, s) of the form at these times.
  std::vector<std::vector<double>> at(const std::vector<double>& times) const {
    const auto ode = make_form(impulses_ ? "momentum" : "acceleration", mechanism_, {}, start_);
    IntegrationOptions tight;
    tight.rtol = tight.atol = 1e-14;
    std::vector<std::vector<double>> states;
    Observer observer;
    observer.sample = [&](double t, const double* y, const double*) {
      Snapshot read;
      EXPECT_TRUE(ode->read(t, y, nullptr, read));
      states.emplace_back(y, y + ode->ode()->size());
      for (const double s : read.multipliers) states.back().push_back(s);
      return true;
    };
    // No dense output: each time is the end of a run.
    std::vector<double> y = ode->initial(start_);
    double t = 0;
    for (const double next : times) {
      const auto run = integrate_explicit("dop853", *ode->ode(), t, y, {next}, tight, observer);
      EXPECT_TRUE(run.done) << run.reason;
      t = next, y = run.y;
    }
    return states;
  }
  const Mechanism& mechanism() const { return mechanism_; }

 private:
  Mechanism mechanism_;
  Start start_;
  std::string name_;
  FormOptions options_;
  bool impulses_ = false;
};

/// Ends of steps whose lengths change by up to two thirds from one to the next, and on average are
/// `h`.
std::vector<double> ends_of_steps(int count, double h) {
  constexpr std::array<double, 4> lengths{1.25, 0.75, 0.9, 1.1};
  std::vector<double> ends{0.0};
  for (int i = 0; i < count; ++i)
    ends.push_back(ends.back() + h * lengths[static_cast<std::size_t>(i) % 4]);
  return ends;
}

/// Largest error of q at the end of steps by one order, from exact values.
double error_of(const Motion& motion, int order, int count, double end) {
  const auto form = motion.form();
  DaeSystem& system = *form->dae();
  std::vector<double> y(static_cast<std::size_t>(system.size())), ydot(y.size());
  EXPECT_TRUE(system.start(0, y.data(), ydot.data()));
  const std::vector<double> ends = ends_of_steps(count, end / count);
  const auto exact = motion.at({ends.begin() + 1, ends.end()});
  BdfStep step(system, 1e-12, 1e-12);
  // begin() would put a value before the start in place of y'.
  step.past().begin(0, y.data());
  const auto began = static_cast<std::size_t>(order);
  for (std::size_t i = 1; i <= began; ++i) step.past().add(ends[i], exact[i - 1].data());
  for (std::size_t i = began + 1; i < ends.size(); ++i) {
    EXPECT_EQ(step.attempt(ends[i], order, true, {}), BdfStep::Outcome::solved) << i;
    step.accept();
  }
  double error = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(motion.mechanism().nq()); ++i)
    error = equations::larger(error, std::abs(step.y()[i] - exact.back()[i]));
  return error;
}

TEST(Bdf5, EveryOrderOnStepsOfChangingLength) {
  const struct {
    const char *form, *gauge;
  } cases[] = {{"momentum-index2", "reset"},
               {"momentum-index2", "none"},
               {"momentum-index1", "reset"},
               {"acceleration-index2", "none"}};
  for (const auto& c : cases) {
    SCOPED_TRACE(std::string(c.form) + " " + c.gauge);
    const Motion motion(example("four_bar"), c.form, c.gauge);
    for (int order = 1; order <= BdfStep::highest_order; ++order) {
      const int coarse = order == 1 ? 400 : 120;
      const double a = error_of(motion, order, coarse, 0.6),
                   b = error_of(motion, order, 2 * coarse, 0.6);
      EXPECT_NEAR(std::log2(a / b), order, 0.35) << order << ": " << a << ", " << b;
    }
  }
}

// The past told in another gauge before each step, by whatever constant, is the same past.
TEST(Bdf5, TheSameMotionInEveryGauge) {
  for (const char* form : {"momentum-index2", "momentum-stabilised", "momentum-index1"}) {
    SCOPED_TRACE(form);
    const Motion motion(example("four_bar"), form, "reset");
    const auto run = [&](double size) {
      const auto made = motion.form();
      DaeSystem& system = *made->dae();
      std::vector<double> y(static_cast<std::size_t>(system.size())), ydot(y.size());
      EXPECT_TRUE(system.start(0, y.data(), ydot.data()));
      BdfStep step(system, 1e-8, 1e-8);
      step.begin(0, y.data(), ydot.data());
      std::mt19937 chance(7);
      std::uniform_real_distribution<double> any(-size, size);
      std::vector<double> c(static_cast<std::size_t>(motion.mechanism().m()));
      const std::vector<double> ends = ends_of_steps(150, 0.005);
      for (std::size_t i = 1; i < ends.size(); ++i) {
        for (double& x : c) x = any(chance);
        step.past().shift(c.data());
        const int order = std::min<int>(static_cast<int>(i), 4);
        EXPECT_EQ(step.attempt(ends[i], order, i % 3 == 1, {}), BdfStep::Outcome::solved) << i;
        step.accept();
      }
      return step.y();
    };
    // Impulses of the loop over a tenth of a second are as large.
    const auto still = run(0), moved = run(10);
    for (std::size_t i = 0; i < static_cast<std::size_t>(motion.mechanism().nq()); ++i)
      EXPECT_NEAR(still[i], moved[i], 1e-11) << i;
  }
}

// With a reset the newest σ is zero before each step, and so at its end what λ makes of one step;
// without, ∫λ dt.
TEST(Bdf5, ImpulsesAreThoseOfOneStep) {
  for (const char* form : {"momentum-index2", "momentum-stabilised", "momentum-index1"}) {
    SCOPED_TRACE(form);
    constexpr double h = 0.005;
    const auto largest = [&](const char* gauge) {
      const Motion motion(example("four_bar"), form, gauge);
      const auto made = motion.form();
      DaeSystem& system = *made->dae();
      const auto& symmetry = dynamic_cast<const GaugeSymmetry&>(system);
      std::vector<double> y(static_cast<std::size_t>(system.size())), ydot(y.size());
      EXPECT_TRUE(system.start(0, y.data(), ydot.data()));
      BdfStep step(system, 1e-8, 1e-8);
      step.begin(0, y.data(), ydot.data());
      double impulse = 0;
      const std::vector<double> ends = ends_of_steps(200, h);
      for (std::size_t i = 1; i < ends.size(); ++i) {
        EXPECT_EQ(step.attempt(ends[i], std::min<int>(static_cast<int>(i), 3), true, {}),
                  BdfStep::Outcome::solved)
            << i;
        step.accept();
        const double* sigma = symmetry.impulses(step.y().data());
        for (int k = 0; k < symmetry.impulse_count(); ++k)
          impulse = std::max(impulse, std::abs(sigma[k]));
      }
      return impulse;
    };
    // λ has a mean under gravity: 200 steps without a reset add up.
    EXPECT_LT(largest("reset"), 0.1 * largest("none"));
  }
}

RunResult run(const Mechanism& mechanism, const std::string& form, const std::string& gauge,
              double tolerance, double end, int samples = 20) {
  return run_form(
      mechanism, equations::start_of(mechanism),
      equations::kept(equations::adaptive(form, "bdf5", gauge, tolerance, end, samples)));
}

// Where IDA with a leak ends at 3e-12: rounding of Φ over the step is an impulse, and no shorter
// step lessens what it does to p. What it does to the motion is nothing.
TEST(Bdf5, AndrewsAtTheTightestTolerance) {
  const Mechanism mechanism(example("andrews"));
  const RunResult r = run(mechanism, "momentum-index2", "reset", 1e-12, 0.03);
  ASSERT_EQ(r.status, "done") << r.reason;
  EXPECT_LT(r.energy_error_max, 1e-8);
  EXPECT_LT(r.position_drift_max, 1e-12);
}

// Looking on changes nothing, restarts behind singular poses included.
TEST(Bdf5, SamplesDoNotChangeTheRun) {
  const Mechanism mechanism(row_of_four_bars(2, std::numbers::pi / 2, -1));
  const RunResult few = run(mechanism, "momentum-index2", "reset", 1e-7, 3, 1),
                  many = run(mechanism, "momentum-index2", "reset", 1e-7, 3, 100);
  ASSERT_EQ(few.status, "done") << few.reason;
  EXPECT_GT(few.counters.ode_restarts, 0);
  EXPECT_EQ(few.counters.steps, many.counters.steps);
  EXPECT_EQ(few.trajectory.rows.back(), many.trajectory.rows.back());
}

// Dense, sparse and with redundant equations; Φ at Newton's tolerance at the ends, of the order of
// the tolerance inside steps.
TEST(Bdf5, EveryMatrixAndForm) {
  const Mechanism plain(example("four_bar")), redundant(bricard()),
      many(row_of_four_bars(12, 1, 0.5));
  for (const char* form : {"momentum-index2", "momentum-stabilised", "momentum-index1",
                           "acceleration-index2", "stabilised-index2", "acceleration-index1"}) {
    const std::string gauge = form[0] == 'm' ? "reset" : "";
    const RunResult a = run(plain, form, gauge, 1e-8, 2),
                    b = run(redundant, form, gauge, 1e-9, 0.5),
                    c = run(many, form, gauge, 1e-8, 0.3);
    for (const RunResult* r : {&a, &b, &c}) {
      ASSERT_EQ(r->status, "done") << form << r->reason;
      EXPECT_LT(r->energy_error_max, 1e-4) << form;
      EXPECT_LT(r->position_drift_max, 1e-5) << form;
    }
  }
}

// Redundant rows are softened about the multipliers of the start, so that it is consistent: without
// that a row is off by ε σ₀, and a step of h answers by u ~ ε σ₀/h.
TEST(DaeForms, SoftenedRowsHoldAtTheStart) {
  Scene scene = example("models/agility_cassie/cassie.xml");
  double rate = -0.5;
  for (JointSpec& joint : scene.joints)
    if (joint.kind == JointKind::revolute) joint.velocity = {rate = -rate};
  const Mechanism mechanism(scene);
  const Start start = equations::start_of(mechanism);
  for (const char* name : {"momentum-index2", "momentum-index1", "acceleration-index2"}) {
    FormOptions options;
    options.gauge = parse_gauge("leak");
    const auto form = make_form(name, mechanism, options, start);
    DaeSystem& dae = *form->dae();
    std::vector<double> y(static_cast<std::size_t>(dae.size())), ydot(y.size()), r(y.size());
    ASSERT_TRUE(dae.start(0, y.data(), ydot.data()));
    ASSERT_TRUE(dae.residual(0, y.data(), ydot.data(), r.data()));
    for (std::size_t i = r.size() - static_cast<std::size_t>(mechanism.m()); i < r.size(); ++i)
      EXPECT_LT(std::abs(r[i]), 1e-13) << name;
  }
  RunRequest request = equations::adaptive("momentum-index2", "bdf5", "none", 1e-10, 0.01);
  request.max_cpu_seconds = 200;
  const RunResult run = run_form(mechanism, start, request);
  EXPECT_EQ(run.status, "done") << run.reason;
}

TEST(Bdf5, GaugesThatAMethodCannotTake) {
  const Mechanism mechanism(example("four_bar"));
  const auto refusal = [&](const std::string& integrator, const std::string& gauge) {
    RunRequest request = equations::adaptive("momentum-index2", integrator, gauge, 1e-8, 1, 1);
    return equations::thrown<std::invalid_argument>(
        [&] { run_form(mechanism, equations::start_of(mechanism), request); });
  };
  EXPECT_NE(refusal("ida", "reset").find("expected integrator bdf5, radau5, hem5 or hem8"),
            std::string::npos)
      << refusal("ida", "reset");
  EXPECT_NE(refusal("bdf5", "flip").find("expected none, leak or reset"), std::string::npos);
}

}  // namespace
}  // namespace momenta::dae_moving_gauge
