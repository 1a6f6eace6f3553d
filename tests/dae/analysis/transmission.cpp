// Transmission angles and joint forces against trigonometry, and against three forces that meet in
// one point; the scenes have weights, which are no part of either.

#include "equations/assembled_linkages.h"
#include "equations/parts.h"
#include "equations/refusal.h"

#include <gtest/gtest.h>
#include <momenta/dae/analysis/kinematics/move.h>

#include <cmath>
#include <numbers>
#include <random>

namespace momenta::dae_transmission {
namespace {

using Eigen::Vector2d;
using equations::angle_of;
using equations::pin;
using std::numbers::pi;

/// |sin| of the angle between two directions.
double sine(const Vector2d& a, const Vector2d& b) {
  return std::abs(a.x() * b.y() - a.y() * b.x()) / (a.norm() * b.norm());
}

/// Crank a from O(0, 0), coupler b, rocker c from C(d, 0), at the crank's angle θ. `cut_at_a`: A is
/// the loop, and the coupler hangs on the rocker, so that its pin B is a joint.
Scene four_bar(double a, double b, double c, double d, double theta, bool cut_at_a) {
  const Vector2d A(a * std::cos(theta), a * std::sin(theta)), C(d, 0);
  const double reach = (A - C).norm(), from = angle_of(A - C),
               inside = std::acos((reach * reach + c * c - b * b) / (2 * reach * c)),
               rocker = from - inside;
  const Vector2d B = C + c * Vector2d(std::cos(rocker), std::sin(rocker));
  Scene s;
  s.name = "four-bar";
  s.gravity = {0, -9.81, 0};
  s.bodies = {equations::rod("crank"), equations::rod("coupler"), equations::rod("rocker")};
  s.joints = {equations::hinge("O", "ground", "crank", {0, 0, 0}, theta)};
  if (cut_at_a) {
    s.joints.push_back(equations::hinge("C", "ground", "rocker", {d, 0, 0}, rocker));
    s.joints.push_back(
        equations::hinge("B", "rocker", "coupler", {c, 0, 0}, angle_of(A - B) - rocker));
    s.loops = {pin("A", "crank", "coupler", {a, 0, 0}, {b, 0, 0})};
  } else {
    s.joints.push_back(
        equations::hinge("A", "crank", "coupler", {a, 0, 0}, angle_of(B - A) - theta));
    s.joints.push_back(equations::hinge("C", "ground", "rocker", {d, 0, 0}, rocker));
    s.loops = {pin("B", "coupler", "rocker", {b, 0, 0}, {c, 0, 0})};
  }
  return s;
}

MoveResult moved(const Scene& scene, const std::string& sweep, const std::string& output,
                 double by = 0.1) {
  const Mechanism mechanism(scene);
  const Assembly a = assemble(mechanism, Assembled::rates);
  MoveRequest request;
  request.sweep = {{sweep, 1}};
  request.output = output;
  request.by = by;
  return move(mechanism, 0, a.start.q, request);
}

// By the law of cosines: b² + c² − 2 b c cos μ is the square of the distance from A to C. One force
// 1/(c sin μ) goes through all pins.
TEST(TransmissionAngle, OfFourBarsByTrigonometry) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(0.5, 2);
  for (int tried = 0; tried < 12;) {
    double a = any(random), b = any(random), c = any(random), d = any(random);
    const double theta = any(random);
    const double reach = std::hypot(a * std::cos(theta) - d, a * std::sin(theta));
    if (reach > 0.98 * (b + c) || reach < std::abs(b - c) + 0.02) continue;
    const bool cut_at_a = tried++ % 2 == 0;
    const MoveResult r = moved(four_bar(a, b, c, d, theta, cut_at_a), "O", "C");
    ASSERT_GT(r.poses.size(), 10u);
    for (const MovedPose& pose : r.poses) {
      const double crank = pose.q[0];
      const double far = std::hypot(a * std::cos(crank) - d, a * std::sin(crank));
      const double cosine = (b * b + c * c - far * far) / (2 * b * c);
      if (pose.kind == MovedPose::Kind::dead_point) {
        EXPECT_EQ(pose.transmission_angle, 0);
        EXPECT_TRUE(std::isinf(pose.joint_force));
        continue;
      }
      if (std::abs(cosine) > 0.9999) continue;
      const double mu = std::acos(std::abs(cosine));
      EXPECT_NEAR(pose.transmission_angle, mu, 1e-7 / std::sin(mu)) << cut_at_a;
      EXPECT_NEAR(pose.joint_force * c * std::sin(mu), 1, 1e-6 / std::sin(mu));
    }
  }
}

// Extremes lie between rows: of a crank-rocker at θ = 0 and π, and where coupler and rocker are
// square; of a linkage with dead points at these.
TEST(TransmissionAngle, ExtremesAreLocatedAtEveryStep) {
  const double a = 1, b = 2, c = 1.8, d = 2.2;
  const auto mu = [&](double far) {
    return std::acos(std::abs(b * b + c * c - far * far) / (2 * b * c));
  };
  for (const double by : {0.37, 0.05}) {
    const MoveResult r = moved(four_bar(a, b, c, d, 0.9, false), "O", "C", by);
    EXPECT_NEAR(r.passed.least_angle.value, std::min(mu(d - a), mu(d + a)), 1e-9);
    EXPECT_NEAR(r.passed.largest_angle.value, pi / 2, 1e-7);
    EXPECT_NEAR(r.passed.largest_force.value, 1 / (c * std::sin(r.passed.least_angle.value)), 1e-8);
    const MoveResult dead = moved(four_bar(1.5, 1, 0.8, 1.2, 0.6, false), "O", "C", by);
    ASSERT_EQ(dead.dead_points(), 2);
    EXPECT_EQ(dead.passed.least_angle.value, 0);
    EXPECT_TRUE(std::isinf(dead.passed.largest_force.value));
    EXPECT_NEAR(std::abs(dead.start + dead.passed.least_angle.s),
                std::acos((2.25 + 1.44 - 3.24) / 3.6), 1e-9);
  }
}

// The rod stands at φ to the way of the slide, sin φ = (a sin θ − e)/l: μ = 90° − |φ|, and one
// force 1/cos φ through both pins.
TEST(TransmissionAngle, OfASliderCrank) {
  const double a = 1, l = 2.5, e = 0.4, theta = 0.7;
  const Vector2d A(a * std::cos(theta), a * std::sin(theta));
  const double x = A.x() + std::sqrt(l * l - std::pow(A.y() - e, 2));
  Scene s;
  s.name = "slider-crank";
  s.gravity = {0, -9.81, 0};
  s.bodies = {equations::rod("crank"), equations::rod("rod"), equations::rod("block")};
  JointSpec slide = equations::make_joint(JointKind::prismatic, "S", "ground", "block", {0, e, 0},
                                          {1, 0, 0}, {x});
  s.joints = {
      equations::hinge("O", "ground", "crank", {0, 0, 0}, theta),
      equations::hinge("A", "crank", "rod", {a, 0, 0}, angle_of(Vector2d(x, e) - A) - theta),
      slide};
  s.loops = {pin("B", "rod", "block", {l, 0, 0}, {0, 0, 0})};
  const MoveResult r = moved(s, "O", "S");
  ASSERT_EQ(r.end, MoveResult::End::closed) << r.why;
  for (const MovedPose& pose : r.poses) {
    const double phi = std::asin((a * std::sin(pose.q[0]) - e) / l);
    EXPECT_NEAR(pose.transmission_angle, pi / 2 - std::abs(phi), 1e-7);
    EXPECT_NEAR(pose.joint_force, 1 / std::cos(phi), 1e-7);
  }
}

// Stephenson's six-bar driven at E: its coupler has three pins, and no line of two of them is that
// of a force. The force at A lies along the crank, that at P along the link PD; where these meet,
// the third one, at B, goes through as well.
TEST(TransmissionAngle, OfAnOutputMovedByATernaryLink) {
  const Vector2d O(0, 0), A(0.3, 0.4), C(2, 0), B(1.8, 1.1), P(1.2, 1.5), D(1.0, 2.4), E(-0.1, 2);
  const double coupler = angle_of(B - A), crank = angle_of(A), rocker = angle_of(B - C),
               link = angle_of(D - P), lever = angle_of(D - E);
  const Eigen::Rotation2Dd back(-coupler);
  const Vector2d p = back * (P - A);
  Scene s;
  s.name = "six-bar";
  s.gravity = {0, -9.81, 0};
  s.bodies = {equations::rod("crank"), equations::rod("coupler"), equations::rod("rocker"),
              equations::rod("link"), equations::rod("lever")};
  s.joints = {equations::hinge("O", "ground", "crank", {0, 0, 0}, crank),
              equations::hinge("A", "crank", "coupler", {A.norm(), 0, 0}, coupler - crank),
              equations::hinge("P", "coupler", "link", {p.x(), p.y(), 0}, link - coupler),
              equations::hinge("C", "ground", "rocker", {C.x(), C.y(), 0}, rocker),
              equations::hinge("E", "ground", "lever", {E.x(), E.y(), 0}, lever)};
  s.loops = {pin("B", "coupler", "rocker", {(B - A).norm(), 0, 0}, {(B - C).norm(), 0, 0}),
             pin("D", "link", "lever", {(D - P).norm(), 0, 0}, {(D - E).norm(), 0, 0})};
  const MoveResult r = moved(s, "E", "C", 0.02);
  int seen = 0;
  for (const MovedPose& pose : r.poses) {
    if (pose.kind != MovedPose::Kind::sample || !(pose.transmission_angle > 0.02)) continue;
    const auto along = [](double angle) { return Vector2d(std::cos(angle), std::sin(angle)); };
    const double o = pose.q[0], ab = o + pose.q[1], pd = ab + pose.q[2], cb = pose.q[3];
    const Vector2d a = A.norm() * along(o), b = C + (B - C).norm() * along(cb),
                   at_p = a + Eigen::Rotation2Dd(ab) * p;
    Eigen::Matrix2d lines;
    lines << along(o), -along(pd);
    if (std::abs(lines.determinant()) < 0.05) continue;  // they meet far away
    const Vector2d meet = along(o) * lines.inverse().row(0).dot(at_p);
    if ((meet - b).norm() < 0.05) continue;
    ++seen;
    EXPECT_NEAR(std::sin(pose.transmission_angle), sine(meet - b, b - C), 1e-6);
    // What follows the lines of the links themselves is another angle.
    if (seen == 1) {
      EXPECT_GT(std::abs(std::sin(pose.transmission_angle) - sine(b - a, b - C)), 0.01);
    }
  }
  EXPECT_GT(seen, 10);
}

TEST(TransmissionAngle, IsRefusedWhereNothingIsTransmitted) {
  const Scene scene = four_bar(1, 2, 1.8, 2.2, 1, false);
  const auto says = [&](const std::string& output) {
    return equations::thrown<SceneError>([&] { moved(scene, "O", output); });
  };
  EXPECT_NE(says("O").find("is swept or held"), std::string::npos) << says("O");
  EXPECT_NE(says("X").find("'X' is not known"), std::string::npos) << says("X");
}

}  // namespace
}  // namespace momenta::dae_transmission
