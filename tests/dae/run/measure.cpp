// Growth laws read from noisy data, reference files and what is wrong with them.

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/run/measure/growth.h>
#include <momenta/dae/run/measure/reference.h>
#include <momenta/dae/run/run_form.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "equations/examples.h"
#include "equations/refusal.h"
#include "equations/runs.h"

namespace momenta::dae_measure {
namespace {

Growth fit(double exponent, double noise, int samples = 1000) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(1 - noise, 1);
  std::vector<double> t, drift;
  for (int i = 0; i <= samples; ++i) {
    t.push_back(0.2 * i);
    drift.push_back(3e-9 * std::pow(t.back(), exponent) * any(random));
  }
  return fit_growth(t, drift, 1e-13);
}

TEST(Growth, FindsTheExponentOfPowers) {
  for (const double exponent : {1.0, 2.0, 0.5, 3.0}) {
    EXPECT_NEAR(fit(exponent, 0).exponent, exponent, 0.02);  // of a staircase of samples
    EXPECT_NEAR(fit(exponent, 0.5).exponent, exponent, 0.1);
    EXPECT_NEAR(fit(exponent, 0.95).exponent, exponent, 0.2);
    EXPECT_LT(fit(exponent, 0.5).half_range, 0.2);
  }
  const Growth g = fit(1, 0);
  EXPECT_DOUBLE_EQ(g.to, 200);
  EXPECT_DOUBLE_EQ(g.from, 10);
}

TEST(Growth, SaysWhereNoLawHolds) {
  std::vector<double> t, drift;
  for (int i = 0; i <= 1000; ++i) {
    t.push_back(i);
    drift.push_back(i < 300 ? 1e-9 * i : 1e-9 * i * i);  // two laws, one after the other
  }
  EXPECT_GT(fit_growth(t, drift, 1e-13).half_range, 0.4);
  EXPECT_TRUE(std::isnan(fit_growth({0, 1, 2}, {0, 1, 2}, 1e-13).exponent));
  EXPECT_TRUE(std::isnan(fit_growth({}, {}, 1e-13).exponent));
  EXPECT_TRUE(std::isnan(fit_growth(t, std::vector<double>(t.size(), 0.0), 1e-13).exponent));
  drift[20] = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(std::isnan(fit_growth(t, drift, 1e-13).exponent));
}

TEST(Growth, IsNotThatOfRounding) {
  // Noise of 1e-13 to 3e-13, whose running maximum looks like a power of t, beside a true t² that
  // rises out of it.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(1e-13, 3e-13);
  std::vector<double> t, rounding, rising, late;
  for (int i = 0; i <= 1000; ++i) {
    t.push_back(0.1 * i);
    rounding.push_back(noise(random) * std::pow(t.back() / 100, 0.3));
    rising.push_back(rounding.back() + 3e-14 * t.back() * t.back());
    late.push_back(rounding.back() + (i > 300 ? 1e-9 : 0));
  }
  EXPECT_TRUE(std::isnan(fit_growth(t, rounding, 4e-13).exponent));
  EXPECT_FALSE(std::isnan(fit_growth(t, rounding, 1e-16).exponent));
  const Growth g = fit_growth(t, rising, 4e-13);
  EXPECT_NEAR(g.exponent, 2, 0.2);
  EXPECT_NEAR(g.from, 5, 1);
  EXPECT_TRUE(std::isnan(fit_growth(t, late, 4e-13).exponent));
}

TEST(Growth, OfLoopsFarFromTheGroundIsNotThatOfRounding) {
  Scene scene = equations::example("four_bar");
  for (JointSpec& j : scene.joints)
    if (j.parent == "ground") j.origin_parent.x() += 3000;
  const Mechanism mechanism(scene);
  const RunResult run = run_form(mechanism, assemble(mechanism).start,
                                 equations::adaptive("projected", "dop853", "none", 1e-8, 20, 200));
  ASSERT_EQ(run.status, "done") << run.reason;
  EXPECT_GT(run.position_drift_max, rounding_level);
  EXPECT_TRUE(std::isnan(run.position_growth.exponent)) << run.position_drift_max;
  EXPECT_TRUE(std::isnan(run.velocity_growth.exponent)) << run.velocity_drift_max;
}

class ReferenceFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) {
    const auto name = testing::UnitTest::GetInstance()->current_test_info()->name();
    file_ = std::filesystem::temp_directory_path() / (std::string("momenta_") + name + ".csv");
    std::ofstream(file_) << text;
    return file_;
  }
  std::string complaint(const std::string& text) {
    return equations::thrown<SceneError>([&] { Reference reference(write(text)); });
  }
  void expect_complaint(const std::string& text, const std::string& place,
                        const std::string& words) {
    const std::string what = complaint(text);
    EXPECT_NE(what.find(file_.string() + place), std::string::npos) << what;
    EXPECT_NE(what.find(words), std::string::npos) << what;
  }
  void TearDown() override { std::filesystem::remove(file_); }
  std::filesystem::path file_;
};

