// Inverse dynamics against forward dynamics, runs with drives, statics and formulas: the efforts
// found, put back as joint forces, give the motion they were found for.

#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/parts.h"
#include "equations/random_tree.h"
#include "equations/refusal.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/analysis/chain/closed_chain.h>
#include <momenta/dae/analysis/effort/effort.h>
#include <momenta/dae/run/run_form.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace momenta::dae_effort {
namespace {

using Eigen::VectorXd;
using equations::example;
using std::numbers::pi;

DriveSpec harmonic(const std::string& joint, double offset, double amplitude, double frequency) {
  return equations::harmonic(joint, offset, amplitude, frequency);
}

std::vector<double> times(int count, double end) {
  std::vector<double> all;
  for (int i = 0; i <= count; ++i) all.push_back(end * i / count);
  return all;
}

/// The motion of a scene's own drives, 40 times along `end` [s].
EffortResult along_drives(const Scene& scene, double end, EffortRequest request = {}) {
  const Mechanism mechanism(undriven(scene));
  request.motion.drives = scene.drives;
  request.motion.times = times(40, end);
  return effort(mechanism, request);
}

/// The largest |u̇(τ) − u̇| over the largest |u̇|, with τ the efforts as joint forces of (3).
double residue(const Scene& free, const EffortResult& r) {
  ClosedChain chain(free);
  VectorXd tau(chain.nv()), udot(chain.nv()), lambda(chain.m());
  double worst = 0, size = 0;
  for (const EffortRow& row : r.rows) {
    tau.setZero();
    for (std::size_t i = 0; i < r.actuators.size(); ++i)
      tau[r.actuators[i].rate] += row.effort[static_cast<Eigen::Index>(i)];
    EXPECT_TRUE(chain.accelerations(row.t, row.q, row.u, tau, udot, lambda)) << chain.failure();
    worst = equations::larger(worst, (udot - row.udot).cwiseAbs().maxCoeff());
    size = std::max(size, row.udot.cwiseAbs().maxCoeff());
  }
  EXPECT_GT(r.rows.size(), 0u);
  return std::isfinite(worst) ? worst / std::max(size, 1.0) : INFINITY;
}

/// A table of the states of a mechanism, with what columns of it are asked for.
Reference table_of(const Mechanism& mechanism, const std::vector<EffortRow>& rows, bool rates,
                   bool accelerations) {
  std::vector<std::string> columns;
  for (const Column& c : mechanism.coordinate_columns()) columns.push_back(c.label());
  if (rates)
    for (const Column& c : mechanism.rate_columns()) columns.push_back(c.label());
  if (accelerations)
    for (const Column& c : mechanism.rate_columns())
      columns.push_back(acceleration_column(c).label());
  std::vector<double> t;
  std::vector<std::vector<double>> values;
  for (const EffortRow& row : rows) {
    t.push_back(row.t);
    values.emplace_back(row.q.begin(), row.q.end());
    if (rates) values.back().insert(values.back().end(), row.u.begin(), row.u.end());
    if (accelerations) values.back().insert(values.back().end(), row.udot.begin(), row.udot.end());
  }
  return Reference("a table", columns, t, values);
}

// ID∘FD on trees of all joints, balls and free bodies with their quaternions among them.
TEST(Effort, OfTreesGivesTheirAccelerations) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    equations::RandomTree random(seed);
    equations::TreeRecipe recipe;
    recipe.drives = false;
    recipe.bodies = 1 + static_cast<int>(seed) % 7;
    const Scene scene = random.scene(recipe);
    const Mechanism mechanism(scene);
    if (mechanism.nv() == 0) continue;
    std::vector<EffortRow> rows;
    for (int i = 0; i < 5; ++i) {
      const auto state = random.state(mechanism.tree());
      EffortRow row;
      row.t = i;
      row.q = state.q;
      row.u = state.u;
      row.udot = VectorXd::NullaryExpr(mechanism.nv(), [&] { return random.uniform(-3, 3); });
      rows.push_back(row);
    }
    const Reference table = table_of(mechanism, rows, true, true);
    EffortRequest request;
    request.motion.table = &table;
    const EffortResult r = effort(mechanism, request);
    EXPECT_EQ(static_cast<int>(r.actuators.size()), mechanism.nv());
    EXPECT_LT(residue(scene, r), 1e-12) << seed;
  }
}

