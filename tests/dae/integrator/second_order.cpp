// Poses that are free to first order and rigid to second: two stretched rods, flat polygons with
// one edge as long as all others together. They are refused, in a sentence that names the rates;
// those that meet two motions go on.

#include "equations/large_scenes.h"
#include "equations/linkages.h"
#include "equations/parts.h"
#include "equations/refusal.h"

#include <gtest/gtest.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/dae/study/extremes.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <cmath>
#include <numbers>
#include <random>

namespace momenta::dae_second_order {
namespace {

using namespace equations;

std::string refusal(const Scene& scene, Assembled what = Assembled::motion) {
  return equations::thrown<SceneError>([&] { assemble(Mechanism(scene), what); });
}
bool is_told(const std::string& sentence, const std::string& part) {
  return sentence.find(part) != std::string::npos;
}

/// A polygon whose edges lie in one line, edge i along +x or −x, the last the ground's.
Scene flat_polygon(const std::vector<double>& edges) {
  Scene scene;
  scene.gravity = {0, -9.81, 0};
  double way = 0, direction = 1;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const double length = std::abs(edges[i]), towards = edges[i] > 0 ? 1 : -1;
    BodySpec body = equations::make_body("rod" + std::to_string(i), length,
                                         {1e-3, length * length / 12, length * length / 12},
                                         {length / 2, 0, 0});
    JointSpec joint = equations::make_joint(JointKind::revolute, "J" + std::to_string(i), "ground",
                                            body.name, {0, 0, 0}, {0, 0, 1});
    if (i > 0) {
      joint.parent = scene.bodies.back().name;
      joint.origin_parent = {std::abs(edges[i - 1]), 0, 0};
    }
    joint.position = {towards == direction ? 0 : std::numbers::pi};
    direction = towards;
    way += edges[i];
    scene.bodies.push_back(body);
    scene.joints.push_back(joint);
  }
  LoopSpec loop =
      equations::make_loop(LoopKind::revolute, "last", "ground", scene.bodies.back().name,
                           {way, 0, 0}, {std::abs(edges[edges.size() - 2]), 0, 0});
  loop.axis = {0, 0, 1};
  scene.loops.push_back(loop);
  return scene;
}

/// Seen from the line the closed polygon's form is that of its edges a_i with their signs,
/// Σ a_i θ_i² where Σ a_i θ_i = 0: of one sign only where a single edge goes against the others.
TEST(SecondOrder, FlatPolygonsMoveUnlessOneEdgeGoesAgainstAllOthers) {
  std::mt19937 random(1);
  int rigid = 0, moving = 0;
  for (int i = 0; i < 60; ++i) {
    const std::size_t n = 3 + static_cast<std::size_t>(i % 3);
    std::vector<double> edges(n);
    double sum = 0;
    for (std::size_t k = 0; k + 1 < n; ++k) {
      edges[k] = 0.2 + static_cast<double>(random() % 1000) / 1000;
      if (random() % 2 == 0) edges[k] = -edges[k];
      sum += edges[k];
    }
    if (std::abs(sum) < 0.1) continue;
    edges[n - 1] = -sum;
    const auto up = std::count_if(edges.begin(), edges.end(), [](double a) { return a > 0; });
    const bool is_rigid = up == 1 || up == static_cast<long>(n) - 1;
    SCOPED_TRACE(testing::Message() << i << ", " << n << " edges, " << up << " forwards");
    for (const bool in_space : {false, true}) {
      Scene scene = flat_polygon(edges);
      if (in_space)
        scene = turned(scene, Eigen::Quaterniond(
                                  Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized())));
      const std::string sentence = refusal(scene);
      if (is_rigid) {
        EXPECT_TRUE(is_told(sentence, "the mechanism cannot move at its start: at the rates "));
        EXPECT_TRUE(is_told(sentence, "loop 'last' opens with the square of the way"));
      } else {
        EXPECT_EQ(sentence, "");
      }
    }
    ++(is_rigid ? rigid : moving);
  }
  EXPECT_GT(rigid, 10);
  EXPECT_GT(moving, 10);
}

