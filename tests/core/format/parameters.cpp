// A scene with parameters is the scene with their numbers written out.

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/format/toml/setting.h>
#include <momenta/core/format/toml/write_scene.h>
#include <momenta/core/scene/rod_ends.h>

#include "equations/refusal.h"

namespace momenta::core_parameters {
namespace {

const std::string with_parameters = R"toml(
name = "four-bar"
gravity = [0, "-g", 0]
[parameters]
c = "a + b"          # made of what comes later
a = 0.5
b = "2 * a"
g = 9.81
mass = 3
[[require]]
that = "c < 4 * a"
because = "the coupler has to reach"
[[body]]
name = "crank"
mass = "mass"
shape = { kind = "rod", length = "a" }
[[body]]
name = "coupler"
mass = "if(c > 1, 2 * mass, mass)"
shape = { kind = "rod", length = "c" }
[[joint]]
name = "O"
kind = "revolute"
child = "crank"
position = "pi / 3"
[[joint]]
name = "A"
kind = "revolute"
parent = "crank"
child = "coupler"
origin = { parent = ["a", 0, 0] }
stiffness = "100 * a^2"
[[force]]
kind = "torque"
joint = "O"
value = "-mass * g * a / 2"
)toml";

std::string replaced(std::string text, const std::vector<std::pair<std::string, std::string>>& by) {
  for (const auto& [from, to] : by) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  }
  return text;
}

std::string with_numbers(const std::string& a, const std::string& b, const std::string& c,
                         const std::string& coupler, const std::string& stiffness,
                         const std::string& torque) {
  std::string text = with_parameters;
  const std::size_t from = text.find("[parameters]"), to = text.find("[[body]]");
  text.erase(from, to - from);
  (void)b;
  return replaced(text, {{"\"-g\"", "-9.81"},
                         {"\"mass\"", "3"},
                         {"\"a\"", a},
                         {"\"if(c > 1, 2 * mass, mass)\"", coupler},
                         {"\"c\"", c},
                         {"\"pi / 3\"", "1.0471975511965976"},
                         {"\"a\"", a},
                         {"\"100 * a^2\"", stiffness},
                         {"\"-mass * g * a / 2\"", torque}});
}

std::string sentence(const std::string& text, const std::vector<Setting>& settings = {}) {
  return equations::thrown([&] { (void)parse_scene(text, "scene.toml", settings); });
}

TEST(Parameters, StandForTheirNumbers) {
  EXPECT_EQ(scene_text(parse_scene(with_parameters)),
            scene_text(parse_scene(with_numbers("0.5", "1", "1.5", "6", "25", "-7.3575"))));
}

TEST(Parameters, AreSetFromOutside) {
  EXPECT_EQ(scene_text(parse_scene(with_parameters, "scene", {{"a", 0.25}})),
            scene_text(parse_scene(with_numbers("0.25", "0.5", "0.75", "3", "6.25", "-3.67875"))));
  // in place of a formula, too
  EXPECT_EQ(scene_text(parse_scene(with_parameters, "scene", {{"b", 1.0}, {"a", 0.5}})),
            scene_text(parse_scene(with_parameters)));
  EXPECT_EQ(parse_scene(with_parameters, "scene", {{"parameters.g", 1.0}}).gravity.y(), -1);
  EXPECT_EQ(parse_scene(with_parameters, "scene", {{"joint.A.stiffness", 7.0}}).joints[1].stiffness,
            7);
}

TEST(Parameters, AreToldWithTheirValues) {
  const Scene scene = parse_scene(replaced(with_parameters, {{"mass = 3", "mass = 3\nspare = 1"}}));
  ASSERT_EQ(scene.parameters.size(), 6U);
  EXPECT_EQ(scene.parameters[0].name, "c");
  EXPECT_EQ(scene.parameters[0].value, 1.5);
  for (const ParameterSpec& p : scene.parameters) EXPECT_EQ(p.used, p.name != "spare") << p.name;
}

TEST(Parameters, FormulasNeedNone) {
  const Scene scene = parse_scene(
      "[[body]]\nname = 'b'\nmass = '2 * 3'\nshape = { kind = 'point' }\n[[joint]]\nname = 'O'\n"
      "kind = 'free'\nchild = 'b'\n");
  EXPECT_EQ(scene.bodies.front().mass, 6);
}

TEST(Parameters, RequirementsSayWhatDoesNotHold) {
  EXPECT_EQ(sentence(with_parameters, {{"b", 3}}),
            "scene.toml:11:8: requirement number 1: that does not hold: c < 4 * a, with c = 3.5, "
            "a = 0.5: the coupler has to reach");
}

