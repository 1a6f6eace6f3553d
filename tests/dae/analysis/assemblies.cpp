// Assemblies found by a search, against trigonometry, against the roots of a polynomial and of a
// function of one angle, and against mirror images.

#include "equations/assembled_linkages.h"
#include "equations/decompositions.h"
#include "equations/parts.h"
#include "equations/refusal.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/format/toml/parse_scene.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

namespace momenta::dae_assemblies {
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

/// Whether an angle is among others, modulo full turns.
bool is_among(double angle, const std::vector<double>& all, double within = 1e-7) {
  return std::any_of(all.begin(), all.end(), [&](double other) {
    return std::abs(std::remainder(angle - other, 2 * pi)) < within;
  });
}

TEST(Assemblies, OfAFourBarAreTwo) {
  for (const double theta : {0.3, 1.7, 4.0}) {
    AssembliesRequest request;
    request.hold = {"O"};
    request.starts = 200;
    const Assemblies found = found_in(closed_four_bar(theta), request);
    ASSERT_EQ(found.all.size(), 2u) << theta;
    const Vector2d A = along(theta), C(2.2, 0);
    const double reach = (A - C).norm(), from = angle_of(A - C),
                 inside = std::acos((reach * reach + 1.8 * 1.8 - 4) / (2 * reach * 1.8));
    EXPECT_NEAR(std::remainder(found.all[0].q[2] - (from - inside), 2 * pi), 0, 1e-9);
    EXPECT_NEAR(std::remainder(found.all[1].q[2] - (from + inside), 2 * pi), 0, 1e-9);
    EXPECT_EQ(found.all[0].apart, 0);
    EXPECT_EQ(found.all[0].met + found.all[1].met, found.closed);
    EXPECT_GT(found.closed, 150);
    EXPECT_EQ(found.met_once(), 0);
    for (const FoundAssembly& a : found.all) {
      EXPECT_EQ(a.q[0], theta);
      EXPECT_GT(a.least_value, 0.01);
    }
  }
}

TEST(Assemblies, DoNotDependOnThreadsNorSeeds) {
  AssembliesRequest request;
  request.hold = {"C"};
  request.starts = 100;
  const Assemblies one = found_in(closed_four_bar(0.9), request);
  request.threads = 3;
  const Assemblies three = found_in(closed_four_bar(0.9), request);
  request.seed = 5;
  const Assemblies other = found_in(closed_four_bar(0.9), request);
  ASSERT_EQ(one.all.size(), 2u);
  ASSERT_EQ(three.all.size(), 2u);
  ASSERT_EQ(other.all.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(one.all[i].q, three.all[i].q);
    EXPECT_EQ(one.all[i].met, three.all[i].met);
    EXPECT_LT((one.all[i].q - other.all[i].q).cwiseAbs().maxCoeff(), 1e-9);
  }
  EXPECT_NE(one.all[0].met, other.all[0].met);
}

TEST(Assemblies, AreRefusedWhereAFreedomIsLeft) {
  const auto says = [](const AssembliesRequest& request) {
    return equations::thrown<SceneError>([&] { found_in(closed_four_bar(1), request); });
  };
  EXPECT_NE(says({}).find("leaves 1 degree of freedom"), std::string::npos) << says({});
  EXPECT_NE(says({}).find("such as '"), std::string::npos) << says({});
  AssembliesRequest wrong;
  wrong.hold = {"X"};
  EXPECT_NE(says(wrong).find("'X' is not known"), std::string::npos) << says(wrong);
}

/// The names in quotes behind a word of a sentence.
std::vector<std::string> quoted_behind(const std::string& sentence, const std::string& word) {
  std::vector<std::string> names;
  std::size_t from = sentence.find(word);
  EXPECT_NE(from, std::string::npos) << sentence;
  while ((from = sentence.find('\'', from)) < sentence.size()) {
    const std::size_t to = sentence.find('\'', from + 1);
    names.push_back(sentence.substr(from + 1, to - from - 1));
    from = to + 1;
  }
  return names;
}

/// Coordinates that a refusal names can be held, and leave no freedom.
TEST(Assemblies, TakeTheCoordinatesTheyAskFor) {
  const Scene typed = parse_scene(
      "[lagrangian]\ncoordinates = [\"a\", \"b\"]\nkinetic = \"a.dot^2 + b.dot^2\"\n", "typed");
  Scene swinging = closed_four_bar(1);
  swinging.loops.clear();
  for (const Scene& scene : {closed_four_bar(1), swinging, typed}) {
    AssembliesRequest request;
    request.starts = 5;
    request.hold =
        quoted_behind(equations::thrown<SceneError>([&] { found_in(scene, request); }), "such as ");
    EXPECT_GE(found_in(scene, request).all.size(), 1u);
  }
  // A ball's coordinates are none of these, and those left are told.
  Scene ball = swinging;
  ball.joints[1].kind = JointKind::spherical;
  ball.joints[1].position.clear();
  AssembliesRequest request;
  const std::string said = equations::thrown<SceneError>([&] { found_in(ball, request); });
  EXPECT_TRUE(equations::says(said, "leaves 5 degrees of freedom")) << said;
  EXPECT_TRUE(equations::says(said, "held 3 are left")) << said;
  request.hold = quoted_behind(said, "expected ");
  EXPECT_EQ(request.hold.size(), 2u);
  EXPECT_TRUE(equations::says(
      equations::thrown<SceneError>([&] { found_in(ball, request); }),
      "leaves 3 degrees of freedom, and assemblies that are no isolated poses; expected other "
      "joints: coordinates of spherical and free joints cannot be held"));
}

/// Where all is held or welded, by either way one pose is left, the mechanism's own.
TEST(Assemblies, AreOneWhereNothingIsFree) {
  Scene welded = closed_four_bar(1);
  welded.loops.clear();
  for (JointSpec& joint : welded.joints) {
    joint.kind = JointKind::weld;
    joint.position.clear();
    joint.velocity.clear();
  }
  Scene swinging = closed_four_bar(1);
  swinging.loops.clear();
  for (const bool by_homotopy : {false, true}) {
    AssembliesRequest request;
    request.starts = 5;
    request.by_homotopy = by_homotopy;
    EXPECT_EQ(found_in(welded, request).all.size(), 1u);
    request.hold = {"O", "A", "C"};
    for (const Scene& scene : {closed_four_bar(1), swinging}) {
      const Assemblies found = found_in(scene, request);
      EXPECT_EQ(found.all.size(), 1u);
      EXPECT_EQ(found.all[0].apart, 0);
      if (by_homotopy) {
        EXPECT_TRUE(found.paths->is_complete());
        EXPECT_EQ(found.paths->real, 1);
      }
    }
  }
}

/// A platform in the plane on three rods, x + R(φ) p_i at the distance l_i from b_i.
struct PlanarPlatform {
  Vector2d b[3], p[3], place;
  double turned = 0;
  double l[3] = {0, 0, 0};

