// Joints that no inertia holds: named, all of them, by whatever meets them; and what of a state is
// there all the same. Against the null space of M and Φ_q, and against the same mechanism without
// those joints.

#include "equations/examples.h"
#include "equations/parts.h"
#include "equations/random_loops.h"
#include "equations/random_tree.h"
#include "equations/refusal.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/core/open_chain/open_chain.h>
#include <momenta/dae/kkt/body_matrix.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/kkt/unheld_joints.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/run/state_values.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <Eigen/SVD>

namespace momenta::dae_massless_joints {
namespace {

using namespace equations;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// A body without mass on a joint of its own.
void add_finger(Scene& scene, const std::string& name, const std::string& parent,
                const Vector3d& axis = Vector3d::UnitZ(), JointKind kind = JointKind::revolute) {
  BodySpec body;
  body.name = name + " link";
  JointSpec joint = equations::make_joint(kind, name, parent, body.name, {0.3, 0.1, 0.2}, axis);
  scene.bodies.push_back(body);
  scene.joints.push_back(joint);
}

Scene arm() {
  Scene scene;
  BodySpec body = equations::make_body("arm", 1, {0.01, 0.05, 0.05}, {0.3, 0, 0});
  JointSpec joint =
      equations::make_joint(JointKind::revolute, "shoulder", "ground", "arm", {0, 0, 0}, {0, 1, 0});
  scene.bodies = {body};
  scene.joints = {joint};
  scene.gravity = {0, 0, -9.81};
  return scene;
}

Scene arm_in_plane() {
  Scene scene = arm();
  scene.joints.front().axis = {0, 0, 1};
  scene.gravity = {0, -9.81, 0};
  return scene;
}

GivenState at_start(const Mechanism& mechanism) {
  GivenState given;
  const Assembly a = assemble(mechanism, Assembled::rates);
  given.q = a.start.q;
  given.v = a.start.u;
  given.p = given.tau = VectorXd::Zero(mechanism.nv());
  return given;
}

std::string refusal(const Scene& scene) {
  return equations::thrown<SceneError>([&] { assemble(Mechanism(scene)); });
}

TEST(MasslessJoints, OpenChainsNameThem) {
  Scene scene = arm();
  add_finger(scene, "tip", "arm", {1, 2, 3.0});
  scene.joints.back().axis.normalize();
  const std::string sentence =
      "joint 'tip' has no inertia: body 'tip link' and what it carries have none about its axis; "
      "expected a mass, a rotor's inertia, or a fixed joint";
  for (const bool on_the_axis : {false, true}) {
    if (on_the_axis) {  // a point mass
      scene.bodies.back().mass = 0.5;
      scene.bodies.back().com = 0.7 * scene.joints.back().axis;
    }
    OpenChain chain(scene);
    VectorXd q = chain.tree().q0, u = chain.tree().u0, udot(2), qdot(2), pdot(2);
    EXPECT_FALSE(chain.accelerations(0, q, u, udot));
    EXPECT_EQ(chain.failure(), sentence);
    EXPECT_FALSE(chain.rates(0, q, u, qdot, pdot));
    EXPECT_EQ(chain.failure(), sentence);
    StateMatrix many = StateMatrix::Zero(2, 5), out(2, 5), other(2, 5);
    EXPECT_FALSE(chain.rates_of_states(0, many, many, out, other));
    EXPECT_EQ(chain.failure(), "state 0: " + sentence);
    EXPECT_EQ(refusal(scene), "scene: the mechanism cannot move at its start: " + sentence);
  }
}

/// A mass on its joint's axis is off it by rounding, about any axis. One that is off it by 1e-6 has
/// inertia: the moment about the origin, of arms a million times longer, leaves four digits of it.
TEST(MasslessJoints, AMassOnTheAxisIsToldFromOneBesideIt) {
  RandomTree random(3);
  for (int i = 0; i < 40; ++i)
    for (const double off : {0.0, 1e-6}) {
      SCOPED_TRACE(testing::Message() << i << ", " << off);
      const Vector3d axis =
          Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.1, 1))
              .normalized();
      Scene scene = arm();
      add_finger(scene, "bare", "arm");
      add_finger(scene, "tip", "arm", axis);
      scene.bodies.back().mass = 0.5;
      scene.bodies.back().com =
          random.uniform(-2, 2) * axis + off * axis.cross(Vector3d::UnitX()).normalized();
      OpenChain chain(scene);
      VectorXd udot(chain.nv());
      EXPECT_FALSE(chain.accelerations(0, chain.tree().q0, chain.tree().u0, udot));
      EXPECT_EQ(chain.failure(),
                off > 0 ? "joint 'bare' has no inertia: body 'bare link' and what it carries have "
                          "none about its axis; expected a mass, a rotor's inertia, or a fixed "
                          "joint"
                        : "joints 'bare', 'tip' have no inertia: the bodies on them and what those "
                          "carry have none along their freedoms; expected masses, rotors' "
                          "inertias, or fixed joints");
    }
}

