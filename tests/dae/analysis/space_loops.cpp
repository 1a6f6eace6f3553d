// All assemblies of single loops in space by paths: the sixteen of six hinges, loops of fewer
// freedoms, and what a search finds.

#include "equations/assembled_linkages.h"
#include "equations/parts.h"
#include "equations/refusal.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace momenta::dae_space_loops {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;
using equations::found_in;
using std::numbers::pi;

Vector3d any_vector(std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  return {any(random), any(random), any(random)};
}

/// A line in the own pose, in ground axes; or a way.
struct Line {
  Vector3d centre, way;
  bool slides = false;
};

/// Bodies on lines one after the other, all with the axes of the ground in the own pose, the last
/// welded to the ground by a loop. Joints are J0, J1, …
Scene ring(const std::vector<Line>& lines) {
  Scene s;
  s.name = "ring";
  Vector3d before = Vector3d::Zero();
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const std::string n = std::to_string(k);
    s.bodies.push_back(equations::rod("b" + n));
    s.joints.push_back(
        equations::make_joint(lines[k].slides ? JointKind::prismatic : JointKind::revolute, "J" + n,
                              k == 0 ? "ground" : "b" + std::to_string(k - 1), "b" + n,
                              lines[k].centre - before, lines[k].way.normalized()));
    before = lines[k].centre;
  }
  LoopSpec weld;
  weld.name = "W";
  weld.kind = LoopKind::weld;
  weld.child = s.bodies.back().name;
  weld.origin_parent = before;
  s.loops = {weld};
  return s;
}

std::vector<Line> any_lines(std::mt19937& random, int n) {
  std::vector<Line> lines;
  for (int k = 0; k < n; ++k) lines.push_back({any_vector(random), any_vector(random)});
  return lines;
}

Assemblies all_of(const Scene& scene, const std::vector<std::string>& hold = {}) {
  AssembliesRequest request;
  request.hold = hold;
  request.by_homotopy = true;
  request.threads = 2;
  return found_in(scene, request);
}

/// Every pose closes the loops, and those that a search finds are the same.
void expect_searched(const Scene& scene, const Assemblies& all, int starts,
                     const std::vector<std::string>& hold = {}) {
  const Mechanism mechanism(scene);
  const auto e = mechanism.evaluation<double>();
  for (const FoundAssembly& a : all.all) {
    VectorXd phi(mechanism.m());
    e->place(0, a.q.data());
    e->positions(phi.data());
    EXPECT_LT(phi.cwiseAbs().maxCoeff(), 1e-12);
  }
  AssembliesRequest request;
  request.hold = hold;
  request.starts = starts;
  request.threads = 2;
  const Assemblies searched = found_in(scene, request);
  EXPECT_TRUE(all.paths->is_complete());
  EXPECT_EQ(all.all.size(), searched.all.size());
  for (const FoundAssembly& s : searched.all) {
    double nearest = 1e300;
    for (const FoundAssembly& a : all.all) {
      double gap = 0;
      for (Eigen::Index k = 0; k < s.q.size(); ++k)
        gap = equations::larger(gap, std::abs(std::remainder(a.q[k] - s.q[k], 2 * pi)));
      nearest = std::min(nearest, gap);
    }
    EXPECT_LT(nearest, 1e-6);
  }
}

TEST(SpaceLoops, OfSixHingesInGeneralAreSixteen) {
  std::mt19937 random(3);
  long most = 0;
  for (int k = 0; k < 2; ++k) {
    const Scene scene = ring(any_lines(random, 6));
    const Assemblies all = all_of(scene);
    EXPECT_EQ(all.paths->paths, 32);
    EXPECT_EQ(all.paths->finite, 16) << k;
    EXPECT_EQ(all.paths->infinite, 16) << k;
    EXPECT_EQ(all.paths->real % 2, 0);
    EXPECT_EQ(all.paths->real, static_cast<long>(all.all.size()));
    expect_searched(scene, all, 150);
    most = std::max(most, all.paths->real);
  }
  EXPECT_GE(most, 4);
}

