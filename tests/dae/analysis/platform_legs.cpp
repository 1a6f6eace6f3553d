// Platforms whose legs are bodies, against the same platforms on rods that are loops of kind
// distance.

#include "equations/assembled_linkages.h"
#include "equations/parts.h"
#include "equations/refusal.h"

#include <gtest/gtest.h>
#include <momenta/dae/mechanism/joint_places.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace momenta::dae_platform_legs {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;
using equations::found_in;
using equations::rod_between;
using std::numbers::pi;

Vector3d any_vector(std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  return {any(random), any(random), any(random)};
}
Vector3d any_across(std::mt19937& random, const Vector3d& way) {
  return way.cross(any_vector(random)).normalized();
}
Quaterniond turn_of(const Scene& s) {
  const std::vector<double>& q = s.joints[0].position;
  return {q[3], q[4], q[5], q[6]};
}
Vector3d place_of(const Scene& s) {
  const std::vector<double>& q = s.joints[0].position;
  return {q[0], q[1], q[2]};
}

/// Six rods between points in general position.
Scene on_rods(std::mt19937& random) {
  Scene s;
  s.name = "platform on six rods";
  s.bodies = {equations::rod("platform")};
  JointSpec joint = equations::make_joint(JointKind::free, "P", "ground", "platform");
  const Quaterniond at(Eigen::AngleAxisd(0.5, any_vector(random).normalized()));
  joint.position = {0.2, -0.1, 1.1, at.w(), at.x(), at.y(), at.z()};
  s.joints = {joint};
  for (int i = 0; i < 6; ++i) {
    const Vector3d b = any_vector(random), p = 0.6 * any_vector(random);
    s.loops.push_back(
        rod_between("L" + std::to_string(i), "platform", b, p, (place_of(s) + at * p - b).norm()));
  }
  return s;
}

enum class Leg {
  rod,              // as it is
  slide,            // universal, prismatic aside of the line and across it, spherical
  universal,        // universal, spherical
  universal_above,  // a ball below, universal joint on the platform
  universal_loop,   // a ball below, universal loop on the platform
  balls,            // a free body on two loops
  spherical,        // a spherical joint and a point
  reach             // universal, its axes and the leg at no right angles
};

/// Rod `i` made a leg, whose axes are those of ground in the own pose.
void make_leg(Scene& s, int i, Leg leg, std::mt19937& random) {
  if (leg == Leg::rod) return;
  const std::string n = std::to_string(i);
  LoopSpec& loop = s.loops[static_cast<std::size_t>(i)];
  const Vector3d foot = loop.origin_parent, seat = loop.origin_child,
                 way = place_of(s) + turn_of(s) * seat - foot;
  LoopSpec ball = loop;
  ball.kind = LoopKind::spherical;
  ball.parent = "platform";
  ball.child = "leg" + n;
  ball.origin_parent = seat;
  ball.origin_child = way;
  JointSpec below = equations::make_joint(JointKind::revolute, "U" + n, "ground", "leg" + n, foot);
  s.bodies.push_back(equations::rod("leg" + n));
  const Vector3d second =
      leg == Leg::reach ? Vector3d(way.normalized() + 0.6 * any_across(random, way)).normalized()
                        : any_across(random, way);
  const Vector3d across = any_across(random, second),
                 first =
                     leg == Leg::reach ? Vector3d((across + 0.4 * second).normalized()) : across;
  below.kind = leg == Leg::balls                                     ? JointKind::free
               : leg == Leg::spherical || leg == Leg::universal_loop ? JointKind::spherical
                                                                     : JointKind::universal;
  if (below.kind == JointKind::universal) {
    below.axis = first;
    below.axis2 = second;
  }
  if (leg == Leg::slide) {
    JointSpec slide;
    slide.name = "S" + n;
    slide.kind = JointKind::prismatic;
    slide.parent = "leg" + n;
    slide.child = "upper" + n;
    slide.origin_parent = 0.3 * any_vector(random);
    slide.axis = any_vector(random).normalized();
    slide.position = {0.4};
    s.bodies.push_back(equations::rod("upper" + n));
    s.joints.push_back(slide);
    ball.child = "upper" + n;
    ball.origin_child = way - slide.origin_parent - 0.4 * slide.axis;
  }
  if (leg == Leg::universal_above) {  // from the platform down
    below.parent = "platform";
    below.origin_parent = seat;
    below.rotation = turn_of(s).conjugate();
    ball.kind = LoopKind::point;
    ball.parent = "ground";
    ball.origin_parent = foot;
    ball.origin_child = -way;
  }
  if (leg == Leg::universal_loop) {
    ball.kind = LoopKind::universal;
    ball.rotation = turn_of(s).conjugate();
    ball.axis = first;
    ball.axis2 = second;
  }
  loop = ball;
  if (leg == Leg::balls) {
    LoopSpec foot_ball = ball;
    foot_ball.name = "F" + n;
    foot_ball.parent = "ground";
    foot_ball.origin_parent = foot;
    foot_ball.origin_child = Vector3d::Zero();
    below.origin_parent = Vector3d::Zero();
    below.position = {foot.x(), foot.y(), foot.z(), 1, 0, 0, 0};
    s.loops.push_back(foot_ball);
  }
  s.joints.push_back(below);
}