// ID∘FD with loops, in a plane and in space, and the efforts of a run with those drives.
TEST(Effort, WithLoopsGivesTheAccelerationsOfDrives) {
  Scene crank = example("slider_crank"), bars = example("four_bar");
  crank.drives = {harmonic(crank.joints.front().name, 0.4, 2, 1.3)};
  bars.drives = {harmonic("O", 1.5707963267948966, 2.5, 2)};
  crank.held.clear();
  bars.held.clear();
  Scene stewart = equations::platform(6);
  {
    const Mechanism mechanism(stewart);
    const VectorXd q = assemble(mechanism, Assembled::rates).start.q;
    const auto columns = mechanism.coordinate_columns();
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (columns[i].unit == "m" && columns[i].name[0] == 'S')
        stewart.drives.push_back(harmonic(columns[i].name.substr(0, columns[i].name.find('.')),
                                          q[static_cast<Eigen::Index>(i)],
                                          0.05 + 0.01 * static_cast<double>(i % 3), 2));
    ASSERT_EQ(stewart.drives.size(), 6u) << columns.back().name;
  }
  for (const Scene& scene : {crank, bars, stewart}) {
    const EffortResult r = along_drives(scene, 2);
    EXPECT_EQ(r.redundant, 0);
    EXPECT_EQ(r.unactuated, 0);
    EXPECT_LT(residue(undriven(scene), r), 1e-12) << scene.name;

    const Mechanism driven(scene);
    RunRequest request =
        equations::kept(equations::adaptive("acceleration", "dop853", "none", 1e-12, 2, 40));
    request.settings.project = true;
    const RunResult run = run_form(driven, assemble(driven).start, request);
    ASSERT_EQ(run.status, "done") << run.reason;
    ASSERT_EQ(run.trajectory.rows.size(), r.rows.size());
    for (std::size_t a = 0; a < r.actuators.size(); ++a) {
      const auto& columns = run.trajectory.columns;
      const auto found = std::find(columns.begin(), columns.end(), r.actuators[a].effort.label());
      ASSERT_NE(found, columns.end()) << r.actuators[a].effort.label();
      const auto at = static_cast<std::size_t>(found - columns.begin());
      for (std::size_t i = 0; i < r.rows.size(); ++i) {
        const double x = r.rows[i].effort[static_cast<Eigen::Index>(a)];
        EXPECT_NEAR(run.trajectory.rows[i][at], x, 1e-7 * (1 + std::abs(x)))
            << scene.name << " " << i;
      }
    }
  }
}

// Two motors on a four-bar: least norm, by hand. With k = u_C/u_O, τ_O + k τ_C is what one motor
// gives, and w_O τ_O² + w_C τ_C² is least for τ_O : τ_C = 1/w_O : k/w_C.
TEST(Effort, RedundantActuatorsShareByTheirWeights) {
  Scene bars = example("four_bar");
  bars.held.clear();
  bars.drives = {harmonic("O", 1.5707963267948966, 2.5, 2)};
  const EffortResult alone = along_drives(bars, 2);
  for (const double weight : {1.0, 0.25, 7.0}) {
    EffortRequest request;
    request.actuated = {"O", "C.q"};
    if (weight != 1) request.weights = {{"C", weight}};
    const EffortResult both = along_drives(bars, 2, request);
    EXPECT_EQ(both.redundant, 1);
    EXPECT_LT(residue(undriven(bars), both), 1e-12);
    for (std::size_t i = 0; i < both.rows.size(); ++i) {
      const EffortRow& row = both.rows[i];
      // At the ends of the swing u is 0: ratios come from the motion between.
      if (std::abs(row.u[0]) < 0.1) continue;
      const double k = row.u[2] / row.u[0], one = alone.rows[i].effort[0];
      EXPECT_NEAR(row.effort[0], one / (1 + k * k / weight), 1e-11 * (1 + std::abs(one)));
      EXPECT_NEAR(row.effort[1], one * k / weight / (1 + k * k / weight),
                  1e-11 * (1 + std::abs(one)));
      EXPECT_NEAR(row.power.sum(), alone.rows[i].power[0], 1e-10 * (1 + std::abs(one)));
    }
  }
}