/// An arm whose hand stands where all sixteen are real (R. Manseur, K. L. Doty, Int. J. Robotics
/// Res. 8 (1989) 75-79).
TEST(SpaceLoops, OfAnArmMayAllBeReal) {
  const double degree = pi / 180, along_z[] = {0, 0, 0.2, 0, 0, 0},
               along_x[] = {0.3, 1, 0, 1.5, 0, 0}, twists[] = {90, 1, 90, 1, 90, 1};
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  std::vector<Line> lines;
  for (int k = 0; k < 6; ++k) {
    lines.push_back({frame.translation(), frame.linear().col(2)});
    frame.translate(Vector3d(along_x[k], 0, along_z[k]));
    frame.rotate(Eigen::AngleAxisd(twists[k] * degree, Vector3d::UnitX()));
  }
  Eigen::Matrix3d hand;
  hand << -0.760117, -0.641689, 0.102262,  //
      0.133333, 0, 0.991071,               //
      -0.635959, 0.766965, 0.085558;
  Scene scene = ring(lines);
  LoopSpec& weld = scene.loops[0];
  weld.origin_parent = Vector3d(-1.140175, 0, 0);
  weld.origin_child = frame.translation() - lines[5].centre;
  weld.rotation = Quaterniond(hand * frame.linear().transpose()).normalized();
  for (JointSpec& joint : scene.joints) joint.position = {0.3};
  const Assemblies all = all_of(scene);
  EXPECT_EQ(all.paths->finite, 16);
  EXPECT_EQ(all.paths->real, 16);
  EXPECT_EQ(all.all.size(), 16u);
  expect_searched(scene, all, 600);
}

/// The same loop cut at another joint, its last hinge a loop of kind revolute; with a seventh hinge
/// that is held; and with a body cut in two.
TEST(SpaceLoops, AreTheSameHoweverWritten) {
  std::mt19937 random(8);
  const std::vector<Line> lines = any_lines(random, 6);
  const Assemblies all = all_of(ring(lines));
  Scene cut = ring({lines.begin(), lines.end() - 1});
  LoopSpec& hinge = cut.loops[0];
  hinge.kind = LoopKind::revolute;
  hinge.axis = lines[5].way.normalized();
  hinge.origin_parent = lines[5].centre;
  hinge.origin_child = lines[5].centre - lines[4].centre;
  std::vector<Line> seven = lines, slid = lines;
  seven.insert(seven.begin() + 3, any_lines(random, 1)[0]);
  slid.insert(slid.begin() + 2, any_lines(random, 1)[0]);
  slid[2].slides = true;
  const std::vector<std::pair<Scene, std::vector<std::string>>> others{
      {cut, {}}, {ring(seven), {"J3"}}, {ring(slid), {"J2"}}};
  for (const auto& [scene, hold] : others) {
    const Assemblies other = all_of(scene, hold);
    EXPECT_EQ(other.paths->finite, 16);
    EXPECT_TRUE(other.paths->is_complete());
    ASSERT_EQ(other.all.size(), all.all.size());
    // The first two hinges are J0 and J1 in all of them.
    for (const FoundAssembly& a : all.all) {
      double nearest = 1e300;
      for (const FoundAssembly& b : other.all)
        nearest = std::min(nearest, (a.q.head<2>() - b.q.head<2>()).cwiseAbs().maxCoeff());
      EXPECT_LT(nearest, 1e-9);
    }
  }
}

/// Three lines through one point, as of a wrist: eight. All six through one point or parallel in
/// threes have other counts, or none.
TEST(SpaceLoops, OfAnArmWithAWristAreEight) {
  std::mt19937 random(5);
  for (int k = 0; k < 2; ++k) {
    std::vector<Line> lines = any_lines(random, 6);
    lines[4].centre = lines[3].centre;
    lines[5].centre = lines[3].centre;
    const Scene scene = ring(lines);
    const Assemblies all = all_of(scene);
    EXPECT_EQ(all.paths->finite, 8) << k;
    expect_searched(scene, all, 150);
  }
}

