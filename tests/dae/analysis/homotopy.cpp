// All solutions of polynomials and all assemblies by paths: roots that are known, Bézout numbers,
// the counts of the literature, and what a search finds.

#include "equations/assembled_linkages.h"
#include "equations/parts.h"
#include "equations/refusal.h"

#include <gtest/gtest.h>
#include <momenta/dae/analysis/kinematics/homotopy.h>

#include <cmath>
#include <numbers>
#include <random>

namespace momenta::dae_homotopy {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using equations::along;
using equations::angle_of;
using equations::closed_four_bar;
using equations::found_in;
using equations::pin;
using equations::rod_between;
using std::numbers::pi;

/// Π (x − r_k)
Polynomial with_roots(const std::vector<Complex>& roots) {
  Polynomial p{{1, {}}};
  for (const Complex& r : roots) p = p * Polynomial{{1, {0}}, {-r, {}}};
  return p;
}

TEST(Homotopy, FindsTheRootsOfAPolynomial) {
  const std::vector<Complex> roots{{1, 0}, {-2, 0.5}, {0, 3}, {0.2, -0.7}, {4, 4}};
  const PolynomialSystem system({with_roots(roots)}, std::vector<int>{0});
  EXPECT_EQ(system.bezout(1000), 5);
  const HomotopyEnds ends = solve_by_homotopy(system, 1, 1);
  EXPECT_TRUE(ends.proved());
  ASSERT_EQ(ends.finite.size(), 5u);
  for (const Complex& r : roots) {
    double nearest = 1e300;
    for (const auto& x : ends.finite) nearest = std::min(nearest, std::abs(x[0] / x[1] - r));
    EXPECT_LT(nearest, 1e-11) << r;
  }
}

/// x y = 1 and x + y = 3 as a total degree of 2 in one group, as 2 in two; and x² = y, x² = y + 1,
/// whose solutions all stand at infinity.
TEST(Homotopy, TellsWhatIsAtInfinity) {
  const Polynomial product{{1, {0, 1}}, {-1, {}}}, sum{{1, {0}}, {1, {1}}, {-3, {}}};
  for (const std::vector<int>& groups : {std::vector<int>{0, 0}, std::vector<int>{0, 1}}) {
    const HomotopyEnds ends = solve_by_homotopy(PolynomialSystem({product, sum}, groups), 3, 1);
    EXPECT_EQ(ends.paths, 2);
    ASSERT_EQ(ends.finite.size(), 2u);
    for (const auto& x : ends.finite) {
      const Complex one = x[2], other = groups[1] == 0 ? x[2] : x[3];
      EXPECT_LT(std::abs(x[0] / one + x[1] / other - 3.0), 1e-12);
    }
  }
  const Polynomial first{{1, {0, 0}}, {-1, {1}}}, second{{1, {0, 0}}, {-1, {1}}, {-1, {}}};
  const HomotopyEnds none =
      solve_by_homotopy(PolynomialSystem({first, second}, std::vector<int>{0, 0}), 3, 1);
  EXPECT_EQ(none.paths, 4);
  EXPECT_EQ(none.finite.size(), 0u);
  EXPECT_EQ(none.infinite + none.singular, 4);
  EXPECT_EQ(none.lost, 0);
}

/// (x − 1)² (x + 2): one regular root, and one that two paths share.
TEST(Homotopy, TellsMultipleRootsApart) {
  const HomotopyEnds ends =
      solve_by_homotopy(PolynomialSystem({with_roots({1, 1, -2})}, std::vector<int>{0}), 5, 1);
  EXPECT_EQ(ends.paths, 3);
  ASSERT_EQ(ends.finite.size(), 1u);
  EXPECT_LT(std::abs(ends.finite[0][0] / ends.finite[0][1] + 2.0), 1e-12);
  EXPECT_EQ(ends.singular, 2);
  EXPECT_FALSE(ends.proved());
}

/// Every pose of either is one of the other, and closes the loops.
void expect_same(const Scene& scene, const Assemblies& all, const Assemblies& searched) {
  const Mechanism mechanism(scene);
  const auto e = mechanism.evaluation<double>();
  for (const FoundAssembly& a : all.all) {
    VectorXd phi(mechanism.m());
    e->place(0, a.q.data());
    e->positions(phi.data());
    EXPECT_LT(phi.cwiseAbs().maxCoeff(), 1e-12);
  }
  EXPECT_EQ(all.all.size(), searched.all.size());
  for (const FoundAssembly& s : searched.all) {
    double nearest = 1e300;
    for (const FoundAssembly& a : all.all)
      nearest = std::min(nearest, std::abs(a.apart - s.apart) + (a.q - s.q).cwiseAbs().maxCoeff());
    EXPECT_LT(nearest, 1e-7);
  }
}

TEST(CountedAssemblies, OfAFourBarAreTwo) {
  for (const double theta : {0.3, 1.7, 4.0}) {
    AssembliesRequest request;
    request.hold = {"O"};
    request.by_homotopy = true;
    const Assemblies all = found_in(closed_four_bar(theta), request);
    ASSERT_TRUE(all.paths.has_value());
    EXPECT_TRUE(all.paths->is_complete());
    EXPECT_EQ(all.paths->paths, 2);
    EXPECT_EQ(all.paths->finite, 2);
    EXPECT_EQ(all.paths->real, 2);
    request.by_homotopy = false;
    request.starts = 200;
    expect_same(closed_four_bar(theta), all, found_in(closed_four_bar(theta), request));
  }
}

/// A slider on an inclined way, the crank held; and the slide held, the crank free.
TEST(CountedAssemblies, OfASliderCrankAreTwo) {
  const double a = 0.6, b = 1.5, theta = 0.9, incline = 0.2;
  const Vector2d way = along(incline), A = a * along(theta);
  const double s = A.dot(way) + std::sqrt(b * b - std::pow(A.x() * way.y() - A.y() * way.x(), 2));
  const Vector2d P = s * way;
  Scene scene;
  scene.name = "slider-crank";
  scene.bodies = {equations::rod("crank"), equations::rod("coupler"), equations::rod("slider")};
  JointSpec slide = equations::make_joint(JointKind::prismatic, "S", "ground", "slider", {0, 0, 0},
                                          {way.x(), way.y(), 0}, {s});
  scene.joints = {equations::hinge("O", "ground", "crank", {0, 0, 0}, theta),
                  equations::hinge("A", "crank", "coupler", {a, 0, 0}, angle_of(P - A) - theta),
                  slide};
  scene.loops = {pin("P", "coupler", "slider", {b, 0, 0}, {0, 0, 0})};
  for (const char* held : {"O", "S"}) {
    AssembliesRequest request;
    request.hold = {held};
    request.by_homotopy = true;
    const Assemblies all = found_in(scene, request);
    EXPECT_TRUE(all.paths->is_complete()) << held;
    EXPECT_EQ(all.paths->finite, 2) << held;
    request.by_homotopy = false;
    request.starts = 200;
    expect_same(scene, all, found_in(scene, request));
  }
}

/// Six-bars with the link at E held: Stephenson's, whose two loops are one group of Assur, has
/// six solutions over the complex numbers, Watt's, two dyads one after the other, has four.
Scene six_bar(std::mt19937& random, bool of_watt) {
  std::uniform_real_distribution<double> any(-0.5, 0.5);
  const auto near = [&](double x, double y) { return Vector2d(x + any(random), y + any(random)); };
  const Vector2d A = near(0.5, 0.8), C = near(1.5, 0), B = near(1.6, 1.2), P = near(1.0, 1.6),
                 D = near(0.8, 0.6), E = near(-0.5, 1.5);
  const double coupler = angle_of(B - A), crank = angle_of(A), link = angle_of(D - P);
  const Vector2d p = Eigen::Rotation2Dd(-coupler) * (P - A);
  Scene s;
  s.name = of_watt ? "Watt" : "Stephenson";
  s.bodies = {equations::rod("crank"), equations::rod("coupler"), equations::rod("rocker"),
              equations::rod("link"), equations::rod("lever")};
  s.joints = {equations::hinge("O", "ground", "crank", {0, 0, 0}, crank),
              equations::hinge("A", "crank", "coupler", {A.norm(), 0, 0}, coupler - crank),
              equations::hinge("P", "coupler", "link", {p.x(), p.y(), 0}, link - coupler),
              equations::hinge("C", "ground", "rocker", {C.x(), C.y(), 0}, angle_of(B - C)),
              equations::hinge("E", "ground", "lever", {E.x(), E.y(), 0}, angle_of(D - E))};
  s.loops = {pin("B", "coupler", "rocker", {(B - A).norm(), 0, 0}, {(B - C).norm(), 0, 0}),
             pin("D", "link", "lever", {(D - P).norm(), 0, 0}, {(D - E).norm(), 0, 0})};
  return s;
}

TEST(CountedAssemblies, OfSixBarsAreSixAndFour) {
  std::mt19937 random(4);
  for (int k = 0; k < 6; ++k)
    for (const bool of_watt : {false, true}) {
      const Scene scene = six_bar(random, of_watt);
      AssembliesRequest request;
      request.hold = {of_watt ? "O" : "E"};
      request.by_homotopy = true;
      const Assemblies all = found_in(scene, request);
      EXPECT_EQ(all.paths->paths, 6);
      EXPECT_EQ(all.paths->finite, of_watt ? 4 : 6) << k;
      EXPECT_EQ(all.paths->infinite, of_watt ? 2 : 0) << k;
      EXPECT_TRUE(all.paths->is_complete());
      request.by_homotopy = false;
      request.starts = 400;
      expect_same(scene, all, found_in(scene, request));
    }
}

TEST(CountedAssemblies, OfAPlanarPlatformAreSix) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int k = 0; k < 6; ++k) {
    Scene s;
    s.name = "platform";
    s.bodies = {equations::rod("platform")};
    JointSpec joint =
        equations::make_joint(JointKind::planar, "P", "ground", "platform", {0, 0, 0}, {0, 0, 1},
                              {0.4 * any(random), 0.4 * any(random), 2 * any(random)});
    s.joints = {joint};
    const Eigen::Rotation2Dd turn(joint.position[2]);
    const Vector2d place(joint.position[0], joint.position[1]);
    for (int i = 0; i < 3; ++i) {
      const Vector2d b = 1.5 * along(2 * pi * i / 3 + 0.3 * any(random)),
                     p = 0.9 * along(2 * pi * i / 3 + 0.8 * any(random));
      s.loops.push_back(rod_between("L" + std::to_string(i), "platform", {b.x(), b.y(), 0},
                                    {p.x(), p.y(), 0}, (place + turn * p - b).norm()));
    }
    AssembliesRequest request;
    request.by_homotopy = true;
    const Assemblies all = found_in(s, request);
    EXPECT_EQ(all.paths->paths, 6);
    EXPECT_EQ(all.paths->finite, 6);
    EXPECT_TRUE(all.paths->is_complete());
    request.by_homotopy = false;
    request.starts = 300;
    expect_same(s, all, found_in(s, request));
  }
}

