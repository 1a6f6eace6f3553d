// Rolling wheels and equations of velocities: rows against geometry and differences, accelerations
// against Maggi's equations, the knife edge in every form, the gauge of σ, and what the Lagrangian
// of (6) would make of them.

#include "equations/maggi.h"
#include "equations/random_tree.h"
#include "equations/refusal.h"
#include "equations/rolling.h"
#include "equations/runs.h"

#include <gtest/gtest.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/core/format/toml/write_scene.h>
#include <momenta/core/open_chain/poses.h>
#include <momenta/core/scalar/quad.h>
#include <momenta/dae/form/ode_form.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <array>
#include <cmath>
#include <numbers>

namespace momenta::dae_nonholonomic {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using equations::column;
using equations::number;
using equations::run_of;
using equations::sleigh;
using equations::wheel;

/// A wheel and a plane on moving arms, and equations of velocities beside.
Scene everything(const std::string& rest = "") {
  return parse_scene(R"(
gravity = [0.3, -1, -9.81]
[[body]]
name = "tray"
mass = 3
com = [0.1, 0.2, 0.1]
inertia = [0.3, 0.2, 0.4]
[[body]]
name = "arm"
mass = 1
com = [0.3, 0, 0.1]
inertia = [0.1, 0.2, 0.15]
[[body]]
name = "wheel"
mass = 2
com = [0.02, 0, 0.01]
inertia = [0.05, 0.09, 0.05]
[[joint]]
name = "T"
kind = "spherical"
child = "tray"
[[joint]]
name = "A"
kind = "free"
child = "arm"
[[joint]]
name = "W"
kind = "revolute"
parent = "arm"
child = "wheel"
axis = [0.6, 0.8, 0]
origin = { parent = [0.4, 0.1, 0] }
[[marker]]
name = "M"
body = "wheel"
point = [0.1, 0.2, -0.1]
[[marker]]
name = "far-off"
body = "tray"
point = [0.3, 0.1, 0.2]
[[loop]]
name = "rolls"
kind = "rolling"
parent = "tray"
child = "wheel"
origin = { parent = [0.1, 0, 0.2], child = [0, 0.05, 0] }
rotation = { axis = "x", angle = 0.4 }
axis = [0.6, 0.8, 0]
normal = [0, 0.6, 0.8]
radius = 0.3
crown_radius = 0.1
[[loop]]
name = "tied"
kind = "velocity-equation"
equation = "M.vx*cos(W.q) + W.u*M.z*'far-off'.x = (1 + M.y^2)*'far-off'.vz"
)" + rest,
                     "everything.toml");
}

VectorXd start_of(const Mechanism& mechanism, equations::RandomTree& random) {
  VectorXd q(mechanism.nq());
  for (double& x : q) x = random.uniform(-1, 1);
  mechanism.tree().normalise(q);
  return q;
}
VectorXd random_vector(Eigen::Index n, equations::RandomTree& random) {
  VectorXd x(n);
  for (double& value : x) value = random.uniform(-1, 1);
  return x;
}