TEST_F(ReferenceFile, IsRead) {
  Reference r(write("t [s], \"O.q [rad]\",O.u [rad/s]\r\n0,1,2\r\n\r\n0.5,1e-400,-3\n"));
  EXPECT_EQ(r.times(), (std::vector<double>{0, 0.5}));
  EXPECT_EQ(r.columns(), (std::vector<std::string>{"O.q [rad]", "O.u [rad/s]"}));
  r.bind({"t [s]", "A.q [rad]", "O.q [rad]", "O.u [rad/s]"});
  const auto e = r.error(0, {0, 99, 1.5, 5});
  EXPECT_DOUBLE_EQ(e.position, 0.25);  // 0.5 / (1 + 1)
  EXPECT_DOUBLE_EQ(e.velocity, 1);     // 3 / (1 + 2)
  EXPECT_DOUBLE_EQ(r.error(1, {0.5, 99, 0.125, -3}).position, 0.125);
  EXPECT_TRUE(std::isnan(r.error(0, {0, 0, std::nan(""), 2}).position));
}

TEST(References, NotANumberStaysWhateverFollows) {
  const double none = std::nan("");
  Reference r("here", {"a [m]", "b [m]", "A.f [N]", "B.f [N]"}, {0}, {{0, 0, 0, 0}});
  r.bind({"t [s]", "a [m]", "b [m]", "A.f [N]", "B.f [N]"});
  EXPECT_TRUE(std::isnan(r.error(0, {0, none, 1, 2, 3}).position));
  EXPECT_TRUE(std::isnan(r.error(0, {0, 1, none, 2, 3}).position));
  EXPECT_TRUE(std::isnan(r.error(0, {0, 1, 1, none, 3}).force));
  EXPECT_EQ(r.error(0, {0, 1, 1, 2, 3}).force, 3);
  EXPECT_EQ(r.error(0, {0, 1, 1, none, 3}, {3}).force, 3);  // the first is not unique
  EXPECT_TRUE(std::isnan(r.error(0, {0, 1, 1, 2, 3}, {3, 4}).force));
}

TEST_F(ReferenceFile, ErrorsNameFileLineAndWhatIsExpected) {
  expect_complaint("", ":1: ", "empty");
  expect_complaint("time,O.q [rad]\n0,1\n", ":1: ", "expected t [s]");
  expect_complaint("t [s],angle\n0,1\n", ":1: ", "'angle' has no unit");
  expect_complaint("t [s],O.q [rad]\n", ":1: ", "no rows");
  expect_complaint("t [s],O.q [rad]\n0,1\n1,2,3\n", ":3: ", "found 3 cells; expected 2");
  expect_complaint("t [s],O.q [rad]\n0,one\n", ":2: ", "found 'one'");
  expect_complaint("t [s],O.q [rad]\n0,nan\n", ":2: ", "finite number");
  expect_complaint("t [s],O.q [rad]\n0,1e999\n", ":2: ", "finite number");
  expect_complaint("t [s],O.q [rad]\n0,1 2\n", ":2: ", "finite number");
  expect_complaint("t [s],O.q [rad]\n0,1\n0,2\n", ":3: ", "time does not increase");
  EXPECT_THROW(Reference("/nowhere/at/all.csv"), SceneError);
}

TEST_F(ReferenceFile, ColumnsMustBeThoseOfTheTrajectory) {
  Reference r(write("t [s],O.q [deg]\n0,1\n"));
  try {
    r.bind({"t [s]", "O.q [rad]"});
    FAIL();
  } catch (const SceneError& e) {
    EXPECT_NE(std::string(e.what()).find("'O.q [deg]'"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("'O.q [rad]'"), std::string::npos) << e.what();
  }
}

/// λ of a coupler is a moment where all that it ties turns, a force where something slides.
TEST(Columns, UnitsOfCouplers) {
  const Mechanism mechanism(parse_scene(R"(
name = "couplers"
[[body]]
name = "a"
mass = 1
shape = { kind = "box", size = [1, 1, 1] }
[[body]]
name = "b"
mass = 1
shape = { kind = "box", size = [1, 1, 1] }
[[body]]
name = "c"
mass = 1
shape = { kind = "box", size = [1, 1, 1] }
[[joint]]
name = "turn"
kind = "revolute"
child = "a"
[[joint]]
name = "slide"
kind = "prismatic"
child = "b"
[[joint]]
name = "both"
kind = "cylindrical"
child = "c"
[[loop]]
name = "gear"
kind = "coupler"
joints = ["turn", "both"]
coordinates = [0, 1]
ratios = [1, -2]
[[loop]]
name = "rack"
kind = "coupler"
joints = ["turn", "slide"]
ratios = [1, 3]
[[loop]]
name = "screw"
kind = "coupler"
joints = ["turn", "both"]
coordinates = [0, 0]
ratios = [1, 3]
)"));
  std::vector<std::string> columns = trajectory_columns(mechanism);
  std::erase_if(columns, [](const std::string& c) { return c.find(".lambda") == c.npos; });
  EXPECT_EQ(columns, (std::vector<std::string>{"gear.lambda1 [N m]", "rack.lambda1 [N]",
                                               "screw.lambda1 [N]"}));
}

}  // namespace
}  // namespace momenta::dae_measure
