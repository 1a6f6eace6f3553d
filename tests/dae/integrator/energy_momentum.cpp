// What the energy-momentum scheme keeps, and that it takes the step of its equations.
//
//   Φ, Φ̇, T + V at rounding however many steps, in the plane and in space, with redundant loops and
//   with joints whose q' is not u; momenta of cyclic coordinates; the way back; the work of dampers
//   to order 2. The twin: unknowns q_1, p_1, λ, σ, α, whole matrices, Newton's method by
//   differences.

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/constrained_steps.h>
#include <momenta/dae/integrator/implicit_methods.h>
#include <momenta/dae/run/run_form.h>

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/refusal.h"
#include "equations/runs.h"

#include <cmath>
#include <numbers>

namespace momenta::dae_energy_momentum {
namespace {

using namespace equations;
using Eigen::VectorXd;

/// The four-bar on a table that turns about the vertical, off its axis.
Scene turntable(double rate) {
  Scene s = equations::example("four_bar");
  for (JointSpec& j : s.joints)
    if (j.parent == "ground") {
      j.parent = "table";
      j.origin_parent += Eigen::Vector3d(0.3, 0, 0.2);
    }
  s.bodies.push_back(rod("table", 0.4));
  JointSpec axle = hinge("T", "ground", "table", {0, 0, 0}, 0.4);
  axle.axis = {0, 1, 0};
  axle.velocity = {rate};
  s.joints.push_back(axle);
  s.held.push_back("T");
  s.name = "turntable";
  return s;
}

/// A rod on a hinge of level axis on a hinge of vertical axis: a pendulum in space.
Scene pendulum(double lift, double rate) {
  Scene s;
  s.name = "pendulum in space";
  s.gravity = {0, -9.81, 0};
  s.bodies = {rod("fork", 0.1), rod("bob", 0.1)};
  JointSpec axle = hinge("T", "ground", "fork", {0, 0, 0}, 0.3);
  axle.axis = {0, 1, 0};
  axle.velocity = {rate};
  s.joints = {axle, hinge("A", "fork", "bob", {0, 0, 0}, lift)};
  return s;
}

RunResult run(const Scene& scene, double step, double end) {
  const Mechanism mechanism(scene);
  return run_form(mechanism, equations::start_of(mechanism),
                  equations::stepped("momentum", "energy-momentum", "none", step, end, 77));
}

/// A start, and steps from it.
struct Stepped {
  Mechanism mechanism;
  Start start;
  std::unique_ptr<Form> form;
  explicit Stepped(const Scene& scene)
      : mechanism(scene),
        start(equations::start_of(mechanism)),
        form(make_form("momentum", mechanism, {}, start)) {}
  std::vector<double> y0() { return form->initial(start); }
  std::vector<double> steps(const std::vector<double>& y, double h, int count) {
    IntegrationOptions options;
    options.step = h;
    const auto run = integrate_energy_momentum(*form->ode(), 0, y, {h * count}, options, {});
    EXPECT_TRUE(run.done) << run.reason;
    return run.y;
  }
};

// Changes that shrink by 0.73 an iteration are below 1e-13 at the last one allowed, by 0.8 are not.
TEST(Substitution, EndsAtRoundingOrFails) {
  using Is = constrained::Convergence::Is;
  const auto end = [](double share) {
    constrained::Convergence convergence;
    auto is = Is::under_way;
    double change = 0.1;
    for (int k = 0; is == Is::under_way; ++k, change *= share) {
      EXPECT_LT(k, 1000);
      is = convergence.after(change);
    }
    return is;
  };
  EXPECT_EQ(end(0.5), Is::reached);
  EXPECT_EQ(end(0.73), Is::reached);
  EXPECT_EQ(end(0.8), Is::failed);
  constrained::Convergence lost;
  EXPECT_EQ(lost.after(std::nan("")), Is::failed);
}

TEST(EnergyMomentum, KeepsConstraintsAndEnergyAtRounding) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(1.3, Eigen::Vector3d(1, 2, -1).normalized()));
  // The second has redundant equations, the last is an open chain.
  for (const Scene& scene :
       {equations::example("four_bar"), turned(equations::example("four_bar"), turn), turntable(2),
        flying_rod(), pendulum(-0.5, 3)}) {
    const RunResult r = run(scene, 0.0101, 50);
    ASSERT_EQ(r.status, "done") << scene.name << ": " << r.reason;
    if (!scene.loops.empty()) {
      EXPECT_LT(r.position_drift_max, 1e-13) << scene.name;
      EXPECT_LT(r.velocity_drift_max, 1e-12) << scene.name;
    }
    EXPECT_LT(r.energy_error_max, 2e-14 * r.energy_scale) << scene.name;
  }
}