/// Six rods between points in general position.
Scene stewart(std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  Scene s;
  s.name = "platform on six rods";
  s.bodies = {equations::rod("platform")};
  JointSpec joint = equations::make_joint(JointKind::free, "P", "ground", "platform");
  const Vector3d place(0.2, -0.1, 1.1);
  const Eigen::Quaterniond at(
      Eigen::AngleAxisd(0.5, Vector3d(any(random), any(random), 1).normalized()));
  joint.position = {place.x(), place.y(), place.z(), at.w(), at.x(), at.y(), at.z()};
  s.joints = {joint};
  for (int i = 0; i < 6; ++i) {
    const Vector3d b(any(random), any(random), 0.5 * any(random)),
        p(0.6 * any(random), 0.6 * any(random), 0.4 * any(random));
    s.loops.push_back(
        rod_between("L" + std::to_string(i), "platform", b, p, (place + at * p - b).norm()));
  }
  return s;
}

TEST(CountedAssemblies, OfAPlatformOnSixRodsAreForty) {
  std::mt19937 random(7);
  for (int k = 0; k < 2; ++k) {
    const Scene scene = stewart(random);
    AssembliesRequest request;
    request.by_homotopy = true;
    request.threads = 2;
    const Assemblies all = found_in(scene, request);
    EXPECT_EQ(all.paths->paths, 128);
    EXPECT_EQ(all.paths->finite, 40);
    EXPECT_EQ(all.paths->infinite, 88);
    EXPECT_TRUE(all.paths->is_complete());
    EXPECT_EQ(all.paths->real % 2, 0);
    EXPECT_EQ(all.paths->real, static_cast<long>(all.all.size()));
    request.by_homotopy = false;
    request.starts = 300;
    expect_same(scene, all, found_in(scene, request));
  }
}