  explicit PlanarPlatform(std::mt19937& random) {
    std::uniform_real_distribution<double> any(-1, 1);
    for (int i = 0; i < 3; ++i) {
      b[i] = 1.5 * along(2 * pi * i / 3 + 0.3 * any(random));
      p[i] = 0.9 * along(2 * pi * i / 3 + 0.8 * any(random));
    }
    place = {0.4 * any(random), 0.4 * any(random)};
    turned = 2 * any(random);
    for (int i = 0; i < 3; ++i) l[i] = (place + turn(turned) * p[i] - b[i]).norm();
  }
  static Eigen::Matrix2d turn(double phi) { return Eigen::Rotation2Dd(phi).toRotationMatrix(); }

  Scene scene() const {
    Scene s;
    s.name = "platform";
    s.bodies = {equations::rod("platform")};
    s.joints = {equations::make_joint(JointKind::planar, "P", "ground", "platform", {0, 0, 0},
                                      {0, 0, 1}, {place.x(), place.y(), turned})};
    for (int i = 0; i < 3; ++i)
      s.loops.push_back(rod_between("L" + std::to_string(i), "platform", {b[i].x(), b[i].y(), 0},
                                    {p[i].x(), p[i].y(), 0}, l[i]));
    return s;
  }
  /// Two differences of the equations are linear in x: x = N/D; what is left of the first, times
  /// D², is a trigonometric polynomial of φ.
  double left(double phi) const {
    const Eigen::Matrix2d r = turn(phi);
    Vector2d v[3];
    for (int i = 0; i < 3; ++i) v[i] = r * p[i] - b[i];
    Eigen::Matrix2d m;
    Vector2d right;
    for (int i = 1; i < 3; ++i) {
      m.row(i - 1) = 2 * (v[i] - v[0]);
      right[i - 1] = l[i] * l[i] - l[0] * l[0] - v[i].squaredNorm() + v[0].squaredNorm();
    }
    const double d = m.determinant();
    const Vector2d n(right[0] * m(1, 1) - right[1] * m(0, 1),
                     m(0, 0) * right[1] - m(1, 0) * right[0]);
    return (n + d * v[0]).squaredNorm() - l[0] * l[0] * d * d;
  }
  /// All its roots z = e^{iφ}, by the eigenvalues of the companion matrix.
  std::vector<std::complex<double>> roots() const {
    constexpr int n = 16;
    std::vector<std::complex<double>> c;  // of z^-7 … z^7
    double largest = 0;
    for (int k = -7; k <= 7; ++k) {
      std::complex<double> sum = 0;
      for (int j = 0; j < n; ++j) {
        const double phi = 2 * pi * j / n;
        sum += left(phi) * std::polar(1.0, -k * phi) / static_cast<double>(n);
      }
      c.push_back(sum);
      largest = equations::larger(largest, std::abs(sum));
    }
    int degree = 7;
    while (std::abs(c[static_cast<std::size_t>(7 + degree)]) < 1e-10 * largest) --degree;
    // z^d f is a polynomial of degree 2d with a companion matrix of complex numbers, (A −B; B A) in
    // real ones, which has its eigenvalues and their conjugates: those of f, for f is real.
    const int size = 2 * degree;
    Eigen::MatrixXcd companion = Eigen::MatrixXcd::Zero(size, size);
    for (int k = 0; k < size; ++k) {
      companion(k, size - 1) =
          -c[static_cast<std::size_t>(7 - degree + k)] / c[static_cast<std::size_t>(7 + degree)];
      if (k > 0) companion(k, k - 1) = 1;
    }
    Eigen::MatrixXd real(2 * size, 2 * size);
    real << companion.real(), -companion.imag(), companion.imag(), companion.real();
    Eigen::EigenSolver<Eigen::MatrixXd> solver;
    solver.compute(real, false);
    std::vector<std::complex<double>> all;
    for (int k = 0; k < 2 * size; ++k) {
      const std::complex<double> z = solver.eigenvalues()[k];
      std::complex<double> value = 0;
      for (int e = size; e >= 0; --e)
        value = value * z + c[static_cast<std::size_t>(7 - degree + e)];
      double scale = 0;
      for (int e = 0; e <= size; ++e)
        scale += std::abs(c[static_cast<std::size_t>(7 - degree + e)]) * std::pow(std::abs(z), e);
      if (std::abs(value) < 1e-8 * scale) all.push_back(z);
    }
    return all;
  }
};

// Six assemblies over the complex numbers, none, two, four or six of them real: the search finds
// all real ones and no other.
TEST(Assemblies, OfAPlanarPlatformAreTheRootsOfASextic) {
  std::mt19937 random(11);
  std::map<std::size_t, int> counts;
  for (int k = 0; k < 20; ++k) {
    const PlanarPlatform platform(random);
    const auto roots = platform.roots();
    ASSERT_EQ(roots.size(), 6u);
    std::vector<double> real;
    for (const auto& z : roots)
      if (std::abs(std::abs(z) - 1) < 1e-7) real.push_back(std::arg(z));
    AssembliesRequest request;
    request.starts = 300;
    const Assemblies found = found_in(platform.scene(), request);
    EXPECT_EQ(found.all.size(), real.size()) << k;
    for (const FoundAssembly& a : found.all) EXPECT_TRUE(is_among(a.q[2], real, 1e-6)) << a.q[2];
    ++counts[real.size()];
  }
  EXPECT_GE(counts.size(), 2u);
  EXPECT_GT(counts[4] + counts[6], 3);
}

/// Stephenson's six-bar with its lever held: A on a circle about O, B on one about C, P on one
/// about a D that stands.
struct SixBar {
  Vector2d O{0, 0}, A, C, B, P, D, E;