TEST(EnergyMomentum, MomentaOfCyclicCoordinates) {
  for (const Scene& scene : {turntable(2), pendulum(-0.5, 3)}) {
    Stepped c(scene);
    const auto y0 = c.y0();
    const auto y = c.steps(y0, 0.01, 5000);
    int axle = -1;
    for (const auto& b : c.mechanism.tree().bodies)
      if (b.parent < 0) axle = b.u;
    ASSERT_GE(axle, 0);
    const auto at = static_cast<std::size_t>(c.mechanism.nq() + axle);
    EXPECT_GT(std::abs(y0[at]), 0.1) << scene.name;
    EXPECT_NEAR(y[at], y0[at], 1e-12 * std::abs(y0[at])) << scene.name;
  }
}

// A steady precession, and rest: no direction in which energy could be given or taken.
TEST(EnergyMomentum, RelativeEquilibria) {
  // ½ rate² dI/dlift = dV/dlift, I about the vertical.
  const double lift = -0.7, across = 1.01 / 12, along = 0.01 / 6,
               rate = std::sqrt(-9.81 / (2 * std::sin(lift) * (across + 0.25 - along)));
  Stepped turning(pendulum(lift, rate)), hanging(pendulum(-std::numbers::pi / 2, 0));
  const auto y = turning.steps(turning.y0(), 0.01, 500);
  EXPECT_NEAR(y[1], lift, 1e-9);
  const auto rest = hanging.steps(hanging.y0(), 0.01, 500), before = hanging.y0();
  for (std::size_t i = 0; i < rest.size(); ++i) EXPECT_NEAR(rest[i], before[i], 1e-13);
}

// L with a part linear in the rates: a charge in a magnetic field goes round at 2·1.4/0.3 rad/s,
// and a bead on a ring in a turning frame keeps Jacobi's energy.
TEST(EnergyMomentum, KeepsTheEnergyOfGyroscopicForces) {
  Stepped charge(
      parse_scene("[lagrangian]\ncoordinates = [\"x\", \"y\"]\n"
                  "position = [0.2, -0.1]\nvelocity = [1.0, 0.4]\n"
                  "lagrangian = \"0.15*(x.dot^2 + y.dot^2) + 1.4*(x*y.dot - y*x.dot)\"\n",
                  "charge.toml"));
  const double rate = 2 * 1.4 / 0.3, turn = 2 * std::numbers::pi / rate;
  const auto start = charge.y0();
  const auto off = [&](int count) {
    const auto y = charge.steps(start, turn / count, count);
    return std::hypot(y[0] - start[0], y[1] - start[1]);
  };
  const double coarse = off(100), fine = off(200);
  EXPECT_LT(fine, 1e-3);
  EXPECT_NEAR(coarse / fine, 4, 0.2);
  const Scene bead = parse_scene(
      "[lagrangian]\ncoordinates = [\"x\", \"y\"]\nposition = [0.6, -0.8]\n"
      "lagrangian = \"0.5*((x.dot - 2*y)^2 + (y.dot + 2*x)^2) - 9.81*y - 3*x^2\"\n"
      "constraints = [{ name = \"ring\", equation = \"hypot(x, y) - 1\" }]\n",
      "bead.toml");
  for (const Scene& scene : {charge.mechanism.scene(), bead}) {
    const RunResult r = run(scene, 0.01, 10);
    ASSERT_EQ(r.status, "done") << r.reason;
    EXPECT_LT(r.energy_error_max, 1e-13 * r.energy_scale);
  }
}

TEST(EnergyMomentum, ReturnsToItsStart) {
  for (const Scene& scene : {equations::example("four_bar"), flying_rod()}) {
    Stepped c(scene);
    const auto start = c.y0();
    const auto turn = [&](std::vector<double> y) {
      for (std::size_t i = static_cast<std::size_t>(c.mechanism.nq()); i < y.size(); ++i)
        y[i] = -y[i];
      return y;
    };
    const auto back = turn(c.steps(turn(c.steps(start, 0.01, 50)), 0.01, 50));
    for (std::size_t i = 0; i < back.size(); ++i)
      EXPECT_NEAR(back[i], start[i], 1e-8 * (1 + std::abs(start[i]))) << scene.name;
  }
}

TEST(EnergyMomentum, WorkOfADamperToOrderTwo) {
  Scene scene = equations::example("four_bar");
  for (JointSpec& j : scene.joints)
    if (j.name == "C") j.damping = 2;
  const auto off = [&](double h) { return run(scene, h, 4).energy_error_max; };
  const double coarse = off(0.02), fine = off(0.005);
  EXPECT_NEAR(std::log2(coarse / fine) / 2, 2, 0.3) << coarse << " " << fine;
}

TEST(EnergyMomentum, RefusesWhatIsPrescribed) {
  const Scene driven = equations::example("driven");
  EXPECT_TRUE(
      equations::says(equations::thrown<std::invalid_argument>([&] { run(driven, 0.01, 1); }),
                      "found the drive of joint 'O', and it does work too; expected no prescribed "
                      "motion"));
  const Scene formulas = parse_scene(
      "[lagrangian]\ncoordinates = [\"x\", \"y\"]\nposition = [1, 0]\n"
      "kinetic = \"0.5*(x.dot^2 + y.dot^2)\"\n"
      "constraints = [{ name = \"still\", equation = \"y\" },\n"
      "               { name = \"wall\", equation = \"x - cos(t)\" }]\n");
  EXPECT_TRUE(equations::says(
      equations::thrown<std::invalid_argument>([&] { run(formulas, 0.01, 1); }),
      "found a constraint that takes the time, and it does work too; expected no prescribed "
      "motion"));
}