// A screw of pitch h lifts a nut of mass m and inertia J: torque (J + m h²) φ̈ + m g h, of which the
// thrust m (g + h φ̈) is h thrust, and J φ̈ turns the nut.
TEST(Effort, OfAScrewIsTorqueApartFromThrust) {
  constexpr double m = 3, J = 0.2, h = 0.05, g = 9.81;
  Scene scene;
  scene.gravity = {0, 0, -g};
  BodySpec nut;
  nut.name = "nut";
  nut.mass = m;
  nut.inertia = Eigen::Vector3d(0.15, 0.15, J).asDiagonal();
  scene.bodies = {nut};
  JointSpec screw = equations::make_joint(JointKind::helical, "S", "ground", "nut");
  screw.pitch = h;
  scene.joints = {screw};
  for (const bool turned : {false, true}) {
    if (turned) {  // the whole machine on its side: gravity along x, and the axis with it
      scene.gravity = {-g, 0, 0};
      scene.joints[0].axis = {1, 0, 0};
      scene.bodies[0].inertia = Eigen::Vector3d(J, 0.15, 0.15).asDiagonal();
    }
    scene.drives = {harmonic("S", 0.3, 4, 2)};
    const EffortResult r = along_drives(scene, 3);
    ASSERT_TRUE(r.has_thrust());
    for (const EffortRow& row : r.rows) {
      const double a = row.udot[0];
      EXPECT_NEAR(row.effort[0], (J + m * h * h) * a + m * g * h, 1e-13);
      EXPECT_NEAR(row.thrust[0], m * (g + h * a), 1e-12);
      EXPECT_NEAR(row.effort[0] - h * row.thrust[0], J * a, 1e-13);
    }
    EXPECT_LT(residue(undriven(scene), r), 1e-12);
  }
}

// A screw that carries a load on guides, through a loop of which two of three equations move
// nothing: the thrust is that of both.
TEST(Effort, OfAScrewInALoopIsThrustOfTheLoad) {
  constexpr double m = 3, M = 20, J = 0.2, h = 0.05, g = 9.81;
  Scene scene;
  scene.gravity = {0, 0, -g};
  BodySpec nut, load;
  nut.name = "nut";
  nut.mass = m;
  nut.inertia = Eigen::Vector3d(0.15, 0.15, J).asDiagonal();
  load = nut;
  load.name = "load";
  load.mass = M;
  scene.bodies = {nut, load};
  JointSpec screw, guide;
  screw.name = "S";
  screw.kind = JointKind::helical;
  screw.child = "nut";
  screw.pitch = h;
  guide.name = "G";
  guide.kind = JointKind::prismatic;
  guide.child = "load";
  scene.joints = {screw, guide};
  LoopSpec seat = equations::make_loop(LoopKind::spherical, "B", "nut", "load");
  scene.loops = {seat};
  scene.drives = {harmonic("S", 0, 4, 2)};
  const EffortResult r = along_drives(scene, 3);
  for (const EffortRow& row : r.rows) {
    const double a = row.udot[0];
    EXPECT_NEAR(row.udot[1], h * a, 1e-12);
    EXPECT_NEAR(row.thrust[0], (m + M) * (g + h * a), 1e-10);
    EXPECT_NEAR(row.effort[0] - h * row.thrust[0], J * a, 1e-11);
  }
  // Guided twice, the load may rest on either screw: thrusts are open, efforts shared.
  BodySpec other = nut;
  other.name = "other";
  scene.bodies.push_back(other);
  screw.name = "T";
  screw.child = "other";
  scene.joints.push_back(screw);
  seat.name = "C";
  seat.parent = "other";
  scene.loops.push_back(seat);
  EffortRequest both;
  both.actuated = {"S", "T"};
  const EffortResult shared = along_drives(scene, 3, both);
  EXPECT_EQ(shared.redundant, 1);
  for (const EffortRow& row : shared.rows) {
    EXPECT_NEAR(row.effort[0], row.effort[1], 1e-11);
    EXPECT_NEAR(row.thrust[0], (m + M / 2) * (g + h * row.udot[0]), 1e-10);
  }
  // Nuts that cannot turn in the load hold it by their threads alone, each as much as it likes.
  for (LoopSpec& loop : scene.loops) loop.kind = LoopKind::weld;
  scene.drives.clear();
  both.motion.poses_alone = true;
  both.motion.times = {0};
  const Mechanism locked(scene);
  const EffortResult open = effort(locked, both);
  EXPECT_EQ(open.redundant, 2);
  EXPECT_EQ(open.rows.front().effort.cwiseAbs().maxCoeff(), 0);
  EXPECT_TRUE(std::isnan(open.rows.front().thrust[0]));
  EXPECT_TRUE(std::isnan(open.rows.front().thrust[1]));
}

