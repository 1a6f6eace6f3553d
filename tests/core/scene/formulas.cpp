// Formulas of scenes: what their names mean, what stands in place of parameters, and that they are
// written and read again.

#include "equations/random_tree.h"
#include "equations/refusal.h"
#include "equations/same_scene.h"

#include <gtest/gtest.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/core/format/toml/write_scene.h>
#include <momenta/core/scene/drive.h>
#include <momenta/core/scene/formula.h>
#include <momenta/core/scene/validate.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace momenta::core_formulas {
namespace {

const std::string base = R"toml(
[parameters]
k = -0.1
third = "1 / 3"
unused = 2
[[body]]
name = "a"
mass = 1
inertia = 1
[[body]]
name = "b"
mass = 1
inertia = [1, 1, 1]
[[body]]
name = "d"
mass = 1
inertia = [1, 1, 1]
[[joint]]
name = "A"
kind = "revolute"
child = "a"
[[joint]]
name = "left-knee"
kind = "planar"
parent = "a"
child = "b"
[[joint]]
name = "hip.left"
kind = "prismatic"
parent = "b"
child = "d"
axis = "x"
[[marker]]
name = "A"
body = "d"
[[force]]
name = "S"
kind = "spring-damper"
child = "d"
[[force]]
name = "C"
kind = "coordinate-spring"
joints = ["A", "left-knee"]
coordinates = [0, 2]
ratios = [1, 0.5]
)toml";

/// The signals of a formula, in the order in which it names them.
std::vector<std::string> names_in(const std::string& text) {
  const Scene scene = parse_scene(base, "base.toml");
  std::vector<std::string> names;
  for (const Signal& s : FormulaReader(scene).read(text).signals)
    names.push_back(in_words(scene, s));
  return names;
}

TEST(Formulas, NamesMeanSignals) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(names_in("A.q + A.x * A.u - t"), (Names{"A.q", "A.x", "A.u", "t"}));
  EXPECT_EQ(names_in("'left-knee'.q2 + 'left-knee'.u0 + 'A'.vz"),
            (Names{"'left-knee'.q2", "'left-knee'.u0", "A.vz"}));
  EXPECT_EQ(names_in("hip.left.q * 'hip.left'.q + hip.left.u"),
            (Names{"'hip.left'.q", "'hip.left'.u"}));
  EXPECT_EQ(names_in("S.length / S.rate + C.l * C.rate"),
            (Names{"S.length", "S.rate", "C.l", "C.rate"}));
  EXPECT_EQ(names_in("third * k + pi"), (Names{}));
}

TEST(Formulas, NumbersStandInPlaceOfParameters) {
  const Scene scene = parse_scene(base, "base.toml");
  Scene without = scene;
  without.parameters.clear();
  const FormulaReader reader(scene), plain(without);
  EXPECT_EQ(reader.read("third*A.q^2 - k + 'left-knee'.q0").text,
            "0.3333333333333333*A.q^2 - (-0.1) + 'left-knee'.q0");
  equations::RandomTree random(1);
  for (const std::string text :
       {"k", "2^k", "-k^2 * t^(k)", "A.q^third / (k - t)", "if(k < A.q, third, atan2(k, t))"}) {
    const Formula f = reader.read(text), again = plain.read(f.text);
    ASSERT_EQ(f.signals, again.signals);
    for (int i = 0; i < 5; ++i) {
      std::vector<double> x;
      for (std::size_t n = 0; n < f.signals.size(); ++n) x.push_back(random.uniform(0.1, 2));
      EXPECT_EQ(f.expression(x), again.expression(x)) << text;
    }
  }
}

const std::string forces = R"toml(
[[force]]
kind = "torque"
joint = "A"
law = "-k * u + third * sin(t) * q"
[[force]]
kind = "potential"
V = "S.length^2 * k + C.l * 'left-knee'.q1 + cos(A.q) + A.z"
[[force]]
name = "law"
kind = "spring-damper"
child = "b"
law = "third * length + rate"
[[force]]
kind = "coordinate-spring"
joints = ["hip.left"]
ratios = [2]
law = "l^3 - rate"
[[force]]
kind = "wrench"
body = "d"
force = ["t * k", 0.1, "2 * third"]
torque = [0, "hip.left.u", -0.2]
axes = "body"
)toml";