// The last equation is one of energies, of which α is a small part: Newton's method by differences
// has a step for each unknown.
TEST(EnergyMomentum, TakesTheStepOfItsEquations) {
  const double h = 0.02;
  for (const Scene& scene : {row_of_four_bars(3, 1.2, 1), turntable(2)}) {
    Stepped c(scene);
    const auto y0 = c.steps(c.y0(), h, 30), y1 = c.steps(y0, h, 1);
    const Eigen::Index n = c.mechanism.nv(), m = c.mechanism.m();
    const auto e = c.mechanism.evaluation<double>();
    const VectorXd q0 = Eigen::Map<const VectorXd>(y0.data(), n),
                   p0 = Eigen::Map<const VectorXd>(y0.data() + n, n);
    const auto mass = [&](const VectorXd& q) {
      Eigen::MatrixXd columns(n, n);
      e->place(0, q.data());
      for (Eigen::Index i = 0; i < n; ++i) {
        const VectorXd unit = VectorXd::Unit(n, i);
        e->move(unit.data());
        e->momenta(nullptr, columns.col(i).data());
      }
      return columns;
    };
    const auto loop_force = [&](const VectorXd& q, const VectorXd& x) {
      VectorXd result(n);
      e->place(0, q.data());
      e->constraint_forces(x.data(), result.data());
      return result;
    };
    const auto energy = [&](const VectorXd& q, const VectorXd& p) {
      const VectorXd u = mass(q).ldlt().solve(p);
      e->move(u.data());
      return e->kinetic() + e->potential(q.data());
    };
    // M v of δ: along the axle, where there is one, no momentum.
    const auto push = [&](const Eigen::MatrixXd& inertia, VectorXd delta) {
      for (const auto& b : c.mechanism.tree().bodies)
        if (scene.name == "turntable" && b.parent < 0)
          delta[b.u] -= inertia.row(b.u).dot(delta) / inertia(b.u, b.u);
      return VectorXd(inertia * delta);
    };
    const double start = energy(q0, p0);
    const auto equations = [&](const VectorXd& x) {
      const VectorXd q1 = x.head(n), p1 = x.segment(n, n), lambda = x.segment(2 * n, m),
                     sigma = x.segment(2 * n + m, m), qm = 0.5 * (q0 + q1), pm = 0.5 * (p0 + p1);
      const double alpha = x[2 * n + 2 * m];
      const Eigen::MatrixXd inertia = mass(qm);
      const auto inverse = inertia.ldlt();
      const VectorXd u = inverse.solve(pm - loop_force(qm, sigma)), force = loop_force(qm, lambda);
      VectorXd g(n), p(n), phi(m), rate(m);
      e->move(u.data());
      e->momenta(sigma.data(), p.data());
      e->momentum_rates(qm.data(), u.data(), sigma.data(), 0, g.data());
      VectorXd r(x.size());
      r.head(n) = q1 - q0 - h * (u + alpha * inverse.solve(p1 - p0));
      r.segment(n, n) = p1 - p0 - h * (g - force) + alpha / h * push(inertia, q1 - q0);
      r[2 * n + 2 * m] = energy(q1, p1) - start;
      const VectorXd u1 = mass(q1).ldlt().solve(p1);
      e->positions(phi.data());
      e->move(u1.data());
      e->velocities(rate.data());
      r.segment(2 * n, m) = phi;
      r.segment(2 * n + m, m) = rate;
      return r;
    };
    VectorXd x = VectorXd::Zero(2 * n + 2 * m + 1);
    x.head(n) = q0 + h * VectorXd(mass(q0).ldlt().solve(p0));
    x.segment(n, n) = p0;
    x.segment(2 * n, m) = c.start.lambda;
    for (int k = 0; k < 12; ++k) {
      const VectorXd r = equations(x);
      Eigen::MatrixXd jacobian(x.size(), x.size());
      for (Eigen::Index i = 0; i < x.size(); ++i) {
        VectorXd ahead = x;
        ahead[i] += 1e-6;
        jacobian.col(i) = (equations(ahead) - r) / 1e-6;
      }
      x -= jacobian.fullPivLu().solve(r);
    }
    ASSERT_LT(equations(x).norm(), 1e-11) << scene.name;
    EXPECT_GT(std::abs(x[2 * n + 2 * m]), 1e-7) << scene.name;  // α does something
    EXPECT_LT((Eigen::Map<const VectorXd>(y1.data(), n) - x.head(n)).norm(), 1e-11) << scene.name;
    EXPECT_LT((Eigen::Map<const VectorXd>(y1.data() + n, n) - x.segment(n, n)).norm(), 1e-10)
        << scene.name;
  }
}

}  // namespace
}  // namespace momenta::dae_energy_momentum