/// The same legs written with other joints, in the axes of make_leg().
enum class Written {
  two_hinges,    // a universal joint as two hinges with a cross between them
  three_hinges,  // a ball as three hinges
  swivel,        // universal, prismatic, swivel along the leg, universal loop
  telescope,     // universal, cylindrical joint along the leg that is held to turn alone, universal
  welded,        // a leg of two bodies
  loops          // a free leg on two loops of kind revolute, a cross between
};

JointSpec joint_of(JointKind kind, const std::string& name, const std::string& parent,
                   const std::string& child, const Vector3d& at, const Vector3d& axis) {
  return equations::make_joint(kind, name, parent, child, at, axis);
}

void write_leg(Scene& s, int i, Written how, std::mt19937& random) {
  const std::string n = std::to_string(i);
  const LoopSpec rod = s.loops[static_cast<std::size_t>(i)];
  const Vector3d foot = rod.origin_parent, way = place_of(s) + turn_of(s) * rod.origin_child - foot;
  const Vector3d second = any_across(random, way), first = any_across(random, second),
                 third = any_across(random, second);
  const auto body = [&](const std::string& name) {
    s.bodies.push_back(equations::rod(name + n));
    return name + n;
  };
  LoopSpec end = rod;
  end.kind = LoopKind::spherical;
  end.parent = "platform";
  end.origin_parent = rod.origin_child;
  end.origin_child = way;
  const auto hinge = JointKind::revolute;
  const Vector3d none = Vector3d::Zero();
  if (how == Written::two_hinges || how == Written::three_hinges) {
    s.joints.push_back(joint_of(hinge, "A" + n, "ground", body("cross"), foot, first));
    s.joints.push_back(joint_of(hinge, "B" + n, "cross" + n, body("leg"), none, second));
    end.child = "leg" + n;
    if (how == Written::three_hinges) {
      s.joints.push_back(joint_of(hinge, "C" + n, "leg" + n, body("third"), none, third));
      end.child = "third" + n;
    }
  } else if (how == Written::loops) {
    JointSpec flies = joint_of(JointKind::free, "F" + n, "ground", body("leg"), none, first);
    flies.position = {foot.x(), foot.y(), foot.z(), 1, 0, 0, 0};
    s.joints.push_back(flies);
    s.joints.push_back(joint_of(hinge, "A" + n, "ground", body("cross"), foot, first));
    LoopSpec turns = rod;
    turns.name = "H" + n;
    turns.kind = LoopKind::revolute;
    turns.parent = "leg" + n;
    turns.child = "cross" + n;
    turns.origin_parent = turns.origin_child = none;
    turns.axis = second;
    s.loops.push_back(turns);
    end.child = "leg" + n;
  } else {
    JointSpec below = joint_of(JointKind::universal, "U" + n, "ground", body("leg"), foot, first);
    below.axis2 = second;
    s.joints.push_back(below);
    if (how == Written::welded) {
      s.joints.push_back(
          joint_of(JointKind::weld, "S" + n, "leg" + n, body("top"), any_vector(random), first));
      end.child = "top" + n;
      end.origin_child = way - s.joints.back().origin_parent;
    } else {
      const Vector3d along = any_vector(random).normalized();
      JointSpec slide = joint_of(JointKind::prismatic, "S" + n, "leg" + n, body("upper"), none,
                                 how == Written::swivel ? along : way.normalized());
      slide.position = {0.4};
      if (how == Written::telescope) {
        slide.kind = JointKind::cylindrical;
        slide.position = {0.4, 0};
      }
      s.joints.push_back(slide);
      end.child = "upper" + n;
      end.origin_child = way - 0.4 * slide.axis;
      if (how == Written::swivel) {  // its line through both centres
        const Vector3d at = 0.3 * way - 0.4 * slide.axis;
        s.joints.push_back(
            joint_of(hinge, "T" + n, "upper" + n, body("top"), at, way.normalized()));
        end.child = "top" + n;
        end.origin_child = 0.7 * way;
      }
      end.kind = LoopKind::universal;
      end.rotation = turn_of(s).conjugate();
      end.axis2 = any_across(random, way);
      end.axis = any_across(random, end.axis2);
    }
  }
  s.loops[static_cast<std::size_t>(i)] = end;
}

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