/// The contact's rows know positions of both bodies alone: the wheel's lowest point is sought on
/// its circle, and velocities are differences of where the bodies' points are.
TEST(Nonholonomic, WheelAgainstItsGeometry) {
  const Scene scene = everything();
  const Mechanism mechanism(scene);
  Poses poses(mechanism.tree(), scene);
  const int wheel_body = mechanism.tree().body("wheel"), tray = mechanism.tree().body("tray");
  const auto e = mechanism.evaluation<double>();
  CoordinateMotion motion(mechanism);
  equations::RandomTree random(11);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX()));
  const Eigen::Vector3d axle(0.6, 0.8, 0), normal = turn * Eigen::Vector3d(0, 0.6, 0.8),
                                           on_plane(0.1, 0, 0.2), centre(0, 0.05, 0);
  for (int sample = 0; sample < 5; ++sample) {
    const VectorXd q = start_of(mechanism, random), u = random_vector(mechanism.nv(), random);
    const auto at = poses(0, q.data());
    const Eigen::Isometry3d &a = at[static_cast<std::size_t>(wheel_body)],
                            &b = at[static_cast<std::size_t>(tray)];
    const Eigen::Vector3d n = b.linear() * normal, x = a * centre;
    // Golden section on the circle of radius 0.2 for the point nearest to the plane.
    const Eigen::Vector3d e1 = a.linear() * axle.unitOrthogonal(),
                          e2 = (a.linear() * axle).cross(e1);
    const auto rim = [&](double angle) -> Eigen::Vector3d {
      return x + 0.2 * (std::cos(angle) * e1 + std::sin(angle) * e2);
    };
    double best = 0;
    for (double angle = 0; angle < 6.3; angle += 0.01)
      if (n.dot(rim(angle)) < n.dot(rim(best))) best = angle;
    for (double step = 0.01; step > 1e-12; step *= 0.5)
      for (const double other : {best - step, best + step})
        if (n.dot(rim(other)) < n.dot(rim(best))) best = other;
    const Eigen::Vector3d p = rim(best) - 0.1 * n;
    VectorXd phi(mechanism.m()), rate(mechanism.m());
    e->place(0, q.data());
    e->positions(phi.data());
    e->move(u.data());
    e->velocities(rate.data());
    EXPECT_NEAR(phi[0], n.dot(p - b * on_plane), 1e-13);
    EXPECT_EQ(phi[1], 0);
    EXPECT_EQ(phi[2], 0);
    EXPECT_EQ(phi[3], 0);
    constexpr double h = 1e-5;
    const auto point_at = [&](int body, double time) -> Eigen::Vector3d {
      VectorXd there(q.size());
      const VectorXd way = time * u;
      e->place(0, q.data());
      motion.move(*e, q.data(), way.data(), there.data());
      const auto k = static_cast<std::size_t>(body);
      return poses(0, there.data())[k] * (at[k].inverse() * p);
    };
    const Eigen::Vector3d slip = (point_at(wheel_body, h) - point_at(wheel_body, -h) -
                                  point_at(tray, h) + point_at(tray, -h)) /
                                 (2 * h);
    EXPECT_NEAR(rate[0], n.dot(slip), 1e-7);
    // Axes 1 and 2 are some axes in the plane: both rows together are the slip.
    EXPECT_NEAR(std::hypot(rate[1], rate[2]), (slip - n.dot(slip) * n).norm(), 1e-7);
  }
}

/// Φ̇ is linear in u with the entries of A; Φ of the contact has Φ̇ for its rate; d/dt (A u − b) and
/// Ȧᵀσ are those of differences in quad precision.
void compare_with_differences(const Mechanism& mechanism, double t) {
  const int nv = mechanism.nv(), m = mechanism.m();
  equations::RandomTree random(5);
  const auto e = mechanism.evaluation<double>();
  const auto twin = mechanism.evaluation<Quad>();
  const auto quad = [](const VectorXd& x) {
    std::vector<Quad> y;
    for (const double value : x) y.emplace_back(value);
    return y;
  };
  for (int sample = 0; sample < 3; ++sample) {
    const VectorXd q = start_of(mechanism, random), u = random_vector(nv, random),
                   udot = random_vector(nv, random), sigma = random_vector(m, random);
    VectorXd rate(m), still(m), second(m), forces(nv), with(nv), without(nv), impulse(nv), phi(m);
    e->place(t, q.data());
    ASSERT_EQ(e->lost_loop(), "");
    e->move(nullptr);
    e->velocities(still.data());
    e->constraint_forces(sigma.data(), impulse.data());
    std::vector<double> entries(mechanism.constraint_pattern().size());
    e->constraint_entries(entries.data());
    VectorXd by_entries = still, load = VectorXd::Zero(nv);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const auto& at = mechanism.constraint_pattern()[i];
      by_entries[at.row] += entries[i] * u[at.column];
      load[at.column] += entries[i] * sigma[at.row];
    }
    e->move(u.data());
    e->velocities(rate.data());
    EXPECT_LE((rate - by_entries).norm(), 1e-13);
    EXPECT_LE((impulse - load).norm(), 1e-13);
    e->joint_forces(q.data(), u.data(), udot.data(), nullptr, forces.data());
    e->accelerations(second.data());
    e->momenta(sigma.data(), with.data());
    e->momentum_rates(q.data(), u.data(), sigma.data(), 0, with.data());
    e->momenta(nullptr, without.data());
    e->momentum_rates(q.data(), u.data(), nullptr, 0, without.data());
    // Steps that the clock, a double, holds exactly. q along u + x u̇ to second order in x.
    constexpr double x = 0x1p-17;
    const auto along = [&](double s) {
      const auto start = quad(q), rates = quad(u), more = quad(udot);
      std::vector<Quad> half(rates), at(start), k(start.size(), Quad(0.0)), middle(start);
      for (std::size_t i = 0; i < half.size(); ++i) half[i] += Quad(0.25 * s) * more[i];
      twin->coordinate_rates(start.data(), half.data(), k.data());
      for (std::size_t i = 0; i < at.size(); ++i) middle[i] += Quad(0.5 * s) * k[i];
      for (std::size_t i = 0; i < half.size(); ++i) half[i] = rates[i] + Quad(0.5 * s) * more[i];
      std::fill(k.begin(), k.end(), Quad(0.0));
      twin->coordinate_rates(middle.data(), half.data(), k.data());
      for (std::size_t i = 0; i < at.size(); ++i) at[i] += Quad(s) * k[i];
      std::vector<Quad> there(rates);
      for (std::size_t i = 0; i < there.size(); ++i) there[i] += Quad(s) * more[i];
      std::vector<Quad> of_rows(static_cast<std::size_t>(m)), of_load(static_cast<std::size_t>(nv)),
          gap(of_rows.size());
      const auto impulses = quad(sigma);
      twin->place(t + s, at.data());
      twin->positions(gap.data());
      twin->move(there.data());
      twin->velocities(of_rows.data());
      twin->constraint_forces(impulses.data(), of_load.data());
      VectorXd all(2 * m + nv);
      for (int i = 0; i < m; ++i) all[i] = value_of(of_rows[static_cast<std::size_t>(i)]);
      for (int i = 0; i < m; ++i) all[m + i] = value_of(gap[static_cast<std::size_t>(i)]);
      for (int i = 0; i < nv; ++i) all[2 * m + i] = value_of(of_load[static_cast<std::size_t>(i)]);
      return all;
    };
    const VectorXd difference = (along(x) - along(-x)) / (2 * x);
    EXPECT_LE((second - difference.head(m)).norm(), 1e-6);
    for (int i = 0; i < m; ++i) {
      if (mechanism.nonholonomic()[static_cast<std::size_t>(i)]) continue;
      EXPECT_NEAR(rate[i], difference[m + i], 1e-6) << i;
    }
    EXPECT_LE((with - without - difference.tail(nv)).norm(), 1e-6);
    EXPECT_GT(difference.tail(nv).norm(), 0.1);
  }
}