/// A length that has a name changes shape and pins alike; one that is written twice does not.
TEST(Parameters, RodsThatMissTheirPinsAreTold) {
  const std::string text =
      replaced(with_parameters, {{"stiffness",
                                  "stiffness = 1\n[[joint]]\nname = 'B'\nkind = 'revolute'\n"
                                  "parent = 'crank'\nchild = 'tip'\norigin = { parent = "
                                  "['a / 2', 0, 0] }\nrest"},
                                 {"[[joint]]",
                                  "[[body]]\nname = 'tip'\nmass = 1\nshape = { kind = "
                                  "'sphere', radius = 0.1 }\n[[joint]]"}});
  EXPECT_TRUE(rods_that_miss_their_pins(parse_scene(text)).empty());
  EXPECT_TRUE(rods_that_miss_their_pins(parse_scene(text, "scene", {{"a", 0.8}})).empty());
  for (const double length : {0.4, 0.6}) {
    const auto told = rods_that_miss_their_pins(
        parse_scene(text, "scene", {{"body.crank.shape.length", length}}));
    ASSERT_EQ(told.size(), 1U);
    EXPECT_NE(told.front().find("rod 'crank' is 0." + std::to_string(int(10 * length))),
              std::string::npos);
    EXPECT_NE(told.front().find("its last pin is at 0.5 m"), std::string::npos);
  }
}

/// Where and what, and the sentence's end.
TEST(Parameters, MistakesAreNamed) {
  const auto changed = [&](const std::string& from, const std::string& to) {
    return sentence(replaced(with_parameters, {{from, to}}));
  };
  EXPECT_EQ(changed("100 * a^2", "100 * aa^2"),
            "scene.toml:32:20: joint 'A': stiffness is a string ('100 * aa^2'), expected a number "
            "[N m/rad] or a formula of one: unknown name 'aa'; did you mean 'a'?");
  EXPECT_EQ(changed("if(c > 1, 2 * mass, mass)", "-a"),
            "scene.toml:19:8: body 'coupler': mass is -0.5 by '-a', expected a number >= 0 [kg]");
  EXPECT_EQ(changed("100 * a^2", "1 / (a - a)"),
            "scene.toml:32:13: joint 'A': stiffness is inf by '1 / (a - a)', expected finite: a "
            "number [N m/rad]");
  EXPECT_EQ(changed("100 * a^2", "a < 1"),
            "scene.toml:32:13: joint 'A': stiffness is a comparison, 'a < 1', expected a number [N "
            "m/rad] "
            "or a formula of one");
  EXPECT_EQ(changed("a = 0.5\n", "a = 'c - b'\n"),
            "scene.toml:6:5: parameters depend on each other: 'c' of 'a' of 'c', expected one of "
            "them as a number");
  EXPECT_EQ(changed("a = 0.5\n", "a = 'a + 1'\n"),
            "scene.toml:6:5: parameters depend on each other: 'a' of 'a', expected one of them as "
            "a number");
  EXPECT_EQ(changed("a = 0.5\n", "a = true\n"),
            "scene.toml:6:5: parameter 'a' is a boolean, expected a number or a formula in quotes");
  EXPECT_EQ(changed("a = 0.5\n", "a = 'sqrt(-1)'\n"),
            "scene.toml:6:5: parameter 'a' is nan, expected a finite number");
  EXPECT_EQ(changed("a = 0.5\n", "a = 'g < 1'\n"),
            "scene.toml:6:5: parameter 'a', 'g < 1': is a comparison, expected a formula of a "
            "number");
  EXPECT_EQ(changed("mass = 3", "pi = 3"),
            "scene.toml:9:1: parameter 'pi' has a name that formulas cannot take, expected "
            "letters, digits and _, a letter first, and none of pi, t, and, or, not, if");
  EXPECT_EQ(changed("c < 4 * a", "c + a"),
            "scene.toml:11:8: requirement number 1: that is a number, expected a comparison such "
            "as \"a < b\"");
  EXPECT_EQ(changed("c < 4 * a", "c <"),
            "scene.toml:11:12: requirement number 1: that, 'c <': ends where a number is expected");
  EXPECT_EQ(sentence(with_parameters, {{"aa", 1}}),
            "'aa': the scene has no parameter of that name; did you mean 'a'?");
  EXPECT_EQ(sentence("[parameters]\n", {{"a", 1}}),
            "'a': the scene has no parameter of that name, expected numbers in [parameters]");
  EXPECT_EQ(sentence(with_parameters, {{"force.x.value", 1}}),
            "'force.x.value': the scene has no force of that name, expected names in its "
            "[[force]]");
}

}  // namespace
}  // namespace momenta::core_parameters