VectorXd platform_in(const Mechanism& mechanism, const VectorXd& q) {
  for (const JointPlace& joint : joint_places(mechanism))
    if (joint.name == "P") {
      VectorXd own(7);
      for (int k = 0; k < 7; ++k) own[k] = q[joint.q[static_cast<std::size_t>(k)]];
      return own;
    }
  return {};
}

void expect_closed(const Mechanism& mechanism, const Assemblies& found) {
  const auto e = mechanism.evaluation<double>();
  for (const FoundAssembly& a : found.all) {
    VectorXd phi(mechanism.m());
    e->place(0, a.q.data());
    e->positions(phi.data());
    EXPECT_LT(phi.cwiseAbs().maxCoeff(), 1e-12);
  }
}

AssembliesRequest all_of(const std::vector<std::string>& hold) {
  AssembliesRequest request;
  request.hold = hold;
  request.by_homotopy = true;
  request.threads = 2;
  return request;
}

/// The platform stands in the same poses on legs as on rods.
void expect_same(const Scene& on_legs, const Assemblies& legs, const Scene& on_rods,
                 const Assemblies& rods) {
  const Mechanism a(on_legs), b(on_rods);
  expect_closed(a, legs);
  EXPECT_TRUE(legs.paths->is_complete());
  EXPECT_EQ(legs.paths->finite, rods.paths->finite);
  EXPECT_EQ(legs.paths->real, rods.paths->real);
  ASSERT_EQ(legs.all.size(), rods.all.size());
  for (const FoundAssembly& rod : rods.all) {
    const VectorXd wanted = platform_in(b, rod.q);
    double nearest = 1e300;
    for (const FoundAssembly& leg : legs.all) {
      const VectorXd own = platform_in(a, leg.q);
      const double turned = std::min((own.tail<4>() - wanted.tail<4>()).norm(),
                                     (own.tail<4>() + wanted.tail<4>()).norm());
      nearest = std::min(nearest, (own.head<3>() - wanted.head<3>()).norm() + turned);
    }
    EXPECT_LT(nearest, 1e-8);
  }
}

const std::vector<std::string> slides{"S0", "S1", "S2", "S3", "S4", "S5"};

/// The rods of equations::platform, between the centres of its joints.
Scene rods_of(const Scene& platform) {
  Scene s;
  s.name = "its rods";
  s.bodies = {platform.bodies[0]};
  s.joints = {platform.joints[0]};
  for (std::size_t i = 0; i < platform.loops.size(); ++i)
    s.loops.push_back(
        rod_between(platform.loops[i].name, "platform", platform.joints[2 * i + 1].origin_parent,
                    platform.loops[i].origin_parent, platform.joints[2 * i + 2].position[0]));
  return s;
}

/// The same with feet and seats that lie on no circle, in no plane.
Scene in_general(Scene platform, std::mt19937& random) {
  for (std::size_t i = 0; i < platform.loops.size(); ++i) {
    JointSpec &below = platform.joints[2 * i + 1], &slide = platform.joints[2 * i + 2];
    Vector3d& seat = platform.loops[i].origin_parent;
    below.origin_parent += 0.2 * any_vector(random);
    seat += 0.2 * any_vector(random);
    const Vector3d way = place_of(platform) + turn_of(platform) * seat - below.origin_parent,
                   along = way.normalized();
    below.position = {std::atan2(-along.y(), along.z()), std::asin(along.x())};
    slide.position = {way.norm()};
  }
  return platform;
}