TEST(CountedAssemblies, AreRefusedOfLoopsThatAreNoPolynomials) {
  const auto says = [](const Scene& scene, const AssembliesRequest& request) {
    return equations::thrown<SceneError>([&] { found_in(scene, request); });
  };
  AssembliesRequest request;
  request.hold = {"O"};
  request.by_homotopy = true;
  AssembliesRequest free;
  free.by_homotopy = true;
  Scene doubled = closed_four_bar(0.3);
  doubled.loops.push_back(doubled.loops[0]);
  doubled.loops[1].name = "again";
  EXPECT_NE(says(doubled, request).find("loop equations are redundant"), std::string::npos)
      << says(doubled, request);
  Scene geared = closed_four_bar(0.3);
  LoopSpec gear;
  gear.name = "gear";
  gear.kind = LoopKind::coupler;
  gear.joints = {"O", "A"};
  gear.ratios = {1, 1};
  gear.offset = geared.joints[0].position[0] + geared.joints[1].position[0];
  geared.loops.push_back(gear);
  EXPECT_NE(says(geared, free).find("loop 'gear' of kind coupler"), std::string::npos)
      << says(geared, free);
  std::mt19937 random(2);
  Scene five = stewart(random);
  five.joints[0].kind = JointKind::spherical;
  five.joints[0].position.erase(five.joints[0].position.begin(),
                                five.joints[0].position.begin() + 3);
  for (LoopSpec& l : five.loops) {
    const Eigen::Quaterniond at(five.joints[0].position[0], five.joints[0].position[1],
                                five.joints[0].position[2], five.joints[0].position[3]);
    l.length = (at * l.origin_child - l.origin_parent).norm();
  }
  five.loops.resize(3);
  EXPECT_NE(says(five, free).find("not written as polynomials"), std::string::npos)
      << says(five, free);
}

}  // namespace
}  // namespace momenta::dae_homotopy