/// The same of what a joint carries: its own mass is none, a slider's point mass comes to lie on
/// its axis from two lengths along it, and M_jj is what rounding leaves of that.
TEST(MasslessJoints, AMassThatComesToTheAxisIsNoInertiaEither) {
  RandomTree random(3);
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    const Vector3d axis =
        Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.1, 1)).normalized();
    Scene scene = arm();
    add_finger(scene, "tip", "arm", axis);
    add_finger(scene, "slide", "tip link", axis, JointKind::prismatic);
    scene.joints.back().origin_parent = random.uniform(-2, 2) * axis;
    scene.bodies.back().mass = 0.5;
    scene.bodies.back().com = random.uniform(-2, 2) * axis;
    const std::string start = refusal(scene);  // whatever sign rounding gives M_jj
    EXPECT_NE(
        start.find("joint 'tip' has no inertia: body 'tip link' and what it carries have none "
                   "about its axis"),
        std::string::npos)
        << start;
    add_finger(scene, "bare", "arm");  // where the sweeps stop
    OpenChain chain(scene);
    VectorXd udot(chain.nv());
    EXPECT_FALSE(chain.accelerations(0, chain.tree().q0, chain.tree().u0, udot));
    EXPECT_EQ(chain.failure(),
              "joints 'tip', 'bare' have no inertia: the bodies on them and what those carry have "
              "none along their freedoms; expected masses, rotors' inertias, or fixed joints");
  }
}

TEST(MasslessJoints, SixAreNamedAndTheOthersCounted) {
  Scene scene = arm();
  for (int i = 0; i < 3; ++i) {
    const std::string finger = "f" + std::to_string(i);
    add_finger(scene, finger + "a", "arm", Vector3d::UnitX(),
               i == 1 ? JointKind::spherical : JointKind::revolute);
    add_finger(scene, finger + "b", finger + "a link", Vector3d::UnitY(),
               i == 2 ? JointKind::prismatic : JointKind::revolute);
  }
  const std::string why =
      " have no inertia: the bodies on them and what those carry have none along their freedoms; "
      "expected masses, rotors' inertias, or fixed joints";
  EXPECT_EQ(refusal(scene),
            "scene: the mechanism cannot move at its start: joints 'f0a', 'f0b', 'f1a', "
            "'f1b', 'f2a', 'f2b'" +
                why);
  OpenChain chain(scene);
  VectorXd udot(chain.nv());
  EXPECT_FALSE(chain.accelerations(0, chain.tree().q0, chain.tree().u0, udot));
  EXPECT_EQ(chain.failure(), "joints 'f0a', 'f0b', 'f1a', 'f1b', 'f2a', 'f2b'" + why);
  add_finger(scene, "thumb", "arm");
  EXPECT_EQ(refusal(scene),
            "scene: the mechanism cannot move at its start: joints 'f0a', 'f0b', 'f1a', "
            "'f1b', 'f2a', 'f2b', … (7)" +
                why);
}

