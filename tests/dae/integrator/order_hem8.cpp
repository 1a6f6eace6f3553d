// hem8: a step against its equations as they stand, with dense matrices; order 8 in q, u, p and in
// the multiplier by halved steps; the same motion in every gauge; the constraint at rounding;
// redundant loops and singular poses at the steps of the ODE form; rows of rates.

#include "equations/ensemble.h"
#include "equations/half_explicit.h"
#include "equations/kkt_blocks.h"
#include "equations/linkages.h"
#include "equations/refusal.h"
#include "equations/rolling.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/integrator/tableau_dop853.h>
#include <momenta/dae/run/run_form.h>

#include <Eigen/LU>

namespace momenta::dae_order_hem8 {
namespace {

using namespace equations;
using explicit_rk::TableauDop853;

/// The slow twin: (7), (8) or (3) and the corrections by full pivoting, every sum written out.
class SlowStep {
 public:
  SlowStep(const Mechanism& mechanism, bool momenta)
      : e_(mechanism.evaluation<double>()),
        of_(mechanism),
        momenta_(momenta),
        nq_(mechanism.nq()),
        nv_(mechanism.nv()),
        m_(mechanism.m()) {}

  Eigen::VectorXd operator()(double t, double h, const Eigen::VectorXd& y0) {
    constexpr int s = TableauDop853::stages;
    std::vector<Eigen::VectorXd> k;
    for (int i = 0; i <= s; ++i) {
      const auto row = static_cast<std::size_t>(i);
      Eigen::VectorXd y = y0;
      for (std::size_t j = 0; j < row; ++j) y += h * TableauDop853::a[row][j] * k[j];
      if (i == s) return met(t + h, y);
      k.push_back(rate(t + TableauDop853::c[row] * h, y));
    }
    return y0;
  }

 private:
  /// (x, s) of M x + Φ_qᵀ s = r, Φ_q x = g where e_ is.
  Eigen::VectorXd solved(const Eigen::VectorXd& r, const Eigen::VectorXd& g) {
    const KktBlocks blocks(of_, *e_);
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(nv_ + m_, nv_ + m_);
    matrix.topLeftCorner(nv_, nv_) = blocks.M;
    matrix.topRightCorner(nv_, m_) = blocks.J.transpose();
    matrix.bottomLeftCorner(m_, nv_) = blocks.J;
    Eigen::VectorXd right(nv_ + m_);
    right << r, g;
    return matrix.fullPivLu().solve(right);
  }
  Eigen::VectorXd prescribed_rates() {
    Eigen::VectorXd rate(m_);
    e_->move(nullptr);
    e_->velocities(rate.data());
    return rate;
  }
  Eigen::VectorXd rate(double t, const Eigen::VectorXd& y) {
    Eigen::VectorXd f(nq_ + nv_), u(nv_), r(nv_), g(m_);
    e_->place(t, y.data());
    if (momenta_) {
      g = prescribed_rates();
      e_->momenta(nullptr, r.data());
      const Eigen::VectorXd x = solved(y.tail(nv_) - r, -g);
      u = x.head(nv_);
      const Eigen::VectorXd sigma = x.tail(m_);
      e_->move(u.data());
      e_->momenta(sigma.data(), r.data());
      e_->momentum_rates(y.data(), u.data(), sigma.data(), 0, f.data() + nq_);
    } else {
      u = y.tail(nv_);
      e_->move(u.data());
      e_->joint_forces(y.data(), u.data(), nullptr, nullptr, r.data());
      e_->accelerations(g.data());
      f.tail(nv_) = solved(-r, -g).head(nv_);
    }
    e_->coordinate_rates(y.data(), u.data(), f.data());
    return f;
  }
  Eigen::VectorXd met(double t, Eigen::VectorXd y) {
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(nv_);
    for (int count = 0; count < (momenta_ ? 20 : 1); ++count) {
      e_->place(t, y.data());
      if (!momenta_) {
        const Eigen::VectorXd v = y.tail(nv_);
        y.tail(nv_) = solved(KktBlocks(of_, *e_).M * v, -prescribed_rates()).head(nv_);
        break;
      }
      Eigen::VectorXd g(m_), change(nq_);
      e_->positions(g.data());
      const Eigen::VectorXd x = solved(zero, -g);
      e_->coordinate_rates(y.data(), x.data(), change.data());
      y.head(nq_) += change;
    }
    return y;
  }

