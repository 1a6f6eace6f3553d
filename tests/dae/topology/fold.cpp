// However a mechanism is written, it moves alike: bodies welded to others, and rotors that are
// bodies behind a gear, beside the same scene with them folded away. Random scenes with loops,
// drives and forces of every kind, closed at their start.

#include "equations/parts.h"
#include "equations/point_motions.h"
#include "equations/random_loops.h"
#include "equations/random_tree.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/open_chain/open_chain.h>
#include <momenta/core/scene/drive.h>
#include <momenta/dae/run/state_values.h>
#include <momenta/dae/topology/assembly/assembly.h>
#include <momenta/dae/topology/cut/fold_rotors.h>
#include <momenta/dae/topology/cut/fold_welds.h>
#include <momenta/dae/topology/cut/interchange.h>

#include <map>

namespace momenta::dae_fold {
namespace {

using namespace equations;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

StateValues at(const Mechanism& mechanism, double t, const VectorXd& q, const VectorXd& u) {
  GivenState given;
  given.t = t;
  given.q = q;
  given.v = u;
  given.p = given.tau = VectorXd::Zero(mechanism.nv());
  return evaluate_state(mechanism, given);
}

/// The place of each rate of `one` in `other`, joint by joint; −1: not there.
std::vector<int> rates_of_in(const Mechanism& one, const Mechanism& other) {
  std::map<std::pair<std::string, int>, int> places;
  for (const Tree::Body& b : other.tree().bodies) places[{b.joint, b.part}] = b.u;
  std::vector<int> all(static_cast<std::size_t>(one.nv()), -1);
  for (const Tree::Body& b : one.tree().bodies)
    if (const auto found = places.find({b.joint, b.part}); found != places.end())
      for (int i = 0; i < b.nv; ++i) all[static_cast<std::size_t>(b.u + i)] = found->second + i;
  return all;
}

/// The scene that starts where it is assembled; nothing where it is near a singular pose, or its
/// drives ask for what loops do not let them.
std::optional<Scene> started(const Scene& scene) try {
  const Mechanism mechanism(scene);
  const Assembly a = assemble(mechanism);
  if (a.kept > 0 && a.kept < 1e-3) return std::nullopt;
  Scene s = scene;
  s.joints = joints_at(mechanism, a.start);
  return s;
} catch (const SceneError&) {
  return std::nullopt;
}

double largest(const VectorXd& x) {
  return x.size() == 0 ? 0 : x.cwiseAbs().maxCoeff();
}

/// Accelerations, M, kinetic energy, markers at the start; and the work of all forces with a
/// potential from there to another pose.
void expect_alike(const Scene& written, const Scene& folded, bool same_mass, bool same_energy,
                  unsigned seed) {
  const Mechanism one(written), other(folded);
  const std::vector<int> place = rates_of_in(one, other);
  const StateValues a = at(one, 0, one.tree().q0, one.tree().u0);
  const StateValues b = at(other, 0, other.tree().q0, other.tree().u0);
  const VectorXd& accelerations = one.m() > 0 ? a.constrained : a.free;
  const VectorXd& others = other.m() > 0 ? b.constrained : b.free;
  const double size = 1 + largest(accelerations), tolerance = 1e-9 * size;
  for (int i = 0; i < one.nv(); ++i) {
    const int k = place[static_cast<std::size_t>(i)];
    if (k >= 0) {
      EXPECT_NEAR(others[k], accelerations[i], tolerance) << seed << " rate " << i;
    }
  }
  if (same_energy) {
    EXPECT_NEAR(b.kinetic, a.kinetic, algebra_tol(100) * (1 + a.kinetic)) << seed;
  }
  for (int i = 0; same_mass && i < one.nv(); ++i)
    for (int j = 0; j <= i; ++j) {
      const int k = place[static_cast<std::size_t>(i)], l = place[static_cast<std::size_t>(j)];
      EXPECT_NEAR(b.mass(std::max(k, l), std::min(k, l)), a.mass(i, j),
                  algebra_tol(100) * (1 + a.mass.cwiseAbs().maxCoeff()))
          << seed;
    }
  std::map<std::string, std::size_t> marker;
  for (std::size_t i = 0; i < folded.markers.size(); ++i) marker[folded.markers[i].name] = i;
  for (std::size_t i = 0; i < written.markers.size(); ++i) {
    const auto found = marker.find(written.markers[i].name);
    for (std::size_t c = 0; found != marker.end() && c < 6; ++c)
      EXPECT_NEAR(b.markers[6 * found->second + c], a.markers[6 * i + c],
                  algebra_tol(100) * (1 + std::abs(a.markers[6 * i + c])))
          << seed << " " << written.markers[i].name;
  }
  // along the rates to another pose
  const auto onward = [](const Mechanism& m, const VectorXd& u) {
    const auto e = m.evaluation<double>();
    VectorXd q = m.tree().q0, qdot(m.nq());
    e->coordinate_rates(q.data(), u.data(), qdot.data());
    q += 0.3 * qdot;
    m.tree().normalise(q);
    return q;
  };
  const double v = at(one, 0, onward(one, one.tree().u0), one.tree().u0).potential - a.potential;
  const double w =
      at(other, 0, onward(other, other.tree().u0), other.tree().u0).potential - b.potential;
  EXPECT_NEAR(w, v, algebra_tol(1000) * (1 + std::abs(a.potential) + std::abs(v))) << seed;
}

/// Closed as the bodies stand at q, t = 0.
LoopSpec closed_loop(RandomTree& random, const Scene& scene, LoopKind kind,
                     const std::map<std::string, Isometry3d>& poses) {
  LoopSpec l = random_loop(random, scene, kind);
  const Isometry3d between = poses.at(l.parent).inverse() * poses.at(l.child);
  const Vector3d there = between * l.origin_child;
  if (kind == LoopKind::distance) {
    l.length = (there - l.origin_parent).norm();
    return l;
  }
  l.origin_parent = there;
  l.rotation = Quaterniond(between.linear()).normalized();
  return l;
}

/// Its drives start where the loop is closed.
void drive_closed(RandomTree& random, Scene& scene, const LoopSpec& l) {
  const std::size_t before = scene.drives.size();
  drive_loop(random, scene, l, random.below(8), random.below(4) * random.below(4));
  for (std::size_t i = before; i < scene.drives.size(); ++i) {
    DriveSpec& d = scene.drives[i];
    const double from = !d.origin.empty()              ? l.origin_parent[d.origin[0] - 'x']
                        : l.kind == LoopKind::distance ? l.length
                                                       : 0;
    DriveSpec anew;
    anew.loop = d.loop;
    anew.coordinate = d.coordinate;
    anew.origin = d.origin;
    anew.kind = "polynomial";
    anew.coefficients = {from, random.uniform(-1, 1), random.uniform(-1, 1)};
    d = anew;
  }
}

/// The scene with its joints anywhere, loops open.
Scene at_random_state(RandomTree& random, Scene scene) {
  const Mechanism mechanism(scene);
  const TreeState s = random.state(mechanism.tree());
  Start start;
  start.q = s.q;
  start.u = s.u;
  scene.joints = joints_at(mechanism, start);
  return scene;
}

/// A random tree, half of whose joints are welds, at a random state.
Scene welded(RandomTree& random, bool flat, int bodies) {
  TreeRecipe recipe{.bodies = bodies};
  if (!flat) recipe.kinds.insert(recipe.kinds.end(), 6, JointKind::weld);
  recipe.kinds.insert(recipe.kinds.end(), 3, JointKind::weld);
  return marked(at_random_state(random, flat ? random.planar_scene(recipe) : random.scene(recipe)));
}

std::map<std::string, Isometry3d> poses_of(const Scene& scene) {
  OpenChain chain(scene);
  const auto poses = chain.poses(0, chain.tree().q0);
  std::map<std::string, Isometry3d> all{{"ground", Isometry3d::Identity()}};
  for (const BodySpec& b : scene.bodies)
    all[b.name] = poses[static_cast<std::size_t>(chain.tree().body(b.name))];
  return all;
}

TEST(Fold, WeldedBodiesMoveWithTheirCarriers) {
  int carried = 0, trees = 0;
  for (unsigned seed = 0; seed < 80; ++seed) {
    RandomTree random(seed);
    const Scene scene = welded(random, seed % 2, 7);
    const FoldedScene folded = fold_welds(scene);
    if (!folded.folds()) continue;
    ++trees;
    carried += static_cast<int>(folded.carried.size());
    for (const JointSpec& j : folded.scene.joints) EXPECT_NE(j.kind, JointKind::weld);
    expect_alike(scene, folded.scene, true, true, seed);
    const auto before = poses_of(scene), after = poses_of(folded.scene);
    for (const CarriedBody& c : folded.carried)
      EXPECT_LT((before.at(c.body).matrix() - (after.at(c.carrier) * c.pose).matrix())
                    .cwiseAbs()
                    .maxCoeff(),
                1e-13)
          << seed << " " << c.body;
    EXPECT_EQ(Mechanism(folded.scene).plan().planar, Mechanism(scene).plan().planar) << seed;
  }
  EXPECT_GT(trees, 60);
  EXPECT_GT(carried, 180);
}

TEST(Fold, LoopsOfWeldedBodiesHoldTheirCarriers) {
  std::map<LoopKind, int> compared, turned;
  int stayed = 0, driven = 0;
  for (unsigned seed = 0; seed < 1200; ++seed) {
    RandomTree random(1000 + seed);
    Scene scene = welded(random, false, 8);
    const LoopKind kind = loop_kinds[seed % loop_kinds.size()];
    const LoopSpec loop = closed_loop(random, scene, kind, poses_of(scene));
    scene.loops.push_back(loop);
    if (seed / 2 % 2 == 0) drive_closed(random, scene, loop);
    if (const auto coupler = random_coupler(random, scene)) {
      LoopSpec c = *coupler;
      const Mechanism mechanism(scene);
      c.offset = 0;
      for (std::size_t i = 0; i < c.joints.size(); ++i)
        for (const Tree::Body& b : mechanism.tree().bodies)
          if (b.joint == c.joints[i] && b.coordinate == c.coordinates[i] && b.drive < 0)
            c.offset += c.ratios[i] * mechanism.tree().q0[b.q];
      bool any_driven = false;
      for (const DriveSpec& d : scene.drives)
        for (const std::string& joint : c.joints) any_driven |= d.joint == joint;
      if (!any_driven) scene.loops.push_back(c);
    }
    const auto written = started(scene);
    if (!written) continue;
    const FoldedScene folded = fold_welds(*written);
    if (!folded.folds()) continue;
    expect_alike(*written, folded.scene, true, true, seed);
    ++compared[kind];
    driven += std::any_of(written->drives.begin(), written->drives.end(),
                          [&](const DriveSpec& d) { return d.loop == loop.name; });
    stayed += std::any_of(folded.scene.joints.begin(), folded.scene.joints.end(),
                          [](const JointSpec& j) { return j.kind == JointKind::weld; });
    turned[kind] += std::any_of(
        folded.carried.begin(), folded.carried.end(),
        [&](const CarriedBody& c) { return c.body == loop.child && c.carrier == "ground"; });
    if (HasFailure()) break;
  }
  for (const LoopKind kind : loop_kinds) {
    EXPECT_GT(compared[kind], 20) << static_cast<int>(kind);
    if (kind == LoopKind::slot) continue;  // it has no other way round
    EXPECT_GT(turned[kind], 0) << static_cast<int>(kind);
  }
  EXPECT_GT(stayed, 10);
  EXPECT_GT(driven, 10);
}

/// A wheel of any moments on an axis through its centre of mass, anywhere.
void add_wheel(RandomTree& random, Scene& scene, const std::string& name,
               const std::string& parent) {
  BodySpec wheel;
  wheel.name = name;
  wheel.mass = random.chance(0.2) ? 0 : random.uniform(0.1, 1);
  wheel.inertia = random.inertia(1);
  JointSpec pin;
  pin.name = "pin of " + name;
  pin.parent = parent;
  pin.child = name;
  pin.origin_parent = random.vector(0.5);
  pin.origin_child = random.vector(0.5);
  pin.rotation = random.turn();
  pin.axis = random.direction();
  wheel.com = pin.origin_child + random.uniform(-0.5, 0.5) * pin.axis;
  if (random.chance(0.3)) pin.rotor_inertia = {random.uniform(0, 1)};
  scene.bodies.push_back(wheel);
  scene.joints.push_back(pin);
}

void add_gear(RandomTree& random, Scene& scene, const std::string& joint, int coordinate,
              const std::string& pin) {
  LoopSpec gear;
  gear.name = "gear of " + pin;
  gear.kind = LoopKind::coupler;
  gear.joints = {joint, pin};
  gear.coordinates = {coordinate, 0};
  gear.ratios = {random.uniform(0.5, 2), random.uniform(-2, -0.5)};
  if (random.chance(0.5)) {
    std::swap(gear.joints[0], gear.joints[1]);
    std::swap(gear.coordinates[0], gear.coordinates[1]);
  }
  gear.offset = random.uniform(-1, 1);
  scene.loops.push_back(gear);
}

void add_forces(RandomTree& random, Scene& scene, JointSpec& joint) {
  joint.stiffness = random.uniform(0, 10);
  joint.rest = random.uniform(-1, 1);
  joint.damping = random.uniform(0, 2);
  ForceSpec torque;
  torque.kind = "torque";
  torque.joint = joint.name;
  torque.value = random.uniform(-3, 3);
  scene.forces.push_back(torque);
}

/// A random tree on a slide, wheels on the ground and on the slide behind gears, one behind
/// another.
Scene geared(RandomTree& random, int& wheels) {
  Scene scene = random.scene({.bodies = 4, .rotors = random.chance(0.5)});
  for (JointSpec& j : scene.joints) {
    if (scalar_coordinates_of(j.kind) == 0) continue;
    j.position.assign(scalar_coordinates_of(j.kind), random.uniform(-1, 1));
    j.velocity.assign(scalar_coordinates_of(j.kind), random.uniform(-1, 1));
  }
  BodySpec carriage;
  carriage.name = "carriage";
  carriage.mass = 2;
  carriage.inertia.setIdentity();
  JointSpec slide;
  slide.name = "slide";
  slide.kind = JointKind::prismatic;
  slide.child = carriage.name;
  slide.axis = random.direction();
  slide.velocity = {random.uniform(-1, 1)};
  for (JointSpec& j : scene.joints)
    if (j.parent == "ground" && random.chance(0.5)) j.parent = carriage.name;
  scene.bodies.push_back(carriage);
  scene.joints.push_back(slide);
  const std::vector<JointSpec> leaders = scene.joints;
  wheels = 0;
  for (const JointSpec& leader : leaders) {
    if (scalar_coordinates_of(leader.kind) == 0) continue;
    const int coordinate = random.below(static_cast<int>(scalar_coordinates_of(leader.kind)));
    std::string joint = leader.name;
    bool driven = false;
    for (const DriveSpec& d : scene.drives) driven |= d.joint == joint;
    for (int k = random.below(3); k > 0; --k, ++wheels) {
      const std::string name = "wheel" + std::to_string(wheels);
      const bool behind = joint != leader.name;
      add_wheel(random, scene, name, random.chance(0.5) ? "ground" : carriage.name);
      if (!driven && has_one_coordinate(leader.kind) && random.chance(0.5))
        add_forces(random, scene, scene.joints.back());
      add_gear(random, scene, joint, behind ? 0 : coordinate, scene.joints.back().name);
      if (random.chance(0.5)) joint = scene.joints.back().name;
    }
  }
  // wheels before what they follow, and after it
  if (random.chance(0.5)) std::reverse(scene.joints.begin(), scene.joints.end());
  return marked(scene);
}

TEST(Fold, WheelsBehindGearsAreNumbersOnJoints) {
  int rotors = 0;
  for (unsigned seed = 0; seed < 150; ++seed) {
    RandomTree random(seed);
    int wheels = 0;
    const Scene scene = geared(random, wheels);
    if (wheels == 0) continue;
    const auto written = started(scene);
    if (!written) continue;
    const FoldedScene folded = fold_rotors(*written);
    EXPECT_EQ(folded.following.size(), static_cast<std::size_t>(wheels)) << seed;
    EXPECT_TRUE(folded.scene.loops.empty()) << seed;
    rotors += wheels;
    // on a driven coordinate a rotor's inertia has no effect, on kinetic energies neither
    bool driven = false;
    for (const FollowingJoint& f : folded.following)
      for (const DriveSpec& d : scene.drives)
        driven |= d.joint == f.leader && d.coordinate == f.coordinate;
    expect_alike(*written, folded.scene, false, !driven, seed);
    const Mechanism mechanism(*written);
    std::map<std::pair<std::string, int>, double> q;
    for (const JointSpec& j : written->joints)
      for (std::size_t i = 0; i < j.position.size(); ++i)
        q[{j.name, static_cast<int>(i)}] = j.position[i];
    for (const DriveSpec& d : written->drives) {
      double rate, second;
      MotionLaw(d).evaluate(0.0, q[{d.joint, d.coordinate}], rate, second);
    }
    for (const FollowingJoint& f : folded.following)
      EXPECT_NEAR((q[{f.joint, 0}]), (f.ratio * q[{f.leader, f.coordinate}] + f.offset), 1e-10)
          << seed << " " << f.joint;
    if (HasFailure()) break;
  }
  EXPECT_GT(rotors, 200);
}

/// A wheel on one of the two bodies of a joint, about its axis or against it, that a gear turns
/// with its angle.
void add_rotor(RandomTree& random, Scene& scene, const std::string& name, const JointSpec& leader,
               int coordinate, const std::string& carrier) {
  const bool outer = carrier == leader.child;
  add_wheel(random, scene, name, carrier);
  BodySpec& wheel = scene.bodies.back();
  JointSpec& pin = scene.joints.back();
  const Vector3d axis = outer ? leader.axis : leader.rotation * leader.axis;
  const double sense = random.chance(0.5) ? 1 : -1;
  pin.rotation = Quaterniond::FromTwoVectors(pin.axis, sense * axis);
  pin.rotation.normalize();
  const double along = random.uniform(0.0005, 0.002), across = random.uniform(0.5, 2) * along;
  wheel.inertia =
      across * Matrix3d::Identity() + (along - across) * pin.axis * pin.axis.transpose();
  wheel.mass *= 0.2;
  add_gear(random, scene, leader.name, coordinate, pin.name);
  LoopSpec& gear = scene.loops.back();
  gear.ratios[gear.joints[0] == pin.name ? 1 : 0] *= 3;
}

/// What turns, and about one axis, in trees in the plane or in space; loops in half of them.
TEST(Fold, RotorsOnBodiesThatTurnAreMomentsOfBothBodies) {
  int rotors = 0, all = 0, looped = 0, spatial = 0;
  for (unsigned seed = 0; seed < 240; ++seed) {
    RandomTree random(5000 + seed);
    const bool flat = seed % 3 == 0;
    const TreeRecipe recipe{.bodies = 5, .rotors = false};
    Scene scene = flat ? random.planar_scene(recipe) : random.scene(recipe);
    const Mechanism open(scene);
    Start start;
    const TreeState state = random.state(open.tree());
    start.q = state.q;
    start.u = state.u;
    scene.joints = joints_at(open, start);
    if (seed % 2 == 0)
      scene.loops.push_back(closed_loop(random, scene, LoopKind::distance, poses_of(scene)));
    int wheels = 0;
    const std::vector<JointSpec> leaders = scene.joints;
    for (const JointSpec& leader : leaders) {
      const bool turns = leader.kind == JointKind::revolute || leader.kind == JointKind::helical ||
                         leader.kind == JointKind::cylindrical || leader.kind == JointKind::planar;
      if (!turns) continue;
      const int coordinate = rates_of(leader.kind) - 1;
      for (int k = random.below(3); k > 0; --k, ++wheels)
        add_rotor(random, scene, "rotor" + std::to_string(wheels), leader, coordinate,
                  random.chance(0.5) ? leader.parent : leader.child);
    }
    if (wheels == 0) continue;
    const auto written = started(marked(scene));
    if (!written) continue;
    const FoldedScene folded = fold_rotors(*written);
    all += wheels;
    rotors += static_cast<int>(folded.following.size());
    if (!folded.folds()) continue;
    looped += folded.scene.loops.size() == 1;
    bool driven = false;
    for (const FollowingJoint& f : folded.following)
      for (const DriveSpec& d : scene.drives)
        driven |= d.joint == f.leader && d.coordinate == f.coordinate;
    expect_alike(*written, folded.scene, false, !driven, seed);
    EXPECT_EQ(Mechanism(folded.scene).plan().planar, Mechanism(*written).plan().planar) << seed;
    spatial += !Mechanism(folded.scene).plan().planar;
    if (HasFailure()) break;
  }
  // ratios between 0 and 1, and moments that bodies do not have, stay
  EXPECT_GT(rotors, all / 2);
  EXPECT_GT(rotors, 200);
  EXPECT_GT(looped, 30);
  EXPECT_GT(spatial, 80);
}

TEST(Fold, RobotsLoseTheirRotorsAndFrames) {
  const std::filesystem::path models =
      std::filesystem::path(MOMENTA_SOURCE_DIR) / "examples" / "models";
  struct Robot {
    const char* file;
    std::size_t bodies, rotors;
  };
  for (const Robot& robot :
       {Robot{"urdfplus/mini_cheetah.urdf", 13, 12},
        Robot{"urdfplus/revolute_rotor_chain.urdf", 3, 3}, Robot{"panda_urdf/panda.urdf", 9, 0}}) {
    RandomTree random(7);
    const Scene scene = at_random_state(random, read_scene(models / robot.file));
    const auto written = started(marked(scene));
    ASSERT_TRUE(written) << robot.file;
    const FoldedScene folded = fold(*written);
    EXPECT_EQ(folded.scene.bodies.size(), robot.bodies) << robot.file;
    EXPECT_EQ(folded.following.size(), robot.rotors) << robot.file;
    expect_alike(*written, folded.scene, false, true, 0);
  }
}

/// A hinged link, and a wheel on the ground that a gear turns with it.
Scene link_and_wheel() {
  Scene scene;
  scene.gravity = {0, -9.81, 0};
  for (const char* name : {"link", "wheel"}) {
    BodySpec body = equations::make_body(name, 1, {0.02, 0.02, 0.02});
    JointSpec joint;
    joint.name = std::string("hinge of ") + name;
    joint.child = name;
    scene.bodies.push_back(body);
    scene.joints.push_back(joint);
  }
  scene.bodies[0].com = {0.5, 0, 0};
  LoopSpec gear;
  gear.name = "gear";
  gear.kind = LoopKind::coupler;
  gear.joints = {"hinge of link", "hinge of wheel"};
  gear.ratios = {3, -1};
  scene.loops.push_back(gear);
  return scene;
}

TEST(Fold, WhatIsNoRotorStays) {
  const Scene scene = link_and_wheel();
  const FoldedScene folded = fold(scene);
  ASSERT_EQ(folded.scene.joints.size(), 1U);
  EXPECT_DOUBLE_EQ(folded.scene.joints[0].rotor_inertia.at(0), 0.18);
  EXPECT_EQ(in_words(folded), "rotor 'wheel' taken as 0.18 kg m² at joint 'hinge of link'");
  const auto stays = [&](const char* why, auto change) {
    Scene other = scene;
    change(other);
    const FoldedScene f = fold(other);
    EXPECT_FALSE(f.folds()) << why;
    EXPECT_EQ(f.scene.bodies.size(), other.bodies.size()) << why;
    EXPECT_EQ(in_words(f), "") << why;
  };
  stays("its weight works", [](Scene& s) { s.bodies[1].com = {0, 1e-9, 0}; });
  stays("it has a child", [](Scene& s) { s.joints[0].parent = "wheel"; });
  stays("a slide", [](Scene& s) { s.joints[1].kind = JointKind::prismatic; });
  stays("a loop on it", [](Scene& s) {
    LoopSpec tie;
    tie.name = "tie";
    tie.kind = LoopKind::distance;
    tie.child = "wheel";
    tie.origin_child = {0.1, 0, 0};
    tie.length = 1;
    s.loops.push_back(tie);
  });
  stays("a wrench on it", [](Scene& s) {
    ForceSpec wrench;
    wrench.kind = "wrench";
    wrench.body = "wheel";
    s.forces.push_back(wrench);
  });
  stays("a differential", [](Scene& s) {
    s.bodies.push_back(s.bodies[0]);
    s.bodies.back().name = "third";
    s.joints.push_back(s.joints[0]);
    s.joints.back().name = s.joints.back().child = "third";
    s.loops[0].joints.push_back("third");
    s.loops[0].ratios.push_back(1);
  });
  stays("two gears", [](Scene& s) {
    s.loops.push_back(s.loops[0]);
    s.loops.back().name = "another";
  });
  for (const bool of_loop : {false, true})
    stays("driven", [&](Scene& s) {
      DriveSpec drive;
      (of_loop ? drive.loop : drive.joint) = of_loop ? "gear" : "hinge of wheel";
      drive.kind = "polynomial";
      drive.coefficients = {0, 1};
      s.drives.push_back(drive);
    });
  stays("springs that cancel", [](Scene& s) {
    s.joints[0].stiffness = -9;
    s.joints[1].stiffness = 1;
  });
}

TEST(Fold, WhatIsNoRotorOnABodyThatTurnsStays) {
  Scene scene = link_and_wheel();
  scene.joints[1].parent = "link";
  scene.bodies[0].inertia.setIdentity();
  const auto folds = [](const Scene& s) { return fold_rotors(s).following.size() == 1; };
  const auto with_ratio = [&](double ratio) {
    Scene s = scene;
    s.loops[0].ratios = {ratio, -1};
    return s;
  };
  // fixed to the link it would turn with it already: (1 + ρ)² J
  const FoldedScene folded = fold_rotors(scene);
  ASSERT_EQ(folded.scene.joints.size(), 1U);
  EXPECT_DOUBLE_EQ(
      folded.scene.joints[0].rotor_inertia.at(0) + folded.scene.bodies[0].inertia(2, 2),
      1 + 16 * 0.02 + 0.5 * 0.25);
  EXPECT_TRUE(folds(with_ratio(-3)));
  EXPECT_FALSE(folds(with_ratio(-0.5)));  // faster than fixed to the ground, not than to the link
  EXPECT_TRUE(folds(with_ratio(-1)));
  Scene other = with_ratio(-3);
  other.bodies[1].inertia *= 100;  // takes more moments than the link has
  EXPECT_FALSE(folds(other));
  other = scene;
  other.bodies[1].inertia(0, 0) = 0.03;  // another one however it is turned
  EXPECT_FALSE(folds(other));
  other = scene;
  other.joints[1].axis = {0, 0.6, 0.8};
  EXPECT_FALSE(folds(other));
  other = scene;
  other.joints[0].kind = JointKind::universal;  // not all the link turns by
  EXPECT_FALSE(folds(other));
  // behind a joint of other bodies
  other = scene;
  other.bodies.push_back(other.bodies[0]);
  other.bodies.back().name = "tip";
  other.joints.push_back(other.joints[0]);
  other.joints.back().name = other.joints.back().child = "tip";
  other.joints.back().parent = "link";
  other.loops[0].joints[0] = "tip";
  EXPECT_TRUE(folds(other));
  other.joints.back().parent = "ground";
  EXPECT_FALSE(folds(other));
}

TEST(Fold, WeldsAloneStayAndWordsTellTheOthers) {
  Scene scene = link_and_wheel();
  scene.loops.clear();
  scene.joints[1].kind = JointKind::weld;
  scene.joints[1].parent = "link";
  scene.held = {"hinge of wheel", "hinge of link"};
  const FoldedScene folded = fold(scene);
  EXPECT_EQ(in_words(folded), "welded into 'link': 'wheel'");
  EXPECT_EQ(folded.scene.held, std::vector<std::string>{"hinge of link"});
  EXPECT_EQ(folded.scene.bodies.at(0).mass, 2);
  EXPECT_EQ(folded.scene.bodies.at(0).com, Vector3d(0.25, 0, 0));
  EXPECT_DOUBLE_EQ(folded.scene.bodies.at(0).inertia(2, 2), 0.04 + 2 * 0.25 * 0.25);
  scene.joints[1].parent = "ground";
  EXPECT_EQ(in_words(fold(scene)), "welded into the ground: 'wheel'");
  scene.joints[0].kind = JointKind::weld;
  EXPECT_FALSE(fold(scene).folds());
  EXPECT_EQ(fold(scene).scene.bodies.size(), 2U);
}

/// Springs and forces between what is one body afterwards have no effect.
TEST(Fold, ForcesWithinOneBodyGo) {
  Scene scene = link_and_wheel();
  scene.loops.clear();
  scene.joints[1].kind = JointKind::weld;
  scene.joints[1].parent = "link";
  scene.joints[1].origin_parent = {1, 0, 0};
  ForceSpec spring;
  spring.kind = "spring-damper";
  spring.parent = "link";
  spring.child = "wheel";
  spring.stiffness = 5;
  ForceSpec wrench;
  wrench.kind = "wrench";
  wrench.body = "wheel";
  wrench.force = {0, 1, 0};
  scene.forces = {spring, wrench};
  Scene folded = fold(scene).scene;
  ASSERT_EQ(folded.forces.size(), 1U);
  EXPECT_EQ(folded.forces[0].body, "link");
  EXPECT_EQ(folded.forces[0].point, Vector3d(1, 0, 0));
  // of a spring from a moving body to one on the ground the ends change places
  scene.joints[1].parent = "ground";
  folded = fold(scene).scene;
  ASSERT_EQ(folded.forces.size(), 1U);
  EXPECT_EQ(folded.forces[0].child, "link");
  EXPECT_EQ(folded.forces[0].parent, "ground");
  EXPECT_EQ(folded.forces[0].origin_parent, Vector3d(1, 0, 0));
}

/// The damper of a bushing is where its child's point is: with the ends changed it is elsewhere.
TEST(Fold, DampedBushingsKeepTheirEnds) {
  Scene scene = link_and_wheel();
  scene.loops.clear();
  scene.joints[0].kind = JointKind::spherical;
  scene.joints[0].velocity = {0.5, 0.3, 0.2};
  scene.joints[1].kind = JointKind::weld;
  scene.joints[1].rotation = Quaterniond(0.9, 0.1, -0.3, 0.2).normalized();
  ForceSpec bushing;
  bushing.kind = "bushing";
  bushing.parent = "link";
  bushing.child = "wheel";
  bushing.origin_parent = {0.1, 0.2, 0};
  bushing.origin_child = {0.3, 0, 0};
  bushing.stiffness = 7;
  bushing.rotational_damping = 0.4;
  scene.forces = {bushing};
  EXPECT_EQ(fold(scene).scene.bodies.size(), 1U);
  expect_alike(scene, fold(scene).scene, false, true, 0);
  scene.forces[0].damping = 1.3;
  EXPECT_EQ(fold(scene).scene.bodies.size(), 2U);
  expect_alike(scene, fold(scene).scene, false, true, 1);
  std::swap(scene.forces[0].parent, scene.forces[0].child);
  EXPECT_EQ(fold(scene).scene.bodies.size(), 1U);
  expect_alike(scene, fold(scene).scene, false, true, 2);
}

}  // namespace
}  // namespace momenta::dae_fold
