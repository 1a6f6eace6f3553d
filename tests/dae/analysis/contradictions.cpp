// Redundant equations whose numbers a file has rounded: every verb takes the mechanism for what it
// is, as far as the numbers agree.

#include "equations/parts.h"
#include "equations/swept_four_bar.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/analysis/effort/effort.h>
#include <momenta/dae/analysis/kinematics/move.h>
#include <momenta/dae/analysis/linear/linear_model.h>
#include <momenta/dae/study/modes_study.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

namespace momenta::dae_contradictions {
namespace {

using Eigen::VectorXd;
using equations::FourBar, equations::moved;
using std::numbers::pi;

std::string digits(double x, int count) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", count, x);
  return text;
}

/// Bennett's linkage, five loop equations of rank two, its numbers of so many digits. Twists α and
/// β, lengths sin α and sin β to each other, and tan(θ₀/2) tan(θ₁/2) = sin((β+α)/2)/sin((β−α)/2).
Scene bennett(int count) {
  const double alpha = 0.6, beta = 1.1, theta = 0.8;
  const double b = std::sin(beta) / std::sin(alpha),
               next = 2 * std::atan(std::sin((beta + alpha) / 2) / std::sin((beta - alpha) / 2) /
                                    std::tan(theta / 2));
  const auto d = [&](double x) { return digits(x, count); };
  const std::string rods[] = {d(1), d(b), d(1)}, twists[] = {d(0), d(alpha), d(beta)},
                    angles[] = {d(theta), d(next), d(-theta)};
  std::string text = "gravity = [0, 0, -9.81]\n";
  for (int i = 0; i < 3; ++i) {
    const std::string n = std::to_string(i);
    text += "[[body]]\nname = 'b" + n + "'\nmass = 1\nshape = {kind = 'rod', length = " + rods[i] +
            "}\n[[joint]]\nname = 'J" + n + "'\nkind = 'revolute'\nparent = '" +
            (i == 0 ? "ground" : "b" + std::to_string(i - 1)) + "'\nchild = 'b" + n +
            "'\norigin = {parent = [" + (i == 0 ? "0" : rods[i - 1]) +
            ", 0, 0]}\nrotation = {axis = 'x', angle = " + twists[i] +
            "}\nposition = " + angles[i] + "\n";
  }
  text +=
      "[[loop]]\nname = 'L'\nkind = 'revolute'\nparent = 'ground'\nchild = 'b2'\n"
      "origin = {parent = [" +
      d(-b) +
      ", 0, 0], child = [1, 0, 0]}\n"
      "rotation = {axis = 'x', angle = " +
      d(-alpha - beta) + "}\naxis = [0, " + d(-std::sin(alpha)) + ", " + d(std::cos(alpha)) + "]\n";
  return parse_scene(text);
}

/// A four-bar, one of its pins tilted out of the plane: five loop equations of rank two.
Scene tilted(double by, const FourBar& bars, double theta) {
  Scene s = bars.scene(theta, -1);
  s.joints[2].axis = Eigen::Vector3d(by, 0, 1).normalized();
  s.gravity = {0, -9.81, 0};
  s.held = {"O"};
  return s;
}
Scene four_bar(double tilt) {
  return tilted(tilt, {0.5, 2, 1.5, 2}, 1);
}

double held_by(const Scene& scene, const std::string& actuator) {
  EffortRequest request;
  request.motion.poses_alone = true;
  request.motion.times = {0};
  request.actuated = {actuator};
  return effort(Mechanism(scene), request).rows.front().effort[0];
}

ModesResult modes(const Scene& scene) {
  const Mechanism mechanism(scene);
  return find_modes(mechanism, assemble(mechanism).start, {});
}

void expect_same_curve(const MoveResult& r, const MoveResult& exact, double within) {
  ASSERT_EQ(r.end, MoveResult::End::closed) << within << r.why;
  ASSERT_EQ(r.poses.size(), exact.poses.size()) << within;
  EXPECT_EQ(r.dead_points(), exact.dead_points()) << within;
  EXPECT_EQ(r.change_points(), exact.change_points()) << within;
  for (std::size_t i = 0; i < r.poses.size(); ++i) {
    EXPECT_LT((r.poses[i].q - exact.poses[i].q).cwiseAbs().maxCoeff(), within) << i;
    if (exact.poses[i].u.size() == 0 || r.poses[i].u.size() == 0) continue;
    EXPECT_LT((r.poses[i].u - exact.poses[i].u).cwiseAbs().maxCoeff(), within) << i;
  }
}

TEST(Contradictions, BennettsLinkageGoesRound) {
  const MoveResult exact = moved(bennett(17), "J0");
  EXPECT_EQ(exact.poses.size(), 361U);
  for (const int count : {12, 11, 10, 9, 8})
    expect_same_curve(moved(bennett(count), "J0"), exact, 20 * std::pow(10.0, -count + 1));
  // Of 13 digits what is left is rounding; of seven, assembly begins elsewhere on the curve.
  for (const int count : {13, 7}) {
    const MoveResult r = moved(bennett(count), "J0");
    EXPECT_EQ(r.end, MoveResult::End::closed) << count << r.why;
    EXPECT_EQ(r.poses.size(), exact.poses.size()) << count;
  }
}

/// Three of five equations follow from the others where the loop is closed, and nowhere else: by
/// whatever steps, the joints follow sin(θ₀/2) sin(θ₁/2) = K cos(θ₀/2) cos(θ₁/2).
TEST(Contradictions, BennettsLinkageFollowsItsDrive) {
  const Mechanism mechanism(bennett(17));
  const double K = std::sin(0.85) / std::sin(0.25);
  for (const int samples : {40, 57, 100, 400}) {
    EffortRequest request;
    request.motion.drives = {equations::polynomial("J0", {0.8, 1, 0.3})};
    for (int i = 0; i <= samples; ++i) request.motion.times.push_back(2.0 * i / samples);
    const EffortResult r = effort(mechanism, request);
    ASSERT_EQ(r.rows.size(), request.motion.times.size());
    for (const EffortRow& row : r.rows) {
      EXPECT_NEAR(row.q[0], 0.8 + row.t + 0.3 * row.t * row.t, 1e-12) << samples;
      EXPECT_NEAR(row.u[0], 1 + 0.6 * row.t, 1e-10) << samples;
      const double a = row.q[0] / 2, b = row.q[1] / 2;
      EXPECT_NEAR(std::sin(a) * std::sin(b), K * std::cos(a) * std::cos(b), 1e-11) << samples;
      EXPECT_NEAR((std::cos(a) * std::sin(b) + K * std::sin(a) * std::cos(b)) * row.u[0],
                  -(std::sin(a) * std::cos(b) + K * std::cos(a) * std::sin(b)) * row.u[1], 1e-9)
          << samples;
    }
  }
}

TEST(Contradictions, FourBarsWithATiltedPinGoRound) {
  const MoveResult exact = moved(four_bar(0), "O"), rocked = moved(four_bar(0), "C");
  EXPECT_EQ(exact.poses.size(), 361U);
  EXPECT_EQ(rocked.dead_points(), 2);
  for (const double tilt : {1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 5e-7}) {
    expect_same_curve(moved(four_bar(tilt), "O"), exact, 20 * tilt);
    EXPECT_EQ(moved(four_bar(tilt), "C").poses.size(), rocked.poses.size()) << tilt;
  }
}

TEST(Contradictions, TiltedParallelogramsCrossWhereTheyAreFlat) {
  const auto at = [](double tilt) { return moved(tilted(tilt, {1, 2, 1, 2}, 1), "O"); };
  const MoveResult exact = at(0);
  EXPECT_EQ(exact.change_points(), 2);
  for (const double tilt : {1e-10, 1e-8, 1e-7}) {
    const MoveResult r = at(tilt);
    EXPECT_EQ(r.end, MoveResult::End::closed) << r.why;
    EXPECT_EQ(r.change_points(), 2) << tilt;
    EXPECT_EQ(r.poses.size(), exact.poses.size()) << tilt;
  }
}

TEST(Contradictions, EffortsAndModesAreThoseOfNumbersThatAgree) {
  const auto expect_same = [](const Scene& scene, const Scene& exact, const char* name,
                              double within) {
    EXPECT_NEAR(held_by(scene, name), held_by(exact, name), within);
    const ModesResult found = modes(scene), right = modes(exact);
    ASSERT_EQ(found.spectrum.modes.size(), right.spectrum.modes.size());
    EXPECT_LT((found.equilibrium.q - right.equilibrium.q).cwiseAbs().maxCoeff(), within);
    EXPECT_LT(std::abs(found.spectrum.modes[0].s - right.spectrum.modes[0].s), 10 * within);
    // The linear model has the same pair, alone.
    const Mechanism mechanism(scene);
    const LinearModel model = linear_model(mechanism, found.equilibrium);
    ASSERT_EQ(model.poles.size(), 2);
    EXPECT_NEAR(std::abs(model.poles[0].imag()), std::abs(found.spectrum.modes[0].s.imag()), 1e-8);
  };
  for (const double tilt : {1e-12, 1e-10, 1e-9, 1e-8, 1e-7, 3e-7, 5e-7})
    expect_same(four_bar(tilt), four_bar(0), "O", 100 * tilt);
  for (const int count : {13, 12, 11, 10, 9, 8})
    expect_same(bennett(count), bennett(17), "J0", 1000 * std::pow(10.0, -count));
}

}  // namespace
}  // namespace momenta::dae_contradictions
