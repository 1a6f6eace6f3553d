// Prescribed motion in loops, and couplers: the same motion as of driven joints wherever the scene
// is cut, motions known in closed form, and the power of what is prescribed.

#include "equations/dense_lagrangian.h"
#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/parts.h"
#include "equations/random_loops.h"
#include "equations/recut.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/run/run_form.h>

#include <numbers>

namespace momenta::dae_driven_loops {
namespace {

using namespace equations;
using Eigen::Vector3d;
using Eigen::VectorXd;

struct Way {
  std::string form = "momentum", integrator = "dop853", gauge = "leak:3";
  double tolerance = 1e-11, bound = 1e-8;
};
// What explicit forms and Newton's method on index 2 keep of each other.
const std::vector<Way> in_every_way{{},
                                    {"acceleration", "dop853", "none", 1e-11, 1e-8},
                                    {"baumgarte", "dop853", "none", 1e-10, 1e-7},
                                    {"momentum-index2", "ida", "leak:3", 1e-9, 3e-5},
                                    {"momentum-stabilised", "ida", "leak:3", 1e-9, 3e-5},
                                    {"acceleration-index1", "ida", "none", 1e-9, 3e-5},
                                    {"stabilised-index2", "ida", "none", 1e-9, 3e-5}};

/// The last sample by column; what moves along loops must keep to rounding.
std::map<std::string, double> end_of(const Mechanism& mechanism, const Way& how, double end) {
  const RunResult run = run_form(mechanism, equations::start_of(mechanism),
                                 equations::kept(equations::adaptive(
                                     how.form, how.integrator, how.gauge, how.tolerance, end, 4)));
  EXPECT_EQ(run.status, "done") << how.form << ": " << run.reason;
  std::map<std::string, double> last;
  if (run.trajectory.rows.empty()) return last;
  for (std::size_t i = 0; i < run.trajectory.columns.size(); ++i)
    last[run.trajectory.columns[i]] = run.trajectory.rows.back()[i];
  if (how.form == "momentum" && mechanism.m() > 0) {
    EXPECT_LT(last.at("velocity_drift [" + run.drift_unit + "/s]"), 1e-11);
  }
  return last;
}

DriveSpec harmonic(double offset, double amplitude, double frequency, double phase = 0) {
  DriveSpec d;
  d.kind = "harmonic";
  d.offset = offset;
  d.amplitude = amplitude;
  d.frequency = frequency;
  d.phase = phase;
  return d;
}

MarkerSpec marker(const std::string& name, const std::string& body, const Vector3d& point) {
  return equations::make_marker(name, body, point);
}

/// Every marker column alike.
void expect_same_markers(const std::map<std::string, double>& found,
                         const std::map<std::string, double>& expected, double bound,
                         const std::string& what) {
  int common = 0;
  for (const auto& [name, value] : expected) {
    if (name.rfind("tip.", 0) != 0) continue;
    ++common;
    ASSERT_TRUE(found.contains(name)) << what;
    EXPECT_NEAR(found.at(name), value, bound * (1 + std::abs(value))) << what << ": " << name;
  }
  EXPECT_EQ(common, 6) << what;
}

/// A four-bar whose crank is driven through turns, cut at the crank: a driven hinge closes it.
TEST(DrivenLoops, CrankOfAFourBarCutAtTheCrank) {
  Scene scene = equations::example("four_bar");
  DriveSpec d;
  d.kind = "polynomial";
  d.coefficients = {1.5707963267948966, 4, 0.5};  // one turn and a half in 2 s
  d.joint = "O";
  scene.drives.push_back(d);
  scene.held.clear();
  scene.markers = {marker("tip", "coupler", {1, 0.3, 0})};
  const Mechanism whole(scene);
  const Eigen::VectorXd q = assemble(whole).start.q;
  const auto expected = end_of(whole, {}, 2);
  const Scene other = recut(scene, whole.tree(), q, "O", "B");
  ASSERT_EQ(other.loops.size(), 1U);
  for (const Algebra algebra : {Algebra::planar, Algebra::spatial})
    for (const Way& how : in_every_way) {
      if (algebra == Algebra::spatial && how.form == "baumgarte") continue;  // told once
      const Mechanism mechanism(other, {.algebra = algebra});
      EXPECT_EQ(mechanism.plan().planar, algebra == Algebra::planar);
      EXPECT_EQ(assemble(mechanism).mobility, 0);
      expect_same_markers(end_of(mechanism, how, 2), expected, how.bound, how.form);
    }
  const Mechanism sparse(other, {.kkt = KktChoice::sparse}),
      dense(other, {.kkt = KktChoice::dense});
  expect_same_markers(end_of(sparse, {}, 2), expected, 1e-8, "sparse");
  expect_same_markers(end_of(dense, {}, 2), expected, 1e-8, "dense");
}

/// An arm on a joint of some kind from a swinging base, with a rod on its tip.
struct Arm {
  JointKind joint;
  LoopKind loop;
  int driven;  ///< by bits
};
Scene arm_on_a_joint(const Arm& arm) {
  Scene s;
  s.gravity = {0.3, -9.81, 1};
  s.bodies = {rod("base", 0.3), rod("arm", 0.2), rod("rod", 0.2)};
  s.joints = {hinge("H", "ground", "base", {0, 0, 0}, 0.4), hinge("K", "base", "arm", {1, 0, 0}, 0),
              hinge("R", "arm", "rod", {1, 0, 0}, 0.7)};
  s.joints[0].velocity = {0.6};
  JointSpec& k = s.joints[1];
  k.kind = arm.joint;
  k.rotation = Eigen::AngleAxisd(0.8, Vector3d(1, -2, 0.5).normalized());
  k.origin_child = {0.1, -0.2, 0.3};
  k.axis = Vector3d(0.3, -0.4, 1).normalized();
  k.position.clear();
  for (int i = 0; i < coordinates_of(arm.joint); ++i) k.position.push_back(0.2 + 0.1 * i);
  if (arm.joint == JointKind::spherical) k.position = {1, 0, 0, 0};
  for (int i = 0; i < rates_of(arm.joint); ++i) k.velocity.push_back(0.3 - 0.2 * i);
  if (arm.joint == JointKind::planar) k.direction = Vector3d(1, 0.2, 0.1).normalized();
  if (arm.joint == JointKind::universal) k.axis2 = Vector3d(1, 0.3, -0.2).normalized();
  s.joints[2].axis = Vector3d(0.2, 1, 0.1).normalized();
  s.markers = {marker("tip", "rod", {1, 0, 0})};
  for (int i = 0; i < rates_of(arm.joint); ++i) {
    if ((arm.driven >> i & 1) == 0) continue;
    DriveSpec d = harmonic(0.2 + 0.1 * i, 0.9, 1.7 + i, 0.4 * i);
    d.joint = "K";
    d.coordinate = i;
    s.drives.push_back(d);
  }
  return s;
}

/// The arm free, and the joint a loop driven alike; the free joint starts where the other has it.
Scene arm_on_a_loop(const Scene& scene, LoopKind kind) {
  const Tree tree = build_tree(scene);
  const DenseLagrangian motion(scene, tree);
  const std::vector<Real> q(tree.q0.begin(), tree.q0.end()), u(tree.u0.begin(), tree.u0.end());
  const auto moving = motion.moving(Real(0), q, u, true)[1];
  Scene s = scene;
  const JointSpec k = scene.joints[1];
  LoopSpec l =
      equations::make_loop(kind, k.name, k.parent, k.child, k.origin_parent, k.origin_child);
  l.rotation = k.rotation;
  l.axis = k.axis;
  l.axis2 = k.axis2;
  l.direction = k.direction;
  s.loops = {l};
  JointSpec& f = s.joints[1] = JointSpec{};
  f.name = "F";
  f.kind = JointKind::free;
  f.child = k.child;
  const Eigen::Isometry3d pose = motion.poses(0, tree.q0)[1];
  const auto in_body = [&](const Triple<Real>& v) {
    return Vector3d(pose.linear().transpose() * Vector3d(double(v[0]), double(v[1]), double(v[2])));
  };
  const Vector3d x = pose.translation(), v = in_body(moving.v), w = in_body(moving.w);
  const Eigen::Quaterniond turn(pose.linear());
  f.position = {x.x(), x.y(), x.z(), turn.w(), turn.x(), turn.y(), turn.z()};
  f.velocity = {v.x(), v.y(), v.z(), w.x(), w.y(), w.z()};
  for (DriveSpec& d : s.drives) std::swap(d.joint, d.loop);
  return s;
}

TEST(DrivenLoops, EveryKindMovesAsTheDrivenJoint) {
  const Arm arms[] = {{JointKind::revolute, LoopKind::revolute, 1},
                      {JointKind::prismatic, LoopKind::prismatic, 1},
                      {JointKind::cylindrical, LoopKind::cylindrical, 1},
                      {JointKind::cylindrical, LoopKind::cylindrical, 2},
                      {JointKind::cylindrical, LoopKind::cylindrical, 3},
                      {JointKind::universal, LoopKind::universal, 1},
                      {JointKind::universal, LoopKind::universal, 2},
                      {JointKind::universal, LoopKind::universal, 3},
                      {JointKind::planar, LoopKind::planar, 1},
                      {JointKind::planar, LoopKind::planar, 2},
                      {JointKind::planar, LoopKind::planar, 5},
                      {JointKind::planar, LoopKind::planar, 6},
                      {JointKind::planar, LoopKind::planar, 7},
                      {JointKind::spherical, LoopKind::spherical, 7},
                      {JointKind::universal, LoopKind::universal, 0},
                      {JointKind::planar, LoopKind::planar, 0}};
  for (const Arm& arm : arms) {
    const Scene joint = arm_on_a_joint(arm), loop = arm_on_a_loop(joint, arm.loop);
    const auto expected = end_of(Mechanism(joint), {}, 1.2);
    const Mechanism mechanism(loop);
    EXPECT_EQ(assemble(mechanism).mobility, Mechanism(joint).nv());
    for (const Way& how : in_every_way) {
      if (how.integrator == "ida" && how.form != "momentum-index2") continue;
      expect_same_markers(end_of(mechanism, how, 1.2), expected, how.bound,
                          how.form + " " + mechanism.rows().back().what + " " +
                              std::to_string(static_cast<int>(arm.loop)) + " " +
                              std::to_string(arm.driven));
    }
  }
}

/// A rod hung by its end from a point that moves level, as on a driven slide, and from one that
/// moves in space, as on a driven free joint.
TEST(DrivenLoops, PendulumFromAMovingPivot) {
  for (const bool in_space : {false, true}) {
    Scene joint;
    joint.gravity = {0, -9.81, 0};
    joint.bodies = {BodySpec{}, rod("rod", 0.2)};
    joint.bodies[0].name = "pivot";
    joint.markers = {marker("tip", "rod", {1, 0, 0})};
    Scene loop = joint;
    loop.bodies.erase(loop.bodies.begin());
    JointSpec pivot;
    pivot.name = "P";
    pivot.child = "pivot";
    pivot.kind = in_space ? JointKind::free : JointKind::prismatic;
    pivot.axis = Vector3d::UnitX();
    joint.joints = {pivot, hinge("H", "pivot", "rod", {0, 0, 0}, -1.2)};
    JointSpec free;
    free.name = "F";
    free.child = "rod";
    free.kind = in_space ? JointKind::free : JointKind::planar;
    LoopSpec l = equations::make_loop(in_space ? LoopKind::spherical : LoopKind::point, "C",
                                      "ground", "rod");
    l.origin_parent = {in_space ? 0.0 : 7.0, 0, 0};  // x is the drive's
    loop.loops = {l};
    if (in_space) {
      joint.joints[1].kind = JointKind::spherical;
      const Eigen::Quaterniond start(Eigen::AngleAxisd(-1.2, Vector3d(0.1, 0.3, 1).normalized()));
      joint.joints[1].position = {start.w(), start.x(), start.y(), start.z()};
      free.position = {0.1, 0.2, 0.3, start.w(), start.x(), start.y(), start.z()};
    } else {
      free.position = {0.1, 0, -1.2};
    }
    for (int i = 0; i < (in_space ? 6 : 1); ++i) {
      DriveSpec d =
          i < 3 ? harmonic(0.1 + 0.1 * i, 0.4, 3 + i, std::numbers::pi / 2) : harmonic(0, 0, 1);
      d.joint = "P";
      d.coordinate = i;
      joint.drives.push_back(d);
      if (i > 2) continue;
      d.joint = "";
      d.coordinate = 0;
      d.loop = "C";
      d.origin = std::string(1, static_cast<char>('x' + i));
      d.offset += 0;
      loop.drives.push_back(d);
    }
    for (int i = 0; i < (in_space ? 3 : 1); ++i) free.position[static_cast<std::size_t>(i)] += 0.4;
    loop.joints = {free};
    const auto expected = end_of(Mechanism(joint), {}, 2);
    const Mechanism mechanism(loop);
    EXPECT_EQ(mechanism.plan().planar, !in_space);
    for (const Way& how : in_every_way)
      expect_same_markers(end_of(mechanism, how, 2), expected, how.bound, how.form);
  }
}

/// A mass on a rope pulled in at constant speed, no gravity: l² φ̇ stays, so φ = l₀² φ̇₀ ∫ dt/l².
TEST(DrivenLoops, RopePulledInKeepsItsAngularMomentum) {
  const double l0 = 1.5, speed = 0.4, spin = 2, end = 2;
  for (const Algebra algebra : {Algebra::planar, Algebra::spatial}) {
    Scene s;
    BodySpec mass;
    mass.name = "mass";
    mass.mass = 2;
    mass.inertia = Vector3d(0.1, 0.1, 0.1).asDiagonal();
    s.bodies = {mass};
    JointSpec free = equations::make_joint(JointKind::planar, "F", "ground", "mass", {0, 0, 0},
                                           {0, 0, 1}, {l0, 0, 0});
    free.velocity = {-speed, l0 * spin, 0.3};
    s.joints = {free};
    LoopSpec rope;
    rope.name = "rope";
    rope.child = "mass";
    rope.kind = LoopKind::distance;
    s.loops = {rope};
    DriveSpec d;
    d.loop = "rope";
    d.kind = "polynomial";
    d.coefficients = {l0, -speed};
    s.drives = {d};
    s.markers = {marker("tip", "mass", {0, 0, 0})};
    const double l = l0 - speed * end, phi = l0 * l0 * spin / speed * (1 / l - 1 / l0);
    for (const Way& how : in_every_way) {
      const auto found = end_of(Mechanism(s, {.algebra = algebra}), how, end);
      // IDA's bound holds for q of order one; the mass has turned by more than 6 rad.
      EXPECT_NEAR(found.at("tip.x [m]"), l * std::cos(phi), 3 * how.bound) << how.form;
      EXPECT_NEAR(found.at("tip.y [m]"), l * std::sin(phi), 3 * how.bound) << how.form;
      const double momentum = found.at("tip.x [m]") * found.at("tip.vy [m/s]") -
                              found.at("tip.y [m]") * found.at("tip.vx [m/s]");
      EXPECT_NEAR(momentum, l0 * l0 * spin, 30 * how.bound) << how.form;
    }
  }
}

/// Two rods with q₂ = n q₁ − c: (I + n² I) q̈ = −m g/2 (cos q₁ + n cos q₂), one degree of freedom.
TEST(Couplers, PairOfPendulumsIsOneDegreeOfFreedom) {
  const double n = 1.5, c = 0.4, g = 9.81, end = 1.5, inertia = 1.0 / 3, start = -0.3;
  double q = start, u = 0;
  const int steps = 6000;
  const auto rate = [&](double x) {
    return -0.5 * g * (std::cos(x) + n * std::cos(n * x - c)) / (inertia * (1 + n * n));
  };
  for (int i = 0; i < steps; ++i) {  // RK4: error about 1e-13
    const double h = end / steps, a1 = rate(q), a2 = rate(q + 0.5 * h * u),
                 a3 = rate(q + 0.5 * h * (u + 0.5 * h * a1)), a4 = rate(q + h * (u + 0.5 * h * a2));
    q += h * (u + h / 6 * (a1 + a2 + a3));
    u += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  for (const Algebra algebra : {Algebra::planar, Algebra::spatial}) {
    Scene s;
    s.gravity = {0, -g, 0};
    s.bodies = {rod("first"), rod("second")};
    s.joints = {hinge("A", "ground", "first", {0, 0, 0}, start),
                hinge("B", "ground", "second", {3, 0, 0}, n * start - c)};
    LoopSpec gear;
    gear.name = "gear";
    gear.kind = LoopKind::coupler;
    gear.joints = {"A", "B"};
    gear.ratios = {n, -1};
    gear.offset = c;
    s.loops = {gear};
    for (const KktChoice kkt : {KktChoice::sweeps, KktChoice::sparse, KktChoice::dense})
      for (const Way& how : in_every_way) {
        if (kkt != KktChoice::sweeps && how.form != "momentum") continue;
        const Mechanism mechanism(s, {.algebra = algebra, .kkt = kkt});
        EXPECT_EQ(mechanism.m(), 1);
        const auto found = end_of(mechanism, how, end);
        EXPECT_NEAR(found.at("A.q [rad]"), q, 3 * how.bound) << how.form;
        EXPECT_NEAR(found.at("B.q [rad]"), n * q - c, 3 * how.bound) << how.form;
        EXPECT_NEAR(found.at("A.u [rad/s]"), u, 30 * how.bound) << how.form;
      }
  }
}

/// A coupler with a driven joint in it prescribes the others: as their own drive.
TEST(Couplers, DrivenShaftDrivesTheOther) {
  Scene s;
  s.gravity = {0, -9.81, 0};
  s.bodies = {rod("shaft"), rod("wheel"), rod("rod")};
  s.joints = {hinge("A", "ground", "shaft", {0, 0, 0}, 0),
              hinge("B", "ground", "wheel", {3, 0, 0}, 0.3),
              hinge("C", "wheel", "rod", {1, 0, 0}, 0.5)};
  s.markers = {marker("tip", "rod", {1, 0, 0})};
  DriveSpec d = harmonic(0.1, 0.8, 2.5);
  d.joint = "A";
  s.drives = {d};
  LoopSpec gear;
  gear.name = "gear";
  gear.kind = LoopKind::coupler;
  gear.joints = {"A", "B"};
  gear.ratios = {2, 1};  // B = 0.5 − 2 A
  gear.offset = 0.5;
  Scene direct = s;
  s.loops = {gear};
  DriveSpec second = harmonic(0.5 - 0.2, -1.6, 2.5);
  second.joint = "B";
  direct.drives.push_back(second);
  const auto expected = end_of(Mechanism(direct), {}, 2);
  for (const Way& how : in_every_way)
    expect_same_markers(end_of(Mechanism(s), how, 2), expected, how.bound, how.form);
}

/// dE/dt = λᵀΦ_t: what prescribed motion puts in. E by differences along the motion.
TEST(DrivenLoops, PowerOfWhatIsPrescribed) {
  int tried = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    RandomTree random(seed);
    const TreeRecipe recipe{
        .bodies = 5, .drives = false, .joint_forces = false, .body_forces = false};
    Scene scene = random.scene(recipe);
    const LoopKind kind = loop_kinds[seed % loop_kinds.size()];
    if (const auto coupler = random_coupler(random, scene); coupler && seed % 2 == 0) {
      scene.loops.push_back(*coupler);
      drive_loop(random, scene, *coupler, 1, 0);
    }
    scene.loops.push_back(random_loop(random, scene, kind));
    drive_loop(random, scene, scene.loops.back(), 1 + random.below(7), random.below(8));
    const Mechanism mechanism(scene, {.algebra = Algebra::spatial});
    const int nv = mechanism.nv(), m = mechanism.m();
    if (m > nv) continue;
    const auto e = mechanism.evaluation<double>();
    const auto solver = make_loop_solver(mechanism, *e);
    const TreeState s = random.state(mechanism.tree());
    VectorXd u(nv), sigma(m), udot(nv), lambda(m), moving(m), qdot(mechanism.nq());
    ASSERT_TRUE(solver->momentum(s.t, s.q.data(), s.u.data(), nullptr, 1e-13, 0, u.data(),
                                 sigma.data(), nullptr));
    ASSERT_TRUE(
        solver->acceleration(s.t, s.q.data(), u.data(), nullptr, 0, 0, udot.data(), lambda.data()));
    if (!(lambda.norm() < 300) || !(udot.norm() < 300)) continue;
    ++tried;
    e->place(s.t, s.q.data());
    e->move(nullptr);
    e->velocities(moving.data());
    e->coordinate_rates(s.q.data(), u.data(), qdot.data());
    const auto energy = [&](double h) {
      const VectorXd q = s.q + h * qdot, v = u + h * udot;
      e->place(s.t + h, q.data());
      e->move(v.data());
      return e->kinetic() + e->potential(q.data());
    };
    const double h = 2e-4;  // of fourth order
    const double rate =
        (8 * (energy(h) - energy(-h)) - (energy(2 * h) - energy(-2 * h))) / (12 * h);
    const double power = lambda.dot(moving), size = 1 + lambda.norm() * moving.norm();
    EXPECT_NEAR(rate, power, 1e-6 * size) << seed;
  }
  EXPECT_GT(tried, 25);
}

}  // namespace
}  // namespace momenta::dae_driven_loops
