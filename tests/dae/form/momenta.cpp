// Laws of (7)-(8) along motions: the gauge moves nothing, λ = σ̇ + κσ, energy changes by the power
// of what the energy does not hold.

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/kkt/kkt.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/topology/assembly/assembly.h>

namespace momenta::dae_momenta {
namespace {

using namespace equations;
using Eigen::VectorXd;
using equations::example;

/// The momentum form of a mechanism, with states written and read as q, p.
struct Moving {
  Mechanism mechanism;
  Assembly assembly;
  std::unique_ptr<Form> form;
  explicit Moving(Scene scene, const std::string& gauge = "none", double step_from_rest = 0)
      : mechanism(std::move(scene)), assembly(assemble(mechanism)) {
    FormOptions options;
    options.gauge = parse_gauge(gauge);
    form = make_form("momentum", mechanism, options, assembly.start);
    y = form->initial(assembly.start);
    if (step_from_rest > 0) advance(0, step_from_rest);
  }
  void advance(double t0, double t1) {
    const auto run =
        integrate_explicit("dop853", *form->ode(), t0, y, {t1}, {.rtol = 1e-12, .atol = 1e-12}, {});
    ASSERT_TRUE(run.done) << run.reason;
    y = run.y;
  }
  Snapshot now(double t = 0) {
    Snapshot s;
    EXPECT_TRUE(form->read(t, y.data(), nullptr, s));
    return s;
  }
  std::vector<double> rates(double t = 0) {
    std::vector<double> ydot(y.size());
    EXPECT_TRUE(form->ode()->rhs(t, y.data(), ydot.data()));
    return ydot;
  }
  std::vector<double> y;
};

TEST(Gauge, ShiftsMomentaAndImpulsesAndNothingElse) {
  for (const auto& name : {"four_bar", "andrews"}) {
    Moving motion(example(name), "none", std::string(name) == "andrews" ? 0.01 : 1);
    const Snapshot before = motion.now();
    const auto rates = motion.rates();
    const VectorXd c = VectorXd::LinSpaced(motion.mechanism.m(), 1, -2) *
                       std::max(1.0, before.multipliers.cwiseAbs().maxCoeff());
    const auto e = motion.mechanism.evaluation<double>();
    VectorXd load(motion.mechanism.nv());
    e->place(0, before.q.data());
    e->constraint_forces(c.data(), load.data());
    for (Eigen::Index i = 0; i < load.size(); ++i)
      motion.y[static_cast<std::size_t>(before.q.size() + i)] += load[i];
    const Snapshot after = motion.now();
    EXPECT_LT(relative_error(after.u, before.u, before.u.cwiseAbs().maxCoeff()), 1e-12) << name;
    EXPECT_LT(relative_error(after.multipliers, VectorXd(before.multipliers + c)), 1e-11) << name;
    // ṗ changes by d/dt (Φ_qᵀ) c: here as a difference along the motion.
    const auto shifted = motion.rates();
    const double h = std::string(name) == "andrews" ? 1e-7 : 3e-5;
    VectorXd ahead(load.size()), behind(load.size());
    for (const double sign : {1.0, -1.0}) {
      const VectorXd q = before.q + sign * h * before.u;  // one-dof joints: q̇ = u
      e->place(0, q.data());
      e->constraint_forces(c.data(), (sign > 0 ? ahead : behind).data());
    }
    const VectorXd expected = (ahead - behind) / (2 * h);
    VectorXd found(load.size());
    for (Eigen::Index i = 0; i < load.size(); ++i) {
      const auto at = static_cast<std::size_t>(before.q.size() + i);
      found[i] = shifted[at] - rates[at];
    }
    EXPECT_LT(relative_error(found, expected, expected.cwiseAbs().maxCoeff()), 1e-7) << name;
  }
}

TEST(Gauge, LeavesTheMotionAlone) {
  VectorXd q;
  for (const auto& gauge : {"none", "leak:0.7", "leak:9", "reset"}) {
    const VectorXd end = Moving(example("four_bar"), gauge, 3).now(3).q;
    if (q.size() == 0) q = end;
    EXPECT_LT(relative_error(end, q), 1e-8) << gauge;  // 1e-12 of the steps grows over 3 s
  }
}

TEST(Multipliers, ForceIsRateOfImpulsePlusLeak) {
  for (const auto& [name, leak, t, h] :
       {std::tuple{"four_bar", 0.0, 1.0, 2e-3}, std::tuple{"four_bar", 3.0, 1.0, 2e-3},
        std::tuple{"slider_crank", 2.0, 0.5, 1e-3}, std::tuple{"andrews", 500.0, 0.01, 2e-6}}) {
    Moving motion(example(name), leak > 0 ? "leak:" + std::to_string(leak) : "none", t - 2 * h);
    std::vector<VectorXd> sigma;
    Snapshot middle;
    for (int i = 0; i < 5; ++i) {
      const double at = t + (i - 2) * h;
      if (i > 0) motion.advance(at - h, at);
      const Snapshot s = motion.now(at);
      sigma.push_back(s.multipliers);
      if (i == 2) middle = s;
    }
    const VectorXd rate = (8 * (sigma[3] - sigma[1]) - (sigma[4] - sigma[0])) / (12 * h);
    const auto e = motion.mechanism.evaluation<double>();
    const auto kkt = make_kkt(motion.mechanism);
    VectorXd r(motion.mechanism.nv()), g(motion.mechanism.m()), udot(r.size()), lambda(g.size());
    ASSERT_TRUE(kkt->factor(*e, t, middle.q.data(), fade_evaluation));
    e->move(middle.u.data());
    e->joint_forces(middle.q.data(), middle.u.data(), nullptr, nullptr, r.data());
    e->accelerations(g.data());
    r = -r;
    g = -g;
    ASSERT_TRUE(kkt->solve(r.data(), g.data(), nullptr, udot.data(), lambda.data()));
    const VectorXd found = rate + leak * sigma[2];
    // 1e-12 of the integration over h, and h⁴ of the difference.
    EXPECT_LT(relative_error(found, lambda, lambda.cwiseAbs().maxCoeff()), 1e-6) << name << leak;
  }
}

TEST(Energy, ChangesByTheDissipatedPower) {
  Scene scene = example("four_bar");
  scene.joints[0].damping = 0.4;
  scene.joints[1].stiffness = 3;
  scene.joints[2].damping = 1.1;
  ForceSpec wrench;
  wrench.kind = "wrench";
  wrench.body = "rocker";
  wrench.point = {0.7, 0.1, 0};
  wrench.force = {1, -2, 0};
  wrench.torque = {0, 0, 0.8};
  wrench.in_body_axes = true;
  scene.forces.push_back(wrench);
  const Mechanism mechanism(scene);
  const Start start = equations::start_of(mechanism);
  for (const auto& [form, integrator] :
       {std::pair{"momentum", "dop853"}, std::pair{"acceleration", "dop853"},
        std::pair{"momentum-index2", "ida"}, std::pair{"stabilised-index2", "ida"}}) {
    const RunResult run =
        run_form(mechanism, start,
                 equations::kept(equations::adaptive(form, integrator, "none", 1e-10, 4, 200)));
    ASSERT_EQ(run.status, "done") << run.reason;
    // T + V itself moves by joules, the balance by what the integrator errs.
    const auto e = mechanism.evaluation<double>();
    const auto stored = [&](const std::vector<double>& row) {
      e->place(0, row.data() + 1);
      e->move(row.data() + 1 + mechanism.nq());
      return e->kinetic() + e->potential(row.data() + 1);
    };
    const auto& rows = run.trajectory.rows;
    EXPECT_GT(std::abs(stored(rows.back()) - stored(rows.front())), 1) << form;
    EXPECT_LT(run.energy_error_max, 1e-6) << form;
  }
}

}  // namespace
}  // namespace momenta::dae_momenta