TEST(MasslessJoints, WhatOthersMoveAloneIsNoInertia) {
  Scene scene = arm();  // two joints on one axis, nothing between them
  add_finger(scene, "inner", "arm", Vector3d::UnitX());
  add_finger(scene, "outer", "inner link", Vector3d::UnitX());
  scene.joints.back().origin_parent = Vector3d::Zero();
  scene.bodies.back().mass = 1;
  scene.bodies.back().inertia = Vector3d(0.1, 0.2, 0.2).asDiagonal();
  OpenChain chain(scene);
  VectorXd udot(chain.nv());
  EXPECT_FALSE(chain.accelerations(0, chain.tree().q0, chain.tree().u0, udot));
  EXPECT_EQ(chain.failure(),
            "joint 'inner' has no inertia: body 'inner link' has none about its axis that the "
            "joints it carries do not move alone, as at rates 1 of joint 'inner', -1 of joint "
            "'outer' no mass moves; expected a mass, a rotor's inertia, or a fixed joint");
}

Scene rod_about(const Vector3d& axis, JointKind kind) {
  Scene scene = arm();
  add_finger(scene, "spin", "arm", axis.normalized(), kind);
  scene.bodies.back().mass = 1;
  const Vector3d along = axis.normalized();
  scene.bodies.back().inertia = (Matrix3d::Identity() - along * along.transpose()) / 12;
  return scene;
}

/// Rounding leaves of a thin rod's inertia about itself 10⁻¹⁷, above zero about some axes and below
/// about others.
TEST(MasslessJoints, AThinRodIsTakenForOneAboutAnyAxis) {
  RandomTree random(5);
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    const Vector3d axis =
        i == 0   ? Vector3d(1, 2, 2)
        : i == 1 ? Vector3d(1, 1, 1)
        : i == 2 ? Vector3d(1, 0, 0)
                 : Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.1, 1));
    EXPECT_EQ(refusal(rod_about(axis, JointKind::revolute)),
              "scene: the mechanism cannot move at its start: joint 'spin' has no inertia: body "
              "'spin link' and what it carries have none about its axis; expected a mass, a "
              "rotor's inertia, or a fixed joint");
    EXPECT_NE(refusal(rod_about(axis, JointKind::spherical)).find("joint 'spin' has no inertia"),
              std::string::npos);
    Scene loops = equations::example("four_bar");  // beside loops, by every matrix
    const Scene rod = rod_about(axis, JointKind::revolute);
    loops.bodies.push_back(rod.bodies.back());
    loops.joints.push_back(rod.joints.back());
    loops.joints.back().parent = "ground";
    EXPECT_NE(refusal(loops).find("joint 'spin' has no inertia"), std::string::npos);
    Scene thick = rod_about(axis, JointKind::revolute);
    thick.bodies.back().inertia += 1e-12 * Matrix3d::Identity();
    EXPECT_EQ(refusal(thick), "");
    const Mechanism mechanism(rod_about(axis, JointKind::revolute));
    const StateValues s = evaluate_state(mechanism, at_start(mechanism));
    EXPECT_NE(s.not_there.find("joint 'spin' has no inertia"), std::string::npos);
    EXPECT_TRUE(std::isnan(s.free[1]));
    EXPECT_TRUE(std::isfinite(s.free[0]));
  }
}

/// Three hinges through a point carry a point mass: the turn about the line to it moves nothing.
TEST(MasslessJoints, TheWeakestDirectionIsNamed) {
  RandomTree random(7);
  const auto draw = [&] {
    return Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.1, 1))
        .normalized();
  };
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    Scene scene = arm();
    for (const char* name : {"pitch", "roll", "yaw"}) {
      add_finger(scene, name, scene.bodies.back().name, draw());
      if (scene.joints.size() > 2) scene.joints.back().origin_parent.setZero();
      scene.joints.back().position = {random.uniform(-1, 1)};
    }
    scene.bodies.back().mass = 1.337;
    scene.bodies.back().com = random.uniform(0.1, 2) * draw();
    const std::string sentence = refusal(scene);
    EXPECT_NE(sentence.find("joint 'pitch' has no inertia: body 'pitch link' has none about its "
                            "axis that the joints it carries do not move alone, as at rates "),
              std::string::npos)
        << sentence;
    for (const char* name : {" of joint 'pitch'", " of joint 'roll'", " of joint 'yaw'"})
      EXPECT_NE(sentence.find(name), std::string::npos) << sentence;
    const Mechanism mechanism(scene);
    const auto e = mechanism.evaluation<double>();
    const UnheldJoints found = unheld_by_rounding(mechanism, *e, 0, mechanism.tree().q0.data());
    ASSERT_EQ(found.motions.cols(), 1);
    EXPECT_LT((dense_mass(mechanism, *e) * found.motions).norm(), 1e-12 * found.motions.norm());
    scene.bodies.back().inertia = 1e-6 * Matrix3d::Identity();
    EXPECT_EQ(refusal(scene), "");
  }
}