// What holds a pose is the slope of V along the motion that loops leave, by differences of poses.
TEST(Effort, AtRestIsTheSlopeOfThePotential) {
  Scene bars = example("four_bar");
  bars.held.clear();
  bars.drives = {harmonic("O", 1.1, 2.5, 2)};
  EffortRequest still;
  still.motion.poses_alone = true;
  const Mechanism mechanism(undriven(bars));
  still.motion.drives = bars.drives;
  still.motion.times = times(40, 2);
  const EffortResult r = effort(mechanism, still);
  // The crank at 4 places around each of them.
  constexpr double h = 1e-3;
  const auto potential = [&](double angle, const EffortRow& near) {
    Scene there = undriven(bars);
    for (std::size_t i = 0; i < 3; ++i)
      there.joints[i].position = {near.q[static_cast<Eigen::Index>(i)]};
    there.joints[0].position = {angle};
    there.held = {"O"};
    ClosedChain chain(there);
    const Assembly a = chain.assemble();
    return chain.energies(0, a.start.q, VectorXd::Zero(3)).potential;
  };
  for (std::size_t i = 0; i < r.rows.size(); i += 4) {
    const EffortRow& row = r.rows[i];
    EXPECT_EQ(row.u.cwiseAbs().maxCoeff(), 0);
    const auto V = [&](int k) { return potential(row.q[0] + k * h, row); };
    const double slope = (8 * (V(1) - V(-1)) - (V(2) - V(-2))) / (12 * h);
    EXPECT_NEAR(row.effort[0], slope, 1e-8 * (1 + std::abs(slope)));
  }
  // A pendulum held at the start, without any motion: m g l sin θ, by all it has.
  Scene pendulum = example("pendulum");
  EffortRequest held;
  held.motion.poses_alone = true;
  held.motion.times = {0};
  const Mechanism hanging(pendulum);
  const EffortResult one = effort(hanging, held);
  ClosedChain chain(pendulum);
  VectorXd tau(chain.nv()), udot(chain.nv()), lambda(chain.m());
  tau[0] = one.rows[0].effort[0];
  ASSERT_TRUE(chain.accelerations(0, one.rows[0].q, VectorXd::Zero(1), tau, udot, lambda));
  EXPECT_LT(std::abs(udot[0]), 1e-12);
}