TEST(PlatformLegs, OfAStewartPlatformAreItsRods) {
  std::mt19937 random(5);
  const Scene platform = in_general(equations::platform(6), random), rods = rods_of(platform);
  const Assemblies on_legs = found_in(platform, all_of(slides)),
                   on_rods = found_in(rods, all_of({}));
  EXPECT_EQ(on_legs.paths->paths, 128);
  EXPECT_EQ(on_legs.paths->finite, 40);
  expect_same(platform, on_legs, rods, on_rods);
  Scene driven = platform;
  DriveSpec drive = equations::polynomial("S5", driven.joints.back().position);
  driven.joints.back().position.clear();
  driven.drives = {drive};
  expect_same(driven, found_in(driven, all_of({"S0", "S1", "S2", "S3", "S4"})), rods, on_rods);
}

/// Feet and seats on two circles, by the same angle beside every sixth of a turn: fewer than 40.
TEST(PlatformLegs, OfASymmetricPlatformAreTwentyEight) {
  const Scene platform = equations::platform(6), rods = rods_of(platform);
  const Assemblies on_rods = found_in(rods, all_of({}));
  for (const std::uint64_t seed : {1, 2, 3}) {
    AssembliesRequest request = all_of(slides);
    request.seed = seed;
    const Assemblies on_legs = found_in(platform, request);
    EXPECT_EQ(on_legs.paths->finite, 28);
    expect_same(platform, on_legs, rods, on_rods);
  }
}

TEST(PlatformLegs, OfEveryKindAreRods) {
  std::mt19937 random(7);
  for (const bool all_balls : {false, true}) {
    const Scene rods = on_rods(random);
    const Leg kinds[] = {Leg::slide,          Leg::universal, Leg::universal_above,
                         Leg::universal_loop, Leg::balls,     Leg::spherical};
    Scene legs = rods;
    for (int i = 0; i < 6; ++i)
      make_leg(legs, i, all_balls ? (i == 0 ? Leg::rod : Leg::balls) : kinds[i], random);
    const Assemblies on_rods = found_in(rods, all_of({})),
                     on_legs = found_in(legs, all_of(all_balls ? std::vector<std::string>{}
                                                               : std::vector<std::string>{"S0"}));
    EXPECT_EQ(on_legs.paths->finite, 40);
    EXPECT_GT(on_legs.all.front().least_value, 1e-4);
    expect_same(legs, on_legs, rods, on_rods);
  }
}

/// Hinges that make a universal joint or a ball by where their lines cross, legs with a swivel or a
/// telescope between two universal joints, bodies cut in two: the same rods.
TEST(PlatformLegs, AreTheSameHoweverWritten) {
  std::mt19937 random(17);
  const Scene rods = on_rods(random);
  const Assemblies on_rods = found_in(rods, all_of({}));
  Scene legs = rods;
  int i = 0;
  for (const Written how : {Written::two_hinges, Written::three_hinges, Written::swivel,
                            Written::telescope, Written::welded, Written::loops})
    write_leg(legs, i++, how, random);
  const Assemblies on_legs = found_in(legs, all_of({"S2", "S3.q0"}));
  EXPECT_EQ(on_legs.paths->finite, 40);
  expect_same(legs, on_legs, rods, on_rods);
}

/// A leg carries the platform, which has no free joint then.
TEST(PlatformLegs, MayCarryThePlatform) {
  std::mt19937 random(7);
  const Scene rods = on_rods(random);
  Scene legs = rods;
  make_leg(legs, 0, Leg::slide, random);
  const Quaterniond at = turn_of(rods);
  JointSpec& top = legs.joints[0];
  top.kind = JointKind::spherical;
  top.parent = "upper0";
  top.origin_parent = legs.loops[0].origin_child;
  top.origin_child = legs.loops[0].origin_parent;
  top.position = {at.w(), at.x(), at.y(), at.z()};
  legs.loops.erase(legs.loops.begin());
  const Assemblies on_rods = found_in(rods, all_of({})), on_legs = found_in(legs, all_of({"S0"}));
  EXPECT_EQ(on_legs.paths->finite, 40);
  EXPECT_TRUE(on_legs.paths->is_complete());
  EXPECT_EQ(on_legs.paths->real, on_rods.paths->real);
  EXPECT_EQ(on_legs.all.size(), on_rods.all.size());
  expect_closed(Mechanism(legs), on_legs);
}