TEST(Formulas, AreWrittenAndReadAgain) {
  const Scene scene = parse_scene(base + forces, "formulas.toml");
  EXPECT_TRUE(scene.parameters[0].used);
  EXPECT_TRUE(scene.parameters[1].used);
  EXPECT_FALSE(scene.parameters[2].used);
  const std::string text = scene_text(scene);
  EXPECT_EQ(text.find("third"), std::string::npos) << text;
  Scene again = parse_scene(text, "written.toml");
  EXPECT_EQ(equations::difference(scene, again), "");
  EXPECT_EQ(scene_text(again), text);
  const ForceSpec& wrench = scene.forces.back();
  EXPECT_EQ(wrench.force_law[0], "t * (-0.1)");
  EXPECT_EQ(wrench.force_law[2], "");
  EXPECT_EQ(wrench.force[2], 2.0 / 3);
}

const std::string with_curve = base + R"toml(
[[function]]
name = "curve"
x = [-1, 0, 0.5, 2]
y = [3, 0.1, -0.4, 1]
[[force]]
kind = "torque"
joint = "A"
law = "curve(k * u) + curve(curve(q))"
)toml";

/// The spline of a drive's table, with its derivatives as formulas of their own.
TEST(Formulas, FunctionsAreSplines) {
  const Scene scene = parse_scene(with_curve, "curve.toml");
  DriveSpec table;
  table.kind = "table";
  table.times = scene.functions[0].x;
  table.values = scene.functions[0].y;
  const MotionLaw law(table);
  const FormulaReader reader(scene);
  const Formula f = reader.read("curve(t)"), square = reader.read("curve(t)^2 * A.q");
  const Expression derivatives = f.expression.with_two_derivatives(0);
  const Expression gradient = square.expression.with_derivatives(std::array{0, 1});
  for (const double t : {-1.7, -0.4, 0.0, 0.3, 1.9, 2.6}) {
    double expected[3], found[3], line[64], slopes[3];
    law.evaluate(t, expected[0], expected[1], expected[2]);
    evaluate(derivatives, &t, line, found);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], 1e-14) << t;
    const double x[2]{t, 0.7};
    evaluate(gradient, x, line, slopes);
    EXPECT_DOUBLE_EQ(slopes[1], 2 * expected[0] * expected[1] * 0.7);
    EXPECT_DOUBLE_EQ(slopes[2], expected[0] * expected[0]);
    // a dual number's derivative is that of the derivative's tape
    Dual<double, 1> at(t), dual[3], duals[64];
    at.b[0] = 1;
    evaluate(derivatives, &at, duals, dual);
    EXPECT_NEAR(dual[0].b[0], expected[1], 1e-14);
    EXPECT_NEAR(dual[1].b[0], expected[2], 1e-13);
  }
  const std::string text = scene_text(scene);
  EXPECT_EQ(equations::difference(scene, parse_scene(text, "written.toml")), "");
}

std::string refused(const Scene& scene) {
  return equations::thrown<SceneError>([&] { validate(scene); });
}

TEST(Formulas, OfScenesByHandAreChecked) {
  const Scene scene = parse_scene(base + forces, "formulas.toml");
  ASSERT_EQ(refused(scene), "");
  const auto with = [&](std::size_t i, auto&& change) {
    Scene other = scene;
    change(other.forces[i]);
    return refused(other);
  };
  const auto has = [](const std::string& sentence, const std::string& part) {
    return sentence.find(part) != std::string::npos ? "" : sentence + " lacks " + part;
  };
  EXPECT_EQ(has(with(2, [](ForceSpec& f) { f.value = 1; }), "law is given beside stiffness"), "");
  EXPECT_EQ(has(with(2, [](ForceSpec& f) { f.force_law[0] = "t"; }), "are for wrenches only"), "");
  EXPECT_EQ(has(with(6, [](ForceSpec& f) { f.law = "t"; }), "law is for torques"), "");
  EXPECT_EQ(has(with(3, [](ForceSpec& f) { f.law = ""; }), "law is empty"), "");
  EXPECT_EQ(has(with(3, [](ForceSpec& f) { f.law = "A.u"; }), "takes the rate 'A.u'"), "");
  EXPECT_EQ(has(with(2, [](ForceSpec& f) { f.law = "2 +"; }), "law, '2 +': ends where a number"),
            "");
  EXPECT_EQ(has(with(6, [](ForceSpec& f) { f.torque_law[1] = "t < 1"; }), "is a comparison"), "");
}