// Loops that move by themselves stand still too: two rods, the second of which a formula turns
// against the first.
TEST(Effort, AtRestNothingMoves) {
  constexpr double g = 9.81, held = 0.4;
  Scene scene;
  scene.gravity = {0, -g, 0};
  scene.bodies = {equations::rod("first"), equations::rod("second")};
  scene.joints = {equations::hinge("O", "ground", "first", {0, 0, 0}, held),
                  equations::hinge("A", "first", "second", {1, 0, 0}, 0)};
  LoopSpec turning;
  turning.name = "turning";
  turning.kind = LoopKind::equation;
  turning.equation = "A.q - 1.5*sin(2*t)";
  scene.loops = {turning};
  scene.held = {"O"};
  const Mechanism mechanism(scene);
  EffortRequest still;
  still.motion.poses_alone = true;
  still.motion.hold = {"O"};
  still.motion.times = times(20, 3);
  still.actuated = {"O"};
  for (const EffortRow& row : effort(mechanism, still).rows) {
    EXPECT_EQ(row.u.cwiseAbs().maxCoeff(), 0);
    EXPECT_NEAR(row.q[1], 1.5 * std::sin(2 * row.t), 1e-12);
    EXPECT_NEAR(row.effort[0], g * (1.5 * std::cos(held) + 0.5 * std::cos(held + row.q[1])), 1e-12);
  }
}

// A table without rates and accelerations: the error falls like h⁵, with quaternions too; of the
// ends as well.
TEST(Effort, OfATableConverges) {
  equations::RandomTree random(5);
  equations::TreeRecipe recipe;
  recipe.drives = false;
  recipe.bodies = 3;
  recipe.branching = equations::Branching::serial;
  recipe.kinds = {JointKind::revolute, JointKind::spherical, JointKind::free};
  const Scene scene = random.scene(recipe);
  ClosedChain chain(scene);
  const Mechanism& mechanism = chain.mechanism();
  const auto start = random.state(mechanism.tree());
  // In units of the forces that hold the start without accelerations.
  VectorXd forces(chain.nv());
  chain.joint_forces(0, start.q, 0.3 * start.u, VectorXd::Zero(chain.nv()), VectorXd(0), forces);
  const double unit = forces.cwiseAbs().maxCoeff();
  double before = 0;
  for (const int count : {20, 40, 80}) {
    // A motion that is known: that of (3) itself, so that efforts are zero.
    std::vector<EffortRow> rows;
    EffortRow row;
    row.q = start.q;
    row.u = 0.3 * start.u;
    const double span = 0.4;
    constexpr int inner = 4000;
    VectorXd udot(chain.nv()), none(0), qdot(chain.nq());
    const auto slope = [&](const VectorXd& q, const VectorXd& u, VectorXd& dq, VectorXd& du) {
      dq.resize(chain.nq());
      du.resize(chain.nv());
      chain.coordinate_rates(0, q, u, dq);
      EXPECT_TRUE(chain.accelerations(0, q, u, du, none));
    };
    const double h = span / inner;
    for (int i = 0; i <= inner; ++i) {
      if (i % (inner / count) == 0) {
        row.t = span * i / inner;
        rows.push_back(row);
      }
      VectorXd a, b, c, d, e, f, g, k;
      slope(row.q, row.u, a, b);
      slope(row.q + h / 2 * a, row.u + h / 2 * b, c, d);
      slope(row.q + h / 2 * c, row.u + h / 2 * d, e, f);
      slope(row.q + h * e, row.u + h * f, g, k);
      row.q += h / 6 * (a + 2 * c + 2 * e + g);
      row.u += h / 6 * (b + 2 * d + 2 * f + k);
    }
    const Reference table = table_of(mechanism, rows, false, false);
    EffortRequest request;
    request.motion.table = &table;
    const EffortResult r = effort(mechanism, request);
    double worst = 0;
    for (const EffortRow& found : r.rows)
      worst = equations::larger(worst, found.effort.cwiseAbs().maxCoeff() / unit);
    if (before > 0) {
      EXPECT_LT(worst, before / 20) << count;
    }
    before = worst;
  }
  EXPECT_LT(before, 1e-4);
}