  explicit SixBar(std::mt19937& random) {
    std::uniform_real_distribution<double> any(-0.5, 0.5);
    const auto near = [&](double x, double y) {
      return Vector2d(x + any(random), y + any(random));
    };
    A = near(0.5, 0.8);
    C = near(1.5, 0);
    B = near(1.6, 1.2);
    P = near(1.0, 1.6);
    D = near(0.8, 0.6);
    E = near(-0.5, 1.5);
  }
  Scene scene() const {
    const double coupler = angle_of(B - A), crank = angle_of(A), link = angle_of(D - P);
    const Vector2d p = Eigen::Rotation2Dd(-coupler) * (P - A);
    Scene s;
    s.name = "six-bar";
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
  /// |P − D|² less its value, for the crank at o and the dyad A, B, C on one side; NaN where it
  /// does not reach.
  double left(double o, int side) const {
    const Vector2d a = A.norm() * along(o), way = C - a;
    const double ab = (B - A).norm(), cb = (B - C).norm(), far = way.norm();
    const double inside = std::acos((far * far + ab * ab - cb * cb) / (2 * far * ab));
    const double coupler = angle_of(way) + side * inside;
    const Vector2d p =
        a + Eigen::Rotation2Dd(coupler - angle_of(B - A)).toRotationMatrix() * (P - A);
    return (p - D).squaredNorm() - (P - D).squaredNorm();
  }
  /// Crank angles of all assemblies, with the lever where it is: every change of sign on a fine
  /// grid.
  std::vector<double> cranks() const {
    std::vector<double> all;
    constexpr int steps = 20000;
    for (const int side : {-1, 1})
      for (int k = 0; k < steps; ++k) {
        double a = 2 * pi * k / steps, b = 2 * pi * (k + 1) / steps;
        const double fa = left(a, side), fb = left(b, side);
        if (!(fa * fb <= 0)) continue;
        for (int half = 0; half < 60; ++half) {
          const double c = 0.5 * (a + b);
          (left(c, side) * fa <= 0 ? b : a) = c;
        }
        all.push_back(0.5 * (a + b));
      }
    return all;
  }
};

TEST(Assemblies, OfStephensonsSixBarAreAtMostSix) {
  std::mt19937 random(4);
  std::size_t most = 0;
  for (int k = 0; k < 15; ++k) {
    const SixBar bars(random);
    const std::vector<double> known = bars.cranks();
    AssembliesRequest request;
    request.hold = {"E"};
    request.starts = 400;
    const Assemblies found = found_in(bars.scene(), request);
    EXPECT_EQ(found.all.size(), known.size()) << k;
    for (const FoundAssembly& a : found.all) EXPECT_TRUE(is_among(a.q[0], known, 1e-6)) << a.q[0];
    EXPECT_LE(known.size(), 6u);
    most = std::max(most, known.size());
  }
  EXPECT_GE(most, 4u);
}

// Base and platform are flat: the mirror image of an assembly in the base's plane is one as well.
TEST(Assemblies, OfAStewartPlatformComeInMirrorImages) {
  Scene s;
  s.name = "Stewart platform";
  s.bodies = {equations::rod("platform")};
  JointSpec joint = equations::make_joint(JointKind::free, "P", "ground", "platform");
  const Vector3d place(0.1, -0.05, 0.9);
  const Eigen::Quaterniond at(Eigen::AngleAxisd(0.3, Vector3d(0.2, 0.5, 1).normalized()));
  joint.position = {place.x(), place.y(), place.z(), at.w(), at.x(), at.y(), at.z()};
  s.joints = {joint};
  const double feet[6] = {0.1, 0.9, 2.3, 3.1, 4.2, 5.5}, seats[6] = {0.5, 0.7, 2.0, 2.9, 4.6, 4.9};
  std::vector<Vector3d> base, top;
  std::vector<double> lengths;
  for (int i = 0; i < 6; ++i) {
    base.emplace_back(std::cos(feet[i]), std::sin(feet[i]), 0);
    top.emplace_back(0.6 * std::cos(seats[i]), 0.6 * std::sin(seats[i]), 0);
    lengths.push_back((place + at * top.back() - base.back()).norm());
    s.loops.push_back(
        rod_between("L" + std::to_string(i), "platform", base.back(), top.back(), lengths.back()));
  }
  AssembliesRequest request;
  request.starts = 400;
  const Assemblies found = found_in(s, request);
  EXPECT_GE(found.all.size(), 4u);
  EXPECT_LE(found.all.size(), 40u);  // over the complex numbers
  EXPECT_EQ(found.all.size() % 2, 0u);
  const auto seats_of = [&](const VectorXd& q) {
    std::vector<Vector3d> all;
    for (const Vector3d& p : top)
      all.push_back(q.head<3>() + Eigen::Quaterniond(q[3], q[4], q[5], q[6]) * p);
    return all;
  };
  for (const FoundAssembly& a : found.all) {
    const auto here = seats_of(a.q);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR((here[i] - base[i]).norm(), lengths[i], 1e-10);
    int mirrored = 0;
    for (const FoundAssembly& other : found.all) {
      const auto there = seats_of(other.q);
      double apart = 0;
      for (std::size_t i = 0; i < 6; ++i)
        apart =
            equations::larger(apart, (here[i] - there[i].cwiseProduct(Vector3d(1, 1, -1))).norm());
      mirrored += apart < 1e-5;
    }
    EXPECT_EQ(mirrored, 1);
  }
}

}  // namespace
}  // namespace momenta::dae_assemblies