  std::unique_ptr<Evaluation<double>> e_;
  const Mechanism& of_;
  bool momenta_;
  Eigen::Index nq_, nv_, m_;
};

/// One equation of rates and no other.
Scene blade() {
  return sleigh(0.3, "[0.4, -2, 0]", "[1, 0, 0.8]");
}
/// A contact, of positions, and two equations of rates beside it.
Scene rolling() {
  return parse_scene(wheel("[0, 0, -9.81]", 0.3, 0.05,
                           "position = [0, 0, 0.35, 0.98, 0.1989974874213240, 0, 0]\n"
                           "velocity = [1, 0, 0, 0.3, 2, 0.5]"),
                     "rolling.toml");
}

TEST(Hem8, AStepIsThatOfItsEquations) {
  for (const auto& [scene, h] :
       {std::pair{example_of("four_bar"), 0.05}, std::pair{example_of("andrews"), 5e-4},
        std::pair{example_of("driven"), 0.05}, std::pair{flying_rod(), 0.05},
        std::pair{blade(), 0.05}, std::pair{rolling(), 0.05}})
    for (const std::string form : {"acceleration-index2", "momentum-index2"}) {
      SCOPED_TRACE(scene.name + " " + form);
      const Mechanism mechanism(scene);
      const Start start = equations::start_of(mechanism);
      FormOptions options;
      options.gauge = parse_gauge("none");
      const auto dae = make_form(form, mechanism, options, start);
      const auto size = static_cast<std::size_t>(dae->dae()->size());
      std::vector<double> y(size), ydot(size);
      ASSERT_TRUE(dae->dae()->start(0, y.data(), ydot.data()));
      IntegrationOptions fixed;
      fixed.step = h;
      const auto run = integrate("hem8", *dae->dae(), 0, {h}, fixed, {});
      ASSERT_TRUE(run.done) << run.reason;
      const Eigen::Index nq = mechanism.nq(), n = nq + mechanism.nv();
      Eigen::VectorXd slow = SlowStep(mechanism, form == "momentum-index2")(
          0, h, Eigen::Map<const Eigen::VectorXd>(y.data(), n));
      if (mechanism.plan().quasi_velocities)
        for (const auto& b : mechanism.tree().bodies)
          if (b.nq >= 4) slow.segment(b.q + b.nq - 4, 4).normalize();
      const double size_of_p = std::max(1.0, slow.tail(n - nq).cwiseAbs().maxCoeff());
      for (Eigen::Index i = 0; i < n; ++i)
        EXPECT_NEAR(run.y[static_cast<std::size_t>(i)], slow[i], 2e-12 * (i < nq ? 1 : size_of_p))
            << i;
    }
}

// From steps short enough for the order to show to steps that leave rounding or somewhat more. The
// driven crank leaves no freedom: with Φ = 0 its q is exact.
TEST(Hem8, OrderEightByShorterSteps) {
  struct Case {
    Scene scene;
    double end;
    int coarse, shorter;
  };
  for (const Case& c :
       {Case{example_of("four_bar"), 1, 48, 4}, Case{example_of("andrews"), 0.01, 24, 2},
        Case{driven_crank(), 1, 16, 2}, Case{flying_rod(), 1, 48, 4}, Case{blade(), 1, 4, 2},
        Case{rolling(), 0.5, 20, 4}})
    for (const std::string form : {"acceleration-index2", "momentum-index2"}) {
      SCOPED_TRACE(c.scene.name + " " + form);
      const Halving halving("hem8", c.scene, form, c.end, "leak", "vern9");
      const Errors a = halving.with(c.coarse), b = halving.with(c.shorter * c.coarse);
      const auto expect_eight = [&](const char* what, double coarse, double fine) {
        constexpr double rounding = 1e-14;
        const double order = std::log(coarse / fine) / std::log(c.shorter);
        EXPECT_LT(fine, coarse * std::pow(c.shorter, -7.2) + rounding) << what << ": " << coarse;
        EXPECT_LT(order, 9.2) << what << ": " << coarse << ", " << fine;
      };
      if (a.q > 1e-14) expect_eight("q", a.q, b.q);
      expect_eight("u or p", a.x, b.x);
      expect_eight("multiplier", a.multiplier, b.multiplier);
    }
}

// The end a third into the last step: there the order is 7, of dense output, and that of a step's
// errors added up.
TEST(Hem8, OrderOfDenseOutput) {
  for (const std::string form : {"acceleration-index2", "momentum-index2"}) {
    SCOPED_TRACE(form);
    const Halving halving("hem8", example_of("four_bar"), form, 1, "leak", "vern9");
    const Errors a = halving.with(30, 1.0 / 3), b = halving.with(60, 1.0 / 3);
    for (const auto& [coarse, fine] :
         {std::pair{a.q, b.q}, std::pair{a.x, b.x}, std::pair{a.multiplier, b.multiplier}})
      EXPECT_GT(std::log2(coarse / fine), 6.5) << coarse << ", " << fine;
  }
}

TEST(Hem8, TheSameMotionInEveryGauge) {
  expect_the_same_motion_in_every_gauge("hem8", 0.02);
}

RunResult run_hem8(const Mechanism& mechanism, const std::string& form, const std::string& gauge,
                   double tolerance, double end, int samples) {
  return run_form(
      mechanism, equations::start_of(mechanism),
      equations::kept(equations::adaptive(form, "hem8", form == "momentum-index2" ? gauge : "",
                                          tolerance, end, samples)));
}

// The constraint that stands in the equations, at every sample inside steps too and at a loose
// tolerance; the other one drifts with the local error. Looking on changes nothing.
TEST(Hem8, KeepsItsConstraint) {
  const Mechanism mechanism(example_of("four_bar"));
  const RunResult p = run_hem8(mechanism, "momentum-index2", "reset", 1e-4, 5, 500);
  ASSERT_EQ(p.status, "done") << p.reason;
  EXPECT_LE(p.position_drift_max, 5e-14);
  const RunResult u = run_hem8(mechanism, "acceleration-index2", "", 1e-4, 5, 500);
  ASSERT_EQ(u.status, "done") << u.reason;
  EXPECT_LE(u.velocity_drift_max, 1e-13);
  EXPECT_GE(u.position_drift_max, 1e-10);
  const RunResult few = run_hem8(mechanism, "momentum-index2", "reset", 1e-4, 5, 1);
  EXPECT_EQ(few.counters.steps, p.counters.steps);
  EXPECT_EQ(few.trajectory.rows.back(), p.trajectory.rows.back());
}

// Redundant equations fade, as in the ODE form: no more steps than it takes, at any tolerance.
TEST(Hem8, RedundantEquationsCostNoSteps) {
  const Mechanism mechanism(example_of("bricard"));
  for (const double tolerance : {1e-5, 1e-8, 1e-11}) {
    SCOPED_TRACE(tolerance);
    const RunResult ode = run_of(mechanism, "momentum", "dop853", "reset", tolerance, 5);
    ASSERT_EQ(ode.status, "done") << ode.reason;
    for (const char* gauge : {"leak", "reset"}) {
      const RunResult dae = run_hem8(mechanism, "momentum-index2", gauge, tolerance, 5, 20);
      ASSERT_EQ(dae.status, "done") << gauge << dae.reason;
      EXPECT_LE(dae.position_drift_max, 1e-13) << gauge;
      EXPECT_LE(static_cast<double>(dae.counters.steps),
                1.3 * static_cast<double>(ode.counters.steps))
          << gauge;
    }
  }
}

// A stage on a singular pose: its weak row says nothing and keeps the multiplier that it is given,
// for every stage that of the step's start. With that of the stage before the step is another one.
TEST(Hem8, StagesFadeToTheMultiplierOfTheStart) {
  constexpr double h = 0.02;
  constexpr std::size_t s = TableauDop853::stages, on_the_pose = 7;
  // The angle from which that stage's is zero, to O(h³): rods of a row turn by -1 rad/s.
  constexpr double until = h * TableauDop853::c[on_the_pose];
  double angle = until;
  for (int count = 0; count < 3; ++count) {
    const Start start = equations::start_of(Mechanism(row_of_four_bars(1, angle, -1)));
    angle = until - 0.5 * start.udot[0] * until * until;
  }
  const Mechanism mechanism(row_of_four_bars(1, angle, -1));
  const Start start = equations::start_of(mechanism);
  FormOptions options;
  options.gauge = parse_gauge("none");
  const auto form = make_form("momentum-index2", mechanism, options, start);
  const auto n = static_cast<std::size_t>(mechanism.nq() + mechanism.nv()),
             nq = static_cast<std::size_t>(mechanism.nq());
  std::vector<double> y(static_cast<std::size_t>(form->dae()->size())), ydot(y.size());
  ASSERT_TRUE(form->dae()->start(0, y.data(), ydot.data()));
  auto& parts = dynamic_cast<HalfExplicit&>(*form->dae());
  ASSERT_TRUE(parts.consistent(0, y.data(), y.data() + n, ydot.data()));
  const auto step = [&](bool from_the_stage_before) {
    std::vector<std::vector<double>> k{{ydot.begin(), ydot.begin() + static_cast<long>(n)}};
    std::vector<double> stage, z(y.begin() + static_cast<long>(n), y.end());
    for (std::size_t i = 1;; ++i) {
      stage.assign(y.begin(), y.begin() + static_cast<long>(n));
      for (std::size_t j = 0; j < i; ++j)
        for (std::size_t at = 0; at < n; ++at) stage[at] += h * TableauDop853::a[i][j] * k[j][at];
      if (i == s) return stage;
      if (!from_the_stage_before) z.assign(y.begin() + static_cast<long>(n), y.end());
      k.emplace_back(n);
      EXPECT_TRUE(
          parts.consistent(TableauDop853::c[i] * h, stage.data(), z.data(), k.back().data()));
      EXPECT_EQ(parts.pivots().faded, i == on_the_pose ? 1 : 0) << i;
    }
  };
  const auto same = step(false), other = step(true);
  IntegrationOptions fixed;
  fixed.step = h;
  const auto run = integrate("hem8", *form->dae(), 0, {h}, fixed, {});
  ASSERT_TRUE(run.done) << run.reason;
  double apart = 0;
  // q goes onto Φ = 0 yet. A pivot near what is lost to fading, 1e-8, divides rounding of the
  // stage.
  for (std::size_t i = nq; i < n; ++i) {
    EXPECT_NEAR(run.y[i], same[i], 1e-9) << i;
    apart = equations::larger(apart, std::abs(other[i] - same[i]));
  }
  EXPECT_GT(apart, 1e-5) << apart;
}

// Near singular poses σ asks for steps that the motion does not need: errors are those of the
// motion there, and index 2 takes the steps of the ODE form and of accelerations. That form is
// projected, as the example asks: a row of equal loops leaves its branch at a singular pose where
// Φ is open by rounding alone, and a quarter of all starts moved by last places would not come
// through.
TEST(Hem8, SingularPosesCostNoSteps) {
  const Mechanism mechanism(example_of("n_four_bar"));
  double ode = 0, accelerations = 0, leak = 0, reset = 0;  // steps tried, at three tolerances
  for (const double tolerance : {1e-6, 1e-7, 1e-8}) {
    const auto tried = [](const RunResult& run) {
      EXPECT_EQ(run.status, "done") << run.reason;
      return static_cast<double>(run.counters.steps + run.counters.rejected);
    };
    RunRequest projected = equations::adaptive("momentum", "dop853", "reset", tolerance, 10);
    projected.settings.project = true;
    ode += tried(run_form(mechanism, start_of(mechanism), projected));
    accelerations += tried(run_hem8(mechanism, "acceleration-index2", "", tolerance, 10, 1));
    leak += tried(run_hem8(mechanism, "momentum-index2", "leak", tolerance, 10, 1));
    reset += tried(run_hem8(mechanism, "momentum-index2", "reset", tolerance, 10, 1));
  }
  for (const double momenta : {leak, reset}) {
    EXPECT_LE(momenta, 1.3 * ode);
    EXPECT_LE(momenta, 1.1 * accelerations);
  }
}

// Where stages close Φ = 0 over a part of the step, as those of hem5 do, the rounding of Φ over it
// times the heavy mass stops the run (examples/extremes).
TEST(Hem8, HeavyCouplersDoNotStopIt) {
  for (const double factor : {1e9, 1e12}) {
    SCOPED_TRACE(factor);
    Scene scene = example_of("four_bar");
    for (auto& b : scene.bodies)
      if (b.name == "coupler") b.mass *= factor, b.inertia *= factor;
    const Mechanism mechanism(scene);
    const RunResult dae = run_hem8(mechanism, "momentum-index2", "reset", 1e-8, 3, 20),
                    ode = run_of(mechanism, "momentum", "dop853", "reset", 1e-10, 3);
    ASSERT_EQ(dae.status, "done") << dae.reason;
    ASSERT_EQ(ode.status, "done") << ode.reason;
    EXPECT_LE(dae.position_drift_max, 1e-13);
    const auto &end = dae.trajectory.rows.back(), &known = ode.trajectory.rows.back();
    ASSERT_EQ(dae.trajectory.columns[1], ode.trajectory.columns[1]);
    for (std::size_t i = 0; i <= static_cast<std::size_t>(mechanism.nq()); ++i)
      EXPECT_NEAR(end[i], known[i], 1e-5) << dae.trajectory.columns[i];
  }
}

TEST(Hem8, RefusesOtherForms) {
  const Mechanism mechanism(example_of("four_bar"));
  for (const char* form : {"acceleration-index3", "momentum-index1", "stabilised-index2"})
    EXPECT_TRUE(equations::says(equations::thrown<std::invalid_argument>(
                                    [&] { run_hem8(mechanism, form, "", 1e-7, 1, 1); }),
                                "acceleration-index2 or momentum-index2"))
        << form;
}

}  // namespace
}  // namespace momenta::dae_order_hem8