TEST(Nonholonomic, RowsAgainstDifferences) {
  compare_with_differences(Mechanism(everything()), 0);
  compare_with_differences(Mechanism(sleigh(0.3, "[0, 0, 0]", "[0, 0, 0]")), 0);
  compare_with_differences(
      Mechanism(sleigh(0.3, "[0, 0, 0]", "[0, 0, 0]"), {.algebra = Algebra::spatial}), 0);
}

TEST(Nonholonomic, RowsInTimeAgainstDifferences) {
  compare_with_differences(Mechanism(everything(R"(
[[drive]]
joint = "W"
kind = "harmonic"
amplitude = 0.7
frequency = 2
[[loop]]
name = "timed"
kind = "velocity-equation"
equation = "M.vy*(1 + 0.3*sin(t)) + W.u*M.z = 0.2*t*M.x + 0.1"
)")),
                           0.25);
}

TEST(Nonholonomic, AccelerationsAreMaggis) {
  for (const KktChoice kkt : {KktChoice::dense, KktChoice::sparse}) {
    const Mechanism mechanism(everything(), {.kkt = kkt});
    equations::RandomTree random(3);
    const auto e = mechanism.evaluation<double>();
    const auto solver = make_loop_solver(mechanism, *e);
    for (int sample = 0; sample < 4; ++sample) {
      const VectorXd q = start_of(mechanism, random), u = random_vector(mechanism.nv(), random);
      VectorXd udot(mechanism.nv()), lambda(mechanism.m());
      ASSERT_TRUE(
          solver->acceleration(0, q.data(), u.data(), nullptr, 0, 0, udot.data(), lambda.data()));
      const equations::Maggi twin(mechanism, 0, q, u);
      EXPECT_LE((udot - twin.udot).norm(), 1e-8 * (1 + twin.udot.norm()));
      EXPECT_LE((twin.M * udot + twin.h + twin.A.transpose() * lambda).norm(),
                1e-9 * (1 + twin.h.norm()));
    }
  }
}

/// A knife edge on a slope, turning evenly, drifts across it on a cycloid and comes back to its
/// height: v = (g sin α/ω) sin ωt along the blade (Neimark, Fufaev, Dynamics of Nonholonomic
/// Systems, 1972). λ grows; σ with it; the motion knows nothing of either.
TEST(Nonholonomic, KnifeEdgeOnASlopeInEveryForm) {
  constexpr double slope = 3, omega = 2, end = 4;
  const Mechanism mechanism(sleigh(0, "[3, 0, 0]", "[0, 0, 2]"));
  const double x = slope / (2 * omega * omega) * std::pow(std::sin(omega * end), 2),
               y = slope / (2 * omega * omega) * (omega * end - 0.5 * std::sin(2 * omega * end));
  for (const std::string& form : form_names()) {
    for (const char* gauge : {"none", "leak:1.5", "reset", "flip"}) {
      const std::string which = gauge;
      if (which != "none" && !takes_gauge(form)) continue;
      if (is_dae_form(form) && (which == "reset" || which == "flip")) continue;
      SCOPED_TRACE(form + " " + which);
      const RunResult run = run_of(mechanism, form, end, which);
      if (form == "partitioned") {
        EXPECT_EQ(run.status, "failed");
        EXPECT_NE(run.reason.find("ties rates and no coordinates"), std::string::npos);
        continue;
      }
      ASSERT_EQ(run.status, "done") << run.reason;
      // The rates of index-3 forms take no part in BDF's error test.
      const bool tested = form != "momentum-index3" && form != "acceleration-index3";
      const double bound = !is_dae_form(form) ? 1e-9 : tested ? 1e-6 : 3e-5;
      EXPECT_NEAR(column(run, "K.x"), x, bound);
      EXPECT_NEAR(column(run, "K.y"), y, bound);
      EXPECT_LE(run.energy_error_max, 10 * bound);
      EXPECT_EQ(run.position_drift_max, 0);
    }
  }
}

/// (p, σ) → (p + Aᵀc, σ + c) changes nothing: with ṗ = L_q + Q + Ȧᵀσ σ̇ is the force.
TEST(Nonholonomic, GaugeIsFree) {
  const Mechanism mechanism(everything());
  const Start start = assemble(mechanism).start;
  FormOptions options;
  const auto form = make_form("momentum", mechanism, options, start);
  const std::vector<double> y = form->initial(start);
  VectorXd c(mechanism.m()), load(mechanism.nv());
  equations::RandomTree random(2);
  for (double& x : c) x = random.uniform(-5, 5);
  const auto e = mechanism.evaluation<double>();
  e->place(0, start.q.data());
  e->constraint_forces(c.data(), load.data());
  ASSERT_GT(load.norm(), 1);
  std::vector<double> other = y;
  for (int i = 0; i < mechanism.nv(); ++i)
    other[static_cast<std::size_t>(mechanism.nq() + i)] += load[i];
  IntegrationOptions settings;
  settings.rtol = settings.atol = 1e-12;
  const auto end_of = [&](const std::vector<double>& from) {
    const auto run = integrate("vern9", *form->ode(), 0, from, {0.4}, settings, {});
    EXPECT_TRUE(run.done) << run.reason;
    Snapshot at;
    EXPECT_TRUE(form->read(0.4, run.y.data(), nullptr, at));
    return at;
  };
  const Snapshot one = end_of(y), two = end_of(other);
  EXPECT_LE((one.q - two.q).norm(), 1e-9);
  EXPECT_LE((one.u - two.u).norm(), 1e-9);
  EXPECT_LE((two.multipliers - one.multipliers - c).norm(), 1e-7);
}

/// The sleigh by hand: with Ȧᵀσ in ṗ it is the form's, with (A u)_qᵀσ, which the Lagrangian
/// L + (A u)ᵀσ gives, the motion is another one, and another for every σ(0).
TEST(Nonholonomic, TheLagrangianOfImpulsesIsAnotherPrinciple) {
  constexpr double m = 1.5, ahead = 0.3, inertia = 0.4, end = 1.5;
  const Mechanism mechanism(sleigh(ahead, "[0, 0, 0]", "[1, 0, 0.8]"));
  // State x, y, φ, p.
  using State = Eigen::Matrix<double, 6, 1>;
  const auto rates = [&](const State& s, bool vakonomic) {
    const double co = std::cos(s[2]), si = std::sin(s[2]);
    Eigen::Matrix4d left = Eigen::Matrix4d::Zero();
    left.topLeftCorner<3, 3>() << m, 0, -m * ahead * si, 0, m, m * ahead * co, -m * ahead * si,
        m * ahead * co, inertia + m * ahead * ahead;
    left.block<3, 1>(0, 3) << -si, co, 0;
    left.block<1, 3>(3, 0) << -si, co, 0;
    const Eigen::Vector4d right(s[3], s[4], s[5], 0), x = left.fullPivLu().solve(right);
    const double u = x[0], v = x[1], w = x[2], sigma = x[3];
    State r;
    r << u, v, w, 0, 0, m * ahead * w * (-u * co - v * si);  // L_φ
    if (vakonomic)
      r[5] += sigma * (-u * co - v * si);  // ∂(A u)/∂φ
    else
      r.segment<2>(3) += sigma * w * Eigen::Vector2d(-co, -si);  // Ȧ
    return r;
  };
  const auto end_of = [&](double sigma, bool vakonomic) {
    State s;
    s << 0, 0, 0, m * 1.0, m * ahead * 0.8 + sigma,
        m * ahead * 0 + (inertia + m * ahead * ahead) * 0.8;
    constexpr int steps = 3000;
    const double h = end / steps;
    for (int i = 0; i < steps; ++i) {
      const State a = rates(s, vakonomic), b = rates(s + 0.5 * h * a, vakonomic),
                  c = rates(s + 0.5 * h * b, vakonomic), d = rates(s + h * c, vakonomic);
      s += h / 6 * (a + 2 * b + 2 * c + d);
    }
    return s;
  };
  const RunResult run = run_of(mechanism, "momentum", end);
  for (const double sigma : {0.0, 0.7}) {
    const State s = end_of(sigma, false);
    EXPECT_NEAR(column(run, "K.x"), s[0], 1e-9);
    EXPECT_NEAR(column(run, "K.y"), s[1], 1e-9);
  }
  const State other = end_of(0, true), third = end_of(0.7, true);
  EXPECT_GT(std::hypot(other[0] - column(run, "K.x"), other[1] - column(run, "K.y")), 0.01);
  EXPECT_GT((third - other).head<2>().norm(), 0.1);
}

/// Positions count apart from rates.
TEST(Nonholonomic, PositionsAndRatesAreCountedApart) {
  const Assembly ball = assemble(Mechanism(everything()));
  EXPECT_EQ(ball.rank, 4);
  EXPECT_EQ(ball.mobility, 6);
  EXPECT_EQ(ball.free_positions, 9);
  const Scene scene = everything();
  EXPECT_EQ(scene_text(parse_scene(scene_text(scene), "again.toml")), scene_text(scene));
}

TEST(Nonholonomic, IntegratorsOfPositionsAreRefused) {
  const Mechanism mechanism(sleigh(0.2, "[0, 0, 0]", "[1, 0, 0.5]"));
  const Start start = assemble(mechanism).start;
  const std::array<std::array<const char*, 2>, 5> refused{
      {{"momentum", "rattle"},
       {"momentum", "energy-momentum"},
       {"acceleration-index3", "generalised-alpha"},
       {"acceleration-index3", "bayo-ledesma"},
       {"momentum-index2", "hem5"}}};
  for (const auto& [form, integrator] : refused) {
    RunRequest request;
    request.settings.form = form;
    request.settings.integrator = integrator;
    if (!std::string(integrator).starts_with("hem")) request.settings.step = 0.01;
    EXPECT_TRUE(equations::says(
        equations::thrown<std::invalid_argument>([&] { run_form(mechanism, start, request); }),
        "loop 'blade' (velocity equation) ties rates"))
        << integrator;
  }
  const std::array<std::array<const char*, 2>, 3> taken{{{"acceleration-index2", "hem5"},
                                                         {"acceleration-index2", "hem8"},
                                                         {"momentum-index2", "hem8"}}};
  for (const auto& [form, integrator] : taken) {
    EXPECT_EQ(
        run_form(mechanism, start, equations::adaptive(form, integrator, "none", 1e-8, 1)).status,
        "done")
        << integrator;
  }
}

/// Rows of rates leave positions alone: the assembly goes where contact is, across the wheel too.
TEST(Nonholonomic, AssemblyMovesAgainstTheSlip) {
  const Mechanism mechanism(parse_scene(
      wheel("[0, 0, -9.81]", 0.3, 0, "position = [0, 0, 0.35, 0.98, 0.1989974874213240, 0, 0]"),
      "open.toml"));
  const Assembly a = assemble(mechanism);
  EXPECT_EQ(a.rank, 3);
  EXPECT_LE(a.position_residual, 1e-12);
  // Nothing but height and lean close it: least change of the contact's row alone.
  EXPECT_NEAR(a.start.q[0], 0, 1e-14);
  EXPECT_NEAR(a.start.q[1], 0, 1e-14);
  EXPECT_LT(a.start.q[2], 0.35);
}

TEST(Nonholonomic, FlatDiscIsTold) {
  const Mechanism mechanism(
      parse_scene(wheel("[0, 0, -9.81]", 0.3, 0,
                        "position = [0, 0, 0, 0.70710678118654757, 0.70710678118654757, 0, 0]"),
                  "flat.toml"));
  EXPECT_NE(equations::sentence_of([&] { assemble(mechanism); }).find("lies flat on the plane"),
            std::string::npos);
}

}  // namespace
}  // namespace momenta::dae_nonholonomic