TEST(SecondOrder, TwoStretchedRodsAreNamedWithTheirRates) {
  for (const Assembled what : {Assembled::rates, Assembled::motion}) {
    const std::string sentence = refusal(flat_polygon({1, 1, -2}), what);
    EXPECT_TRUE(is_told(sentence, "at the rates J0.u = -0.5, J1.u = 1 the loops stay closed") ||
                is_told(sentence, "at the rates J1.u = 1, J0.u = -0.5 the loops stay closed"))
        << sentence;
    EXPECT_TRUE(is_told(sentence, "whichever way it goes")) << sentence;
  }
}

TEST(SecondOrder, StretchedChainsInSpaceAreRigidButForTheirSpin) {
  for (const int n : {2, 3, 5}) {
    EXPECT_TRUE(is_told(refusal(stretched_chain(n, n, true)),
                        "part of the mechanism cannot move at its start"))
        << n;
    EXPECT_EQ(refusal(stretched_chain(n, (1 - 1e-4) * n, true)), "") << n;
  }
}

/// What moves beside them does not hide them, nor do two of them hide each other.
TEST(SecondOrder, APartIsToldAsWell) {
  Scene scene = flat_polygon({1, 1, -2});
  Scene second = flat_polygon({0.5, 0.25, -0.75});
  for (BodySpec& body : second.bodies) body.name += " too";
  for (JointSpec& joint : second.joints) {
    joint.name += " too";
    joint.child += " too";
    if (joint.parent != "ground") joint.parent += " too";
  }
  for (LoopSpec& loop : second.loops) {
    loop.name += " too";
    loop.child += " too";
  }
  Scene both = scene;
  both.bodies.insert(both.bodies.end(), second.bodies.begin(), second.bodies.end());
  both.joints.insert(both.joints.end(), second.joints.begin(), second.joints.end());
  both.loops.insert(both.loops.end(), second.loops.begin(), second.loops.end());
  EXPECT_TRUE(is_told(refusal(both), "the mechanism cannot move at its start"));
  Scene beside = scene;  // a pendulum
  beside.bodies.push_back(second.bodies[0]);
  beside.joints.push_back(second.joints[0]);
  EXPECT_TRUE(is_told(refusal(beside), "part of the mechanism cannot move at its start"));
  const std::string words = refusal(beside);
  EXPECT_FALSE(is_told(words, "J0 too")) << words;
}

TEST(SecondOrder, FormsOfConstraintsDecide) {
  const auto told = [](const std::string& constraints) {
    return refusal(
        parse_scene("[lagrangian]\ncoordinates = [\"x\", \"y\", \"z\"]\n"
                    "kinetic = \"x.dot^2 + y.dot^2 + z.dot^2\"\nconstraints = [" +
                    constraints + "]\n"));
  };
  const std::string rigid = "cannot move at its start";
  EXPECT_TRUE(is_told(told("{ name = \"a\", equation = \"x^2 + y^2 + z^2\" }"), rigid));
  EXPECT_TRUE(is_told(told("{ name = \"a\", equation = \"x^2 + x*y + y^2\" }"), "part of"));
  EXPECT_TRUE(is_told(told("{ name = \"a\", equation = \"x^2 - y^2 + z^2/9\" }, "
                           "{ name = \"b\", equation = \"y^2 - x^2/2 + z^2\" }"),
                      rigid));  // their sum is positive
  EXPECT_EQ(told("{ name = \"a\", equation = \"x^2 - y^2\" }"), "");
  EXPECT_EQ(told("{ name = \"a\", equation = \"x*y\" }, { name = \"b\", equation = \"y*z\" }"), "");
  // No sum of x² − y² and x y is positive, and no direction has both zero; beside them z is free.
  EXPECT_TRUE(is_told(told("{ name = \"a\", equation = \"x^2 - y^2\" }, "
                           "{ name = \"b\", equation = \"x*y\" }"),
                      "whether it can move is undecided: at the rates "));
}

TEST(SecondOrder, WhatMovesFromSingularPosesGoesOn) {
  EXPECT_EQ(refusal(row_of_four_bars(3, 0, 1)), "");
  EXPECT_EQ(refusal(row_of_four_bars(2, std::numbers::pi / 2, -1)), "");
  EXPECT_EQ(refusal(bricard()), "");
  EXPECT_EQ(refusal(flat_polygon({1, 2, -1, -2})), "");
}

}  // namespace
}  // namespace momenta::dae_second_order