TEST(MasslessJoints, FormulasToo) {
  const auto told = [](const std::string& kinetic) {
    return refusal(
        parse_scene("[lagrangian]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"" + kinetic + "\"\n"));
  };
  for (const char* kinetic :
       {"(0.1*x.dot + 0.3*y.dot)^2", "(x.dot/3 - y.dot/7)^2", "(0.7*x.dot + 1.1*y.dot)^2"})
    EXPECT_NE(told(kinetic).find("' has no inertia, alone or with"), std::string::npos) << kinetic;
  EXPECT_EQ(told("(0.1*x.dot + 0.3*y.dot)^2 + 1e-9*x.dot^2"), "");
}

TEST(MasslessJoints, LoopsElsewhereDoNotHideThem) {
  Scene scene = equations::example("four_bar");
  scene.loops[0].axis = Vector3d::UnitZ();
  add_finger(scene, "index", "rocker");
  add_finger(scene, "thumb", "crank", Vector3d::UnitX());
  for (const KktChoice kkt : {KktChoice::automatic, KktChoice::sparse, KktChoice::dense})
    EXPECT_TRUE(equations::says(
        equations::thrown<SceneError>([&] { assemble(Mechanism(scene, {.kkt = kkt})); }),
        "joints 'thumb', 'index' have no inertia"))
        << name_of(kkt);
}

/// Accelerations of all joints that have inertia are those of the mechanism without the others.
void expect_the_rest(const Scene& scene, const Scene& without) {
  const Mechanism whole(scene), rest(without);
  const StateValues s = evaluate_state(whole, at_start(whole)),
                    r = evaluate_state(rest, at_start(rest));
  EXPECT_NE(s.not_there.find("no inertia"), std::string::npos) << s.not_there;
  EXPECT_TRUE(s.mass.allFinite() && s.bias.allFinite() && s.pdot.allFinite());
  EXPECT_TRUE(std::isfinite(s.kinetic) && std::isfinite(s.potential));
  const auto expect_same = [&](const VectorXd& of_whole, const VectorXd& of_rest) {
    int at = 0;
    for (const auto& b : rest.tree().bodies) {
      const int k = whole.tree().carried_by(b.joint);
      ASSERT_GE(k, 0);
      const int u = whole.tree().bodies[static_cast<std::size_t>(k)].u;
      for (int i = 0; i < b.nv; ++i, ++at)
        EXPECT_NEAR(of_whole[u + i], of_rest[at], 1e-9 * (1 + std::abs(of_rest[at]))) << b.joint;
    }
    EXPECT_EQ((of_whole.array() != of_whole.array()).count(), whole.nv() - rest.nv());
  };
  expect_same(s.free, r.free);
  if (whole.m() == 0) return;
  expect_same(s.constrained, r.constrained);
  EXPECT_LT(relative_error(s.lambda, r.lambda), 1e-9);
  for (std::size_t i = 0; i < r.reactions.loops.size(); ++i)
    EXPECT_LT((s.reactions.loops[i].force - r.reactions.loops[i].force).norm(),
              1e-9 * (1 + r.reactions.loops[i].force.norm()));
  EXPECT_TRUE(s.reactions.joints[0].force.allFinite());
}

TEST(MasslessJoints, TheOthersAccelerateAllTheSame) {
  Scene chain = arm();
  chain.joints[0].velocity = {1.3};
  Scene more = chain;
  add_finger(more, "a", "arm", Vector3d::UnitX());
  add_finger(more, "b", "a link", Vector3d::UnitY(), JointKind::prismatic);
  expect_the_rest(more, chain);
  Scene loops = equations::example("four_bar");
  more = loops;
  add_finger(more, "a", "rocker");
  add_finger(more, "b", "a link", Vector3d::UnitX(), JointKind::prismatic);
  expect_the_rest(more, loops);
}