/// Lines that cross one after the other but for the last, so that no choice of halves has two pairs
/// apart.
TEST(SpaceLoops, WhoseLinesCrossOneByOneAreCounted) {
  std::mt19937 random(21);
  Vector3d corners[5];
  for (Vector3d& corner : corners) corner = any_vector(random);
  std::vector<Line> lines{{corners[0], any_vector(random)}};
  for (int i = 0; i < 3; ++i) lines.push_back({corners[i], corners[i + 1] - corners[i]});
  lines.push_back({corners[3], any_vector(random)});
  lines.push_back({corners[4], any_vector(random)});
  const Scene scene = ring(lines);
  const Assemblies all = all_of(scene);
  EXPECT_EQ(all.paths->paths, 40);
  EXPECT_EQ(all.paths->finite, 16);
  expect_searched(scene, all, 150);
}

/// Four hinges, one of them held, lines through one point: two (as of a four-bar in a plane), by
/// R(a, α) R(b, β) v = v' as a quadratic equation. The loop equations are redundant.
TEST(SpaceLoops, OfASphericalFourBarAreTwo) {
  std::mt19937 random(2);
  for (int k = 0; k < 2; ++k) {
    std::vector<Line> lines = any_lines(random, 4);
    for (Line& line : lines) line.centre = Vector3d(0.2, -0.3, 0.4);
    const Scene scene = ring(lines);
    const Assemblies all = all_of(scene, {"J0"});
    EXPECT_EQ(all.paths->finite, 2) << k;
    EXPECT_EQ(all.paths->real, 2) << k;
    expect_searched(scene, all, 100, {"J0"});
  }
}