// Weights are exact on polynomials of their degree.
TEST(Effort, DifferencesAreExactOnPolynomials) {
  const std::vector<double> x{0, 0.1, 0.25, 0.3, 0.5, 0.6, 0.8};
  for (const double z : {0.0, 0.3, 0.8})
    for (int power = 0; power < 7; ++power) {
      const Eigen::MatrixXd w = derivative_weights(x, z);
      double first = 0, second = 0;
      for (std::size_t j = 0; j < x.size(); ++j) {
        first += w(static_cast<Eigen::Index>(j), 0) * std::pow(x[j], power);
        second += w(static_cast<Eigen::Index>(j), 1) * std::pow(x[j], power);
      }
      EXPECT_NEAR(first, power == 0 ? 0 : power * std::pow(z, power - 1), 1e-10);
      EXPECT_NEAR(second, power < 2 ? 0 : power * (power - 1) * std::pow(z, power - 2), 1e-8);
    }
}

// A motion of a four-bar as a table of all its coordinates comes through as it is; a table of one
// is closed to the same.
TEST(Effort, LoopsCloseWhatIsGivenInPart) {
  Scene bars = example("four_bar");
  bars.held.clear();
  bars.drives = {harmonic("O", 1.5707963267948966, 2.5, 2)};
  const EffortResult by_drive = along_drives(bars, 2);
  const Mechanism mechanism(undriven(bars));
  const Reference all = table_of(mechanism, by_drive.rows, true, true);
  for (const bool part : {false, true}) {
    std::vector<std::vector<double>> values;
    for (const auto& row : all.values()) values.push_back({row[0], row[3], row[6]});
    const Reference one("one", {all.columns()[0], all.columns()[3], all.columns()[6]}, all.times(),
                        values);
    EffortRequest request;
    request.motion.table = part ? &one : &all;
    request.actuated = {"O"};
    const EffortResult r = effort(mechanism, request);
    for (std::size_t i = 0; i < r.rows.size(); ++i) {
      EXPECT_LT((r.rows[i].q - by_drive.rows[i].q).cwiseAbs().maxCoeff(), 1e-12);
      EXPECT_NEAR(r.rows[i].effort[0], by_drive.rows[i].effort[0],
                  1e-10 * (1 + std::abs(by_drive.rows[i].effort[0])));
    }
  }
}