TEST(MasslessJoints, AForceOnWhatHasNoInertiaLeavesNothing) {
  Scene scene = arm();
  add_finger(scene, "tip", "arm", Vector3d::UnitX());
  scene.joints.back().stiffness = 3;
  scene.joints.back().rest = 0.1;
  const Mechanism mechanism(scene);
  const StateValues s = evaluate_state(mechanism, at_start(mechanism));
  EXPECT_TRUE((s.free.array() != s.free.array()).all());
  EXPECT_NEAR(s.bias[1], -0.3, 1e-15);
  EXPECT_TRUE(s.mass.allFinite());
  EXPECT_NE(s.not_there.find("joint 'tip' has no inertia"), std::string::npos);
}

/// A coupler without mass between crank and rocker: M is singular, (3) is not.
TEST(MasslessJoints, WhatLoopsHoldIsEvaluatedAsItRuns) {
  Scene scene = equations::example("four_bar");
  scene.bodies[1].mass = 0;
  scene.bodies[1].inertia.setZero();
  const Mechanism mechanism(scene);
  const Assembly a = assemble(mechanism);
  const StateValues s = evaluate_state(mechanism, at_start(mechanism));
  EXPECT_LT(relative_error(s.constrained, a.start.udot), 1e-12);
  EXPECT_LT(relative_error(s.lambda, a.start.lambda), 1e-12);
  EXPECT_EQ(s.not_there,
            "joint 'A' has no inertia without the loops that hold what is on it: no "
            "acceleration.free");
  EXPECT_TRUE(std::isnan(s.free[1]));
  for (const Transmitted& r : s.reactions.joints) EXPECT_TRUE(r.force.allFinite()) << r.name;
  GivenState moving = at_start(mechanism);
  moving.of_momenta = true;
  moving.p = s.p;
  moving.p_given.assign(3, true);
  EXPECT_LT((evaluate_state(mechanism, moving).v - s.v).norm(), 1e-12);
}

/// A four-bar whose coupler and rocker have no mass: what is told to be expected runs.
TEST(MasslessJoints, WhatIsExpectedBeforeLoopsCloseRuns) {
  const Scene scene = parse_scene(R"(
gravity = [0, -9.81, 0]
[[body]]
name = "a"
mass = 1
com = [0.5, 0, 0]
inertia = [0.01, 0.1, 0.1]
[[body]]
name = "b"
mass = 0
inertia = [0, 0, 0]
[[body]]
name = "c"
mass = 0
inertia = [0, 0, 0]
[[joint]]
name = "A"
kind = "revolute"
child = "a"
position = 1.04047070433185
velocity = 0.383981800936113
[[joint]]
name = "B"
kind = "revolute"
parent = "a"
child = "b"
origin = { parent = [1, 0, 0] }
position = -0.747735492227825
velocity = -0.439775009455546
[[joint]]
name = "C"
kind = "revolute"
child = "c"
origin = { parent = [2, 0, 0] }
position = 1.28649484128902
velocity = 0.207696216971679
[[loop]]
name = "L"
kind = "revolute"
parent = "b"
child = "c"
origin = { parent = [2, 0, 0], child = [1.5, 0, 0] }
)");
  const auto run = [&](const char* form, KktChoice kkt) {
    const Mechanism mechanism(scene, {.kkt = kkt});
    RunRequest request;
    request.settings.form = form;
    request.settings.end_time = 0.1;
    request.settings.samples = 2;
    return run_form(mechanism, assemble(mechanism).start, request);
  };
  // A run cuts the scene elsewhere, unless it is asked for a matrix.
  for (const KktChoice kkt : {KktChoice::automatic, KktChoice::sparse})
    EXPECT_TRUE(equations::says(run("maximal-coordinates", kkt).reason,
                                " has no inertia before its loops close; expected another form"));
  EXPECT_EQ(run("acceleration", KktChoice::automatic).status, "done");
  const auto refused = [&](KktChoice kkt) {
    return equations::thrown<SceneError>([&] { run("acceleration", kkt); });
  };
  for (const KktChoice kkt : {KktChoice::dense, KktChoice::sweeps}) {
    EXPECT_TRUE(equations::says(refused(kkt), "; expected --kkt sparse"));
    EXPECT_EQ(refused(kkt).find("or dense"), std::string::npos) << refused(kkt);
  }
  EXPECT_EQ(run("acceleration", KktChoice::sparse).status, "done");
}

