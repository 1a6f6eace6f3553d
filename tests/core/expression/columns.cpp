// Functions by points from files of columns, and how they go between their points.

#include "equations/same_scene.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/expression/spline.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/core/format/toml/write_scene.h>
#include <momenta/core/scene/drive.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace momenta::core_columns {
namespace {

const std::string scene = R"toml(
[[body]]
name = "a"
mass = 1
inertia = 1
[[joint]]
name = "A"
kind = "revolute"
child = "a"
)toml";

std::string function(const std::string& keys) {
  return "[[function]]\nname = \"f\"\n" + keys;
}

TEST(Columns, AreReadByName) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / "momenta_columns_are_read";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "motor.csv") << "\xEF\xBB\xBF# measured\r\n\"torque\" , power,speed\r\n"
                                         "12,0, +0\r\n\r\n11.5,7,1e1\n# the end\n-3,1,20";
  std::ofstream(folder / "scene.toml")
      << scene
      << function("file = \"motor.csv\"\nx = \"speed\"\ny = \"torque\"\nkind = \"linear\"");
  const Scene read = read_scene(folder / "scene.toml");
  EXPECT_EQ(read.functions[0].x, (std::vector<double>{0, 10, 20}));
  EXPECT_EQ(read.functions[0].y, (std::vector<double>{12, 11.5, -3}));
  EXPECT_EQ(equations::difference(read, parse_scene(scene_text(read), "written.toml")), "");
  std::filesystem::remove_all(folder);
}

struct At {
  double f, first, second;
};
At value(const CubicSpline& f, double x) {
  At v;
  f.evaluate(x, v.f, v.first, v.second);
  return v;
}
const std::vector<double> x{-1, 0, 0.5, 2, 3, 3.5}, y{0, 0, 1, 4, 4.1, 2};

/// Through the points; f' continuous but for linear ones, f" of cubic ones; straight outside.
TEST(Interpolations, AreAsSmoothAsTheySay) {
  for (const Interpolation way :
       {Interpolation::cubic, Interpolation::monotone, Interpolation::linear}) {
    const CubicSpline f(x, y, way);
    double slope_jump = 0, bend_jump = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double h = 1e-9;
      const At before = value(f, x[i] - h), after = value(f, x[i] + h);
      EXPECT_NEAR(value(f, x[i]).f, y[i], 1e-14);
      EXPECT_NEAR(before.f, after.f, 1e-7);
      slope_jump = equations::larger(slope_jump, std::abs(after.first - before.first));
      bend_jump = equations::larger(bend_jump, std::abs(after.second - before.second));
    }
    EXPECT_EQ(slope_jump < 1e-6, way != Interpolation::linear);
    EXPECT_EQ(bend_jump < 1e-6, way != Interpolation::monotone);  // linear ones have none
    for (const double outside : {-3.0, 5.0}) {
      const double end = outside < 0 ? x.front() : x.back(),
                   last = outside < 0 ? y.front() : y.back();
      EXPECT_NEAR(value(f, outside).f, last + value(f, outside).first * (outside - end), 1e-12);
      EXPECT_EQ(value(f, outside).second, 0);
    }
  }
}

/// Monotone ones rise where the points rise and stay where they stay; the cubic overshoots.
TEST(Interpolations, MonotoneOnesDoNotOvershoot) {
  const CubicSpline f(x, y, Interpolation::monotone), cubic(x, y);
  bool overshoots = false;
  for (std::size_t i = 0; i + 1 < x.size(); ++i)
    for (int k = 0; k <= 50; ++k) {
      const double at = x[i] + (x[i + 1] - x[i]) * k / 50, rise = y[i + 1] - y[i];
      EXPECT_GE(value(f, at).first * rise, -1e-12) << at;
      if (rise == 0) {
        EXPECT_NEAR(value(f, at).first, 0, 1e-14) << at;
      }
      overshoots |= value(cubic, at).first * rise < -1e-6;
    }
  EXPECT_TRUE(overshoots);
  // a straight line is met exactly, a parabola to third order: 2^-3 for half the width
  const CubicSpline line({0, 1, 3}, {1, 2, 4}, Interpolation::monotone);
  EXPECT_NEAR(value(line, 2.2).f, 3.2, 1e-15);
  const auto miss = [](int n) {
    std::vector<double> at, of;
    for (int i = 0; i <= n; ++i) at.push_back(1 + 1.0 * i / n), of.push_back(std::exp(at.back()));
    const CubicSpline g(at, of, Interpolation::monotone);
    double most = 0;
    for (int i = 0; i < 1000; ++i)
      most =
          equations::larger(most, std::abs(value(g, 1 + i / 1000.0).f - std::exp(1 + i / 1000.0)));
    return most;
  };
  EXPECT_GT(miss(20) / miss(40), 6);
}

/// A drive's formula calls functions; its rate and acceleration are those of the curve.
TEST(Interpolations, AreCalledByDrives) {
  const std::string points = "x = [0, 1, 2.5, 4]\ny = [0, 0.3, -0.2, 1]\n";
  const std::string drive =
      "[[drive]]\njoint = \"A\"\nkind = \"formula\"\nlaw = \"2 * f(t) + t^2\"\n";
  const Scene read = parse_scene(scene + drive + function(points), "drive.toml");
  const MotionLaw law(read.drives[0]);
  const CubicSpline f({0, 1, 2.5, 4}, {0, 0.3, -0.2, 1});
  for (const double t : {0.2, 1.7, 3.9, 4.5}) {
    double place, rate, acceleration;
    law.evaluate(t, place, rate, acceleration);
    const At v = value(f, t);
    EXPECT_NEAR(place, 2 * v.f + t * t, 1e-14);
    EXPECT_NEAR(rate, 2 * v.first + 2 * t, 1e-13);
    EXPECT_NEAR(acceleration, 2 * v.second + 2, 1e-13);
  }
  EXPECT_TRUE(read.remarks.empty());
  EXPECT_EQ(equations::difference(read, parse_scene(scene_text(read), "written.toml")), "");
  const auto remark = [&](const std::string& kind) {
    const Scene s =
        parse_scene(scene + drive + function(points + "kind = \"" + kind + "\"\n"), "d.toml");
    return s.remarks.empty() ? std::string() : s.remarks.front();
  };
  EXPECT_NE(remark("linear").find("'a linear function' in its law may have corners"),
            std::string::npos);
  EXPECT_NE(remark("monotone").find("functions by points of kind cubic"), std::string::npos);
}

}  // namespace
}  // namespace momenta::core_columns