DriveSpec by_formula(const std::string& law) {
  DriveSpec d;
  d.joint = "A";
  d.kind = "formula";
  d.law = law;
  return d;
}

/// Formulas of the other laws, in doubles and in series along t.
TEST(Formulas, DrivesAreTheOtherLawsWhereTheyAreWrittenSo) {
  DriveSpec harmonic, polynomial, step;
  harmonic.kind = "harmonic";
  harmonic.offset = 0.2;
  harmonic.amplitude = 0.7;
  harmonic.frequency = 3;
  harmonic.phase = 0.4;
  polynomial.kind = "polynomial";
  polynomial.coefficients = {0.1, -0.2, 0.3, 0.4};
  step.kind = "step";
  step.from = 0.1;
  step.to = 0.9;
  step.start = 0.5;
  step.duration = 2;
  const std::string x = "((t - 0.5) / 2)";
  const std::vector<std::pair<DriveSpec, std::string>> pairs{
      {harmonic, "0.2 + 0.7 * sin(3 * t + 0.4)"},
      {polynomial, "0.1 - 0.2 * t + 0.3 * t^2 + 0.4 * t^3"},
      {step, "if(t < 0.5, 0.1, if(t < 2.5, 0.1 + 0.8 * (10 * " + x + "^3 - 15 * " + x +
                 "^4 + 6 * " + x + "^5), 0.9))"}};
  using Series = PowerSeries<4>;
  for (const auto& [spec, text] : pairs) {
    const MotionLaw one(spec), two(by_formula(text));
    for (const double t : {-0.3, 0.0, 0.6, 1.4, 2.2, 3.1}) {
      double f[3], g[3];
      one.evaluate(t, f[0], f[1], f[2]);
      two.evaluate(t, g[0], g[1], g[2]);
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(f[i], g[i], 1e-13) << text << " at " << t;
      Series time(t), a[3], b[3];
      time.c[1] = 1;
      one.evaluate(time, a[0], a[1], a[2]);
      two.evaluate(time, b[0], b[1], b[2]);
      for (int i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < Series::terms; ++k)
          EXPECT_NEAR(a[i].c[k], b[i].c[k], 1e-11) << text << " at " << t;
    }
  }
}

TEST(Formulas, DrivesTellTheirCornersAndPotentialsTheTime) {
  EXPECT_EQ(law_corner(by_formula("sin(t)^2 + exp(-t)")), "");
  EXPECT_EQ(law_corner(by_formula("max(t, 1)")), "max");
  EXPECT_EQ(law_corner(by_formula("if(t < 1, 0, t)")), "if");
  const Scene timed =
      parse_scene(base + "[[force]]\nkind = \"potential\"\nV = \"t * A.q\"\n", "timed.toml");
  ASSERT_EQ(timed.remarks.size(), 1U);
  EXPECT_EQ(timed.remarks[0].find("a potential takes the time"), 0U);
  const std::string driven = base +
                             "[[drive]]\njoint = \"hip.left\"\nkind = \"formula\"\nlaw = "
                             "\"third * abs(t - 1)\"\n";
  const Scene scene = parse_scene(driven, "driven.toml");
  EXPECT_EQ(scene.drives[0].law, "0.3333333333333333 * abs(t - 1)");
  ASSERT_EQ(scene.remarks.size(), 1U);
  EXPECT_EQ(scene.remarks[0].find("drive of joint 'hip.left': 'abs' in its law"), 0U);
  const Scene again = parse_scene(scene_text(scene), "written.toml");
  ASSERT_EQ(again.drives.size(), 1U);
  EXPECT_EQ(again.drives[0].law, scene.drives[0].law);
  EXPECT_EQ(equations::difference(scene, again), "");
}

}  // namespace
}  // namespace momenta::core_formulas