/// Bennett's linkage: four hinges, sides a and b of twists α and β, a/sin α = b/sin β. With half
/// angles x = tan θ/2 and y = tan φ/2 of neighbours x y is constant, and one is decided by the
/// other.
TEST(SpaceLoops, OfBennettsLinkageAreOne) {
  const double alpha = 0.7, beta = 1.9, a = 0.5, b = a * std::sin(beta) / std::sin(alpha),
               theta = 1.1,
               phi = 2 * std::atan(std::sin((beta + alpha) / 2) /
                                   (std::sin((beta - alpha) / 2) * std::tan(theta / 2)));
  // Denavit and Hartenberg's frames: a turn about z, a shift along x, a twist about it.
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  std::vector<Line> lines;
  const double turns[] = {theta, phi, -theta, -phi};
  for (int k = 0; k < 4; ++k) {
    lines.push_back({frame.translation(), frame.linear().col(2)});
    frame.rotate(Eigen::AngleAxisd(turns[k], Vector3d::UnitZ()));
    frame.translate((k % 2 ? b : a) * Vector3d::UnitX());
    frame.rotate(Eigen::AngleAxisd(k % 2 ? beta : alpha, Vector3d::UnitX()));
  }
  ASSERT_LT((frame.matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-12);
  const Scene scene = ring(lines);
  const Assemblies all = all_of(scene, {"J0"});
  EXPECT_EQ(all.paths->finite, 1);
  EXPECT_EQ(all.all.size(), 1u);
  expect_searched(scene, all, 100, {"J0"});
}

/// A crank that is held, a rod, a rocker: the rod's end lies on a circle and a sphere, twice.
Scene rssr(std::mt19937& random, int writing) {
  const Vector3d a = any_vector(random), b = any_vector(random), foot = any_vector(random),
                 way = any_vector(random).normalized();
  Scene s = ring({{any_vector(random), any_vector(random)}});
  s.bodies.push_back(equations::rod("rocker"));
  JointSpec rocker = s.joints[0];
  rocker.name = "R";
  rocker.child = "rocker";
  rocker.origin_parent = foot;
  rocker.axis = way;
  s.joints.push_back(rocker);
  LoopSpec end = s.loops[0];
  end.parent = "rocker";
  end.origin_parent = b - foot;
  if (writing == 0) {  // the rod a loop of kind distance
    end.kind = LoopKind::distance;
    end.child = "b0";
    end.origin_child = a - s.joints[0].origin_parent;
    end.length = (a - b).norm();
    s.loops = {end};
    return s;
  }
  s.bodies.push_back(equations::rod("rod"));
  JointSpec ball =
      equations::make_joint(JointKind::spherical, "B", "b0", "rod", a - s.joints[0].origin_parent);
  if (writing == 2) {  // the ball two hinges
    ball.kind = JointKind::universal;
    ball.axis2 = (b - a).cross(any_vector(random)).normalized();
    ball.axis = ball.axis2.cross(any_vector(random)).normalized();
  }
  s.joints.push_back(ball);
  end.kind = LoopKind::spherical;
  end.child = "rod";
  end.origin_child = b - a;
  s.loops = {end};
  return s;
}

TEST(SpaceLoops, OfACrankARodAndARockerAreTwo) {
  std::vector<double> angles[3];
  for (const int writing : {0, 1, 2}) {
    std::mt19937 random(1);
    const Scene scene = rssr(random, writing);
    const Assemblies all = all_of(scene, {"J0"});
    // Two pairs of angles of a universal joint are two poses.
    EXPECT_EQ(all.paths->finite, writing == 2 ? 4 : 2) << writing;
    EXPECT_EQ(all.paths->real, writing == 2 ? 4 : 2) << writing;
    EXPECT_TRUE(all.paths->is_complete()) << writing;
    const Mechanism mechanism(scene);
    const int rocker =
        mechanism.tree().bodies[static_cast<std::size_t>(mechanism.tree().carried_by("R"))].q;
    for (const FoundAssembly& found : all.all) angles[writing].push_back(found.q[rocker]);
    std::sort(angles[writing].begin(), angles[writing].end());
    if (writing != 1) expect_searched(scene, all, 60, {"J0"});
  }
  ASSERT_EQ(angles[0].size(), 2u);
  ASSERT_EQ(angles[1].size(), 2u);
  ASSERT_EQ(angles[2].size(), 4u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(angles[0][k], angles[1][k], 1e-10);
    EXPECT_NEAR(angles[0][k], angles[2][2 * k], 1e-10);
  }
}

/// Slides among hinges: what a search finds, too.
TEST(SpaceLoops, WithSlidesAreWhatASearchFinds) {
  std::mt19937 random(12);
  for (const std::vector<std::size_t>& slides : {std::vector<std::size_t>{2}, {1, 4}, {0, 2, 4}}) {
    std::vector<Line> lines = any_lines(random, 6);
    for (const std::size_t k : slides) lines[k].slides = true;
    const Scene scene = ring(lines);
    const Assemblies all = all_of(scene);
    EXPECT_EQ(all.paths->finite, slides.size() == 1 ? 16 : slides.size() == 2 ? 8 : 2);
    expect_searched(scene, all, 150);
  }
}

TEST(SpaceLoops, AreRefusedByWhatMakesThemOthers) {
  const auto says = [](const Scene& scene, const std::vector<std::string>& hold) {
    return equations::thrown<SceneError>([&] { all_of(scene, hold); });
  };
  std::mt19937 random(4);
  std::vector<Line> lines = any_lines(random, 6);
  Scene screw = ring(lines);
  screw.joints[2].kind = JointKind::helical;
  screw.joints[2].pitch = 0.1;
  EXPECT_NE(says(screw, {}).find("joint 'J2' of kind helical"), std::string::npos)
      << says(screw, {});
  const Scene seven = ring(any_lines(random, 7));
  EXPECT_NE(says(seven, {}).find("leaves 1 degree of freedom"), std::string::npos)
      << says(seven, {});
}

}  // namespace
}  // namespace momenta::dae_space_loops