/// Random trees and loops some of whose bodies have no mass: the joints named are those of the null
/// space of ( M ; Φ_q ), by its singular values.
TEST(MasslessJoints, AreThoseOfTheNullSpace) {
  int unheld = 0, held = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    RandomTree random(seed);
    TreeRecipe recipe;
    recipe.drives = false;
    Scene scene = random.scene(recipe);
    if (seed % 3 > 0)
      scene.loops.push_back(random_loop(random, scene, loop_kinds[seed % loop_kinds.size()]));
    for (BodySpec& body : scene.bodies)
      if (random.chance(0.3)) {
        body.mass = 0;
        body.inertia.setZero();
      }
    const Mechanism mechanism(scene);
    const TreeState at = random.state(mechanism.tree());
    const auto e = mechanism.evaluation<double>();
    const UnheldJoints found = unheld_joints(mechanism, *e, at.t, at.q.data());
    e->place(at.t, at.q.data());
    MatrixXd all(mechanism.nv() + mechanism.m(), mechanism.nv());
    all << dense_mass(mechanism, *e), dense_constraints(mechanism, *e);
    const Eigen::JacobiSVD<MatrixXd> svd(all, Eigen::ComputeFullV);
    const Eigen::Index free =
        (svd.singularValues().array() <= 1e-10 * svd.singularValues()[0]).count();
    const Eigen::Index motions = found.joints.empty() ? 0 : found.motions.cols();
    EXPECT_EQ(motions, free);
    if (motions > 0) {
      EXPECT_LT((all * found.motions).norm(), 1e-9 * all.norm());
    }
    ++(free > 0 ? unheld : held);
  }
  EXPECT_GT(unheld, 10);
  EXPECT_GT(held, 10);
}

/// A massless body on a hinge carries another on a planar joint, which moves alone what has mass:
/// of the hinge's inertia rounding is left, until the weld closes that holds the massless body.
TEST(MasslessJoints, RoundingIsNoInertiaBeforeLoopsClose) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    RandomTree random(seed);
    const double at = random.uniform(-1, 1), to = random.uniform(-1, 1);
    const Vector3d arm(random.uniform(-1, 1), random.uniform(-1, 1), 0),
        pin(random.uniform(-1, 1), random.uniform(-1, 1), 0);
    Scene scene = arm_in_plane();
    BodySpec frame, mass = scene.bodies.front();
    frame.name = "frame";
    mass.name = "mass";
    JointSpec hinge, floats;
    hinge.name = "hinge";
    hinge.parent = "arm";
    hinge.child = "frame";
    hinge.origin_parent = pin;
    hinge.position = {at};
    hinge.velocity = {random.uniform(-1, 1)};
    floats.name = "floats";
    floats.kind = JointKind::planar;
    floats.parent = "frame";
    floats.child = "mass";
    floats.origin_parent = arm;
    floats.position = {to, -at, to + at};
    scene.bodies.insert(scene.bodies.end(), {frame, mass});
    scene.joints.insert(scene.joints.end(), {hinge, floats});
    LoopSpec held;
    held.name = "held";
    held.kind = LoopKind::weld;
    held.child = "frame";
    close(held, scene, build_tree(scene));
    scene.loops.push_back(held);
    const Mechanism mechanism(scene);
    EXPECT_TRUE(mechanism.plan().planar);
    EXPECT_EQ(mechanism.solver().kkt(), KktChoice::sparse) << seed;
    EXPECT_FALSE(mechanism.solver().leaves_first());
    // The frame is held, and the arm with it: the mass alone moves, and falls.
    const Start start = assemble(mechanism).start;
    EXPECT_EQ(start.udot.size(), 5);
    EXPECT_NEAR(start.udot.head(2).norm(), 0, 1e-9) << seed;
    EXPECT_NEAR(start.udot.tail(3).head(2).norm(), 9.81, 1e-9) << seed;
    const Mechanism dense(scene, {.kkt = KktChoice::dense});
    EXPECT_THROW(assemble(dense), SceneError) << seed;
  }
}

}  // namespace
}  // namespace momenta::dae_massless_joints