// What cannot be followed, what is left open, what nothing holds: a sentence each.
TEST(Effort, SaysWhatIsAmiss) {
  Scene bars = example("four_bar");
  bars.held.clear();
  bars.drives = {harmonic("O", 1.5707963267948966, 2.5, 2)};
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  Scene both = bars;
  both.drives.push_back(harmonic("C", 1.7, 0.1, 2));
  has(equations::thrown<SceneError>([&] { along_drives(both, 2); }), "cannot");
  Scene rocked = bars;  // beyond the rocker's dead point
  rocked.drives = {harmonic("C", 1.9, 1.2, 2)};
  has(equations::thrown<SceneError>([&] { along_drives(rocked, 2); }),
      "the loops cannot follow the motion: loop 'B'");
  const Scene shaken = example("driven");
  has(equations::thrown<SceneError>([&] { along_drives(shaken, 1); }),
      "leaves 1 degree of freedom open; expected as many more coordinates with a motion, or held, "
      "such as 'M.q'");
  EffortRequest half;
  half.motion.hold = {"O.q"};
  half.motion.poses_alone = true;
  half.motion.times = {0};
  Scene ball = bars;
  ball.loops.clear();
  ball.drives.clear();
  ball.joints[1].kind = JointKind::spherical;
  ball.joints[1].position.clear();
  has(equations::thrown<SceneError>([&] { effort(Mechanism(ball), half); }),
      "leaves 1 degree of freedom open; expected as many more coordinates with a motion, or held; "
      "those of 'A' take a motion alone");
  EffortRequest held;
  held.motion.hold = {"M"};
  has(equations::thrown<SceneError>([&] { along_drives(shaken, 1, held); }),
      "no actuator holds the motion of 'M.u' (1)");
  held.actuated = {"O", "M"};
  EXPECT_LT(residue(undriven(shaken), along_drives(shaken, 1, held)), 1e-12);
  Scene welded = bars;
  welded.loops.clear();
  welded.drives.clear();
  for (JointSpec& joint : welded.joints) {
    joint.kind = JointKind::weld;
    joint.position.clear();
    joint.velocity.clear();
  }
  for (const std::vector<std::string>& actuated : {{}, std::vector<std::string>{"O"}}) {
    EffortRequest still;
    still.motion.poses_alone = true;
    still.motion.times = {0};
    still.actuated = actuated;
    has(equations::thrown<SceneError>([&] { effort(Mechanism(welded), still); }),
        "all joints are welds, so that no effort is needed; expected a joint that moves");
  }
  EffortRequest wrong;
  wrong.actuated = {"X"};
  has(equations::thrown<SceneError>([&] { along_drives(bars, 1, wrong); }),
      "actuator 'X' is not known; expected 'O'");
  wrong.actuated = {"O", "O.q"};
  has(equations::thrown<SceneError>([&] { along_drives(bars, 1, wrong); }), "is named twice");
  wrong.actuated = {"O"};
  wrong.weights = {{"C", 1}};
  has(equations::thrown<SceneError>([&] { along_drives(bars, 1, wrong); }),
      "weight of 'C': it is not an actuator");
  wrong.weights = {{"O", -1}};
  has(equations::thrown<SceneError>([&] { along_drives(bars, 1, wrong); }),
      "expected a number above zero");
  const Mechanism open(undriven(bars));
  const Reference nothing("none.csv", {"B.x [m]"}, {0, 1, 2}, {{0}, {1}, {2}});
  EffortRequest table;
  table.motion.table = &nothing;
  table.actuated = {"O"};
  has(equations::thrown<SceneError>([&] { effort(open, table); }),
      "there is no column of a coordinate");
  const Reference degrees("degrees.csv", {"O.q [deg]"}, {0, 1, 2}, {{0}, {1}, {2}});
  table.motion.table = &degrees;
  has(equations::thrown<SceneError>([&] { effort(open, table); }),
      "found column 'O.q [deg]'; expected 'O.q [rad]'");
  const Reference two("two.csv", {"O.q [rad]"}, {0, 1}, {{1.5}, {1.6}});
  table.motion.table = &two;
  has(equations::thrown<SceneError>([&] { effort(open, table); }),
      "there are 2 rows; expected 3 at least");
  // Both ends of a linkage, one of them a little off: told, or let pass where that is asked for.
  const EffortResult right = along_drives(bars, 2);
  std::vector<double> when;
  std::vector<std::vector<double>> off;
  for (const EffortRow& row : right.rows) {
    when.push_back(row.t);
    off.push_back({row.q[0], row.q[2] + 1e-4});
  }
  const Reference apart("apart.csv", {"O.q [rad]", "C.q [rad]"}, when, off);
  table.motion.table = &apart;
  has(equations::thrown<SceneError>([&] { effort(open, table); }),
      "the loops cannot follow the motion: loop 'B' keeps '");
  has(equations::thrown<SceneError>([&] { effort(open, table); }), ".q' ");
  has(equations::thrown<SceneError>([&] { effort(open, table); }), " rad from what is given");
  table.within = 1e-3;
  const EffortResult let_pass = effort(open, table);
  EXPECT_GT(let_pass.gap, 1e-5);
  EXPECT_LT(let_pass.gap, 1e-4);
  Scene lifted = bars;
  lifted.drives[0].joint.clear();
  lifted.drives[0].loop = "B";
  lifted.drives[0].origin = "x";
  has(equations::thrown<SceneError>([&] { undriven(lifted); }),
      "drive of loop 'B': efforts are found of drives of joints");
}

}  // namespace
}  // namespace momenta::dae_effort
