// Limits of joints in a figure: the ray of a hinge and the mark of a slide stand as far from the
// bounds as the coordinate does, however the joint is turned, and say when they are beyond.

#include <gtest/gtest.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/dae/output/figure.h>
#include <momenta/dae/run/motion.h>

namespace momenta::dae_figure_limits {
namespace {

using Eigen::Vector3d;

Scene scene() {
  return parse_scene(R"(
[[body]]
name = "a"
mass = 1
com = [0.3, 0.2, -0.1]
inertia = [0.1, 0.1, 0.1]
[[body]]
name = "b"
mass = 1
com = [0.1, 0.2, 0.4]
inertia = [0.1, 0.1, 0.1]
[[body]]
name = "c"
mass = 1
inertia = [0.1, 0.1, 0.1]
[[joint]]
name = "A"
kind = "spherical"
child = "a"
limits = [0, 1]
[[joint]]
name = "B"
kind = "revolute"
parent = "a"
child = "b"
axis = [1, 2, 2]
rotation = { rpy = [0.3, -0.5, 0.7] }
origin = { parent = [1, 0.2, 0], child = [0, 0.1, 0.2] }
limits = [-0.7, 1.1]
[[joint]]
name = "C"
kind = "prismatic"
parent = "b"
child = "c"
axis = [2, 1, -2]
rotation = { rpy = [-0.2, 0.4, 0.1] }
origin = { parent = [0.5, 0.4, 0.1], child = [0.1, 0, 0.3] }
limits = [-0.2, 0.3]
)",
                     "limits.toml");
}

TEST(FigureLimits, StandWhereTheCoordinatesAre) {
  const Mechanism mechanism(scene());
  const Picture picture = picture_of(mechanism);
  for (const double angle : {-1.5, -0.7, 0.0, 0.9, 1.3})
    for (const double slide : {-0.5, -0.1, 0.3, 0.4}) {
      std::vector<double> q{0.5, 0.5, -0.1, 0.7, angle, slide};
      Eigen::Map<Eigen::Vector4d>(q.data()).normalize();
      const auto frame = motion_of(mechanism, Film{0, 0, {q}}).frames[0];
      const auto marks = limit_marks(picture, places(picture, frame), 0.1);
      ASSERT_EQ(marks.size(), 2U);  // of the ball none
      const auto ray = [&](std::size_t i) {
        return Vector3d((marks[0].outline[i] - marks[0].outline[0]).normalized());
      };
      const Vector3d now = (marks[0].now[1] - marks[0].now[0]).normalized();
      const std::size_t last = marks[0].outline.size() - 2;
      EXPECT_NEAR(std::acos(ray(1).dot(now)), std::abs(angle + 0.7), 1e-7);
      EXPECT_NEAR(std::acos(ray(last).dot(now)), std::abs(angle - 1.1), 1e-7);
      EXPECT_EQ(marks[0].passed, angle < -0.7 || angle > 1.1) << angle;
      const Vector3d low = marks[1].outline[2], high = marks[1].outline[3],
                     at = 0.5 * (marks[1].now[0] + marks[1].now[1]);
      EXPECT_NEAR((at - low).dot((high - low).normalized()), slide + 0.2, 1e-12);
      EXPECT_NEAR((high - low).norm(), 0.5, 1e-12);
      EXPECT_EQ(marks[1].passed, slide < -0.2 || slide > 0.3) << slide;
    }
}

// Of few joints they are drawn, beyond them in the colour of gaps; without limits nothing is.
TEST(FigureLimits, AreDrawn) {
  const auto lines = [](const Scene& of, double angle) {
    const Mechanism mechanism(of);
    const std::string svg =
        mechanism_svg(picture_of(mechanism),
                      motion_of(mechanism, Film{0, 0, {{1, 0, 0, 0, angle, 0}}}).frames[0]);
    int muted = 0, beyond = 0;
    for (std::size_t at = 0; (at = svg.find("<line", at)) != std::string::npos; ++at) {
      const std::string line = svg.substr(at, svg.find('>', at) - at);
      muted += line.find("#525a66") != std::string::npos;
      beyond += line.find("#d55e00") != std::string::npos;
    }
    return std::pair(muted, beyond);
  };
  // a sector of 12 steps and two sides, a ray; a way with two ends, the place on it
  EXPECT_EQ(lines(scene(), 0), std::pair(12 + 2 + 1 + 5 + 1, 0));
  EXPECT_EQ(lines(scene(), 1.3), std::pair(12 + 2 + 5 + 1, 1));
  Scene without = scene();
  for (JointSpec& joint : without.joints) joint.limits.reset();
  EXPECT_EQ(lines(without, 0), std::pair(0, 0));
}

}  // namespace
}  // namespace momenta::dae_figure_limits