/// The way of a leg turns about b, at an angle ψ to it, and b about a, at χ: it reaches the
/// directions at |χ − ψ| to χ + ψ from a.
TEST(PlatformLegs, ReachAsFarAsTheirUniversalJoints) {
  std::mt19937 random(7);
  const Scene rods = on_rods(random);
  const Assemblies on_rods = found_in(rods, all_of({}));
  const Mechanism own(rods);
  int fewer = 0;
  for (int i = 0; i < 6; ++i) {
    Scene legs = rods;
    make_leg(legs, i, Leg::reach, random);
    const JointSpec& joint = legs.joints[1];
    const LoopSpec& rod = rods.loops[static_cast<std::size_t>(i)];
    const Assemblies on_legs = found_in(legs, all_of({}));
    long reached = 0;
    for (const FoundAssembly& a : on_rods.all) {
      const VectorXd q = platform_in(own, a.q);
      const Vector3d way = Vector3d(q.head<3>()) +
                           Quaterniond(q[3], q[4], q[5], q[6]) * rod.origin_child -
                           rod.origin_parent;
      const Vector3d before = place_of(rods) + turn_of(rods) * rod.origin_child - rod.origin_parent;
      const double psi = angle_between(before, joint.axis2),
                   chi = angle_between(joint.axis, joint.axis2),
                   now = angle_between(way, joint.axis);
      reached += now >= std::abs(chi - psi) && now <= std::min(chi + psi, 2 * pi - chi - psi);
    }
    EXPECT_EQ(on_legs.paths->finite, 40);
    EXPECT_TRUE(on_legs.paths->is_complete());
    EXPECT_EQ(on_legs.paths->real, reached) << i;
    expect_closed(Mechanism(legs), on_legs);
    fewer += reached < on_rods.paths->real;
  }
  EXPECT_GT(fewer, 0);
}

TEST(PlatformLegs, AreRefusedByTheJointThatMakesThemNone) {
  const auto expect_refused = [](const Scene& scene, const std::vector<std::string>& hold,
                                 const std::string& words) {
    EXPECT_TRUE(equations::says(
        equations::thrown<SceneError>([&] { found_in(scene, all_of(hold)); }), words))
        << "not refused: " << words;
  };
  const Scene platform = equations::platform(6);
  expect_refused(platform, {}, "leaves 6 degrees of freedom");
  expect_refused(platform, {"U0.q0", "S1", "S2", "S3", "S4", "S5"},
                 "joint 'S0' of kind prismatic moves; expected it held");
  expect_refused(platform, {"U0.q0", "U0.q1", "S1", "S2", "S3", "S4", "S5"},
                 "joint 'S0' of kind prismatic moves; expected it held");
  std::mt19937 random(3);
  const Scene rods = on_rods(random);
  Scene turned = rods, twice = rods, tied = rods, slotted = rods;
  make_leg(turned, 0, Leg::universal, random);
  turned.joints[1].kind = JointKind::revolute;
  turned.joints[1].axis2 = Vector3d::Zero();
  expect_refused(turned, {},
                 "joint 'U0' of kind revolute and loop 'L0' of kind spherical make no leg");
  make_leg(twice, 0, Leg::universal, random);
  twice.loops[0].kind = LoopKind::universal;
  twice.loops[0].rotation = turn_of(rods).conjugate();
  expect_refused(twice, {},
                 "joint 'U0' of kind universal and loop 'L0' of kind universal make no leg");
  // Lines that miss each other by a micrometre cross nowhere.
  Scene missed = rods;
  write_leg(missed, 0, Written::two_hinges, random);
  missed.joints[2].origin_parent += 1e-6 * missed.joints[1].axis.cross(missed.joints[2].axis);
  missed.loops[0].origin_child -= missed.joints[2].origin_parent;
  expect_refused(missed, {}, "joint 'A0' of kind revolute, joint 'B0' of kind revolute and loop");
  make_leg(tied, 0, Leg::universal, random);
  make_leg(tied, 1, Leg::universal, random);
  tied.loops.push_back(rod_between("T", "leg0", {0, 0, 0}, {0, 0, 1}, 1));
  tied.loops.back().parent = "leg1";
  tied.loops.back().length =
      (rods.loops[0].origin_parent + Vector3d(0, 0, 1) - rods.loops[1].origin_parent).norm();
  expect_refused(tied, {}, "loop 'T' of kind distance ends at body 'leg");
  slotted.loops.push_back(rods.loops[0]);
  slotted.loops.back().name = "again";
  expect_refused(slotted, {}, "7 rods and legs hold body 'platform'; expected six");
}

}  // namespace
}  // namespace momenta::dae_platform_legs
