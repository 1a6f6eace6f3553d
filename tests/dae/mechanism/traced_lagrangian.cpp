// A Lagrangian that a C++ class writes is the one that is typed: the same runs to the last bit in
// every form, with constraints that move, forces, terms linear in the rates and choices.

#include <gtest/gtest.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/core/format/toml/write_scene.h>
#include <momenta/core/scene/lagrangian/lagrangian_of.h>
#include <momenta/core/scene/validate.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/index_study.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <bit>
#include <cmath>
#include <functional>

namespace momenta::dae_written_lagrangian {
namespace {

/// examples/four_bar in its three angles, the coupler's counted from the crank.
struct FourBar {
  double m1 = 1, m2 = 2, m3 = 1.5, a = 0.5, b = 2, c = 1.5, d = 2, g = 9.81;

  template <class S>
  S lagrangian(const S* q, const S* v, const S&) const {
    using std::cos, std::pow, std::sin;
    const S turned = v[0] + v[1];
    const S x = a * sin(q[0]) * v[0] + b / 2 * sin(q[0] + q[1]) * turned,
            y = a * cos(q[0]) * v[0] + b / 2 * cos(q[0] + q[1]) * turned;
    const S kinetic = m1 * a * a / 6 * pow(v[0], 2) + m2 * b * b / 24 * pow(turned, 2) +
                      m3 * c * c / 6 * pow(v[2], 2) + m2 / 2 * (pow(x, 2) + pow(y, 2));
    return kinetic - g * (m1 * a / 2 * sin(q[0]) + m2 * (a * sin(q[0]) + b / 2 * sin(q[0] + q[1])) +
                          m3 * c / 2 * sin(q[2]));
  }
  template <class S>
  void constraints(const S* q, const S&, S* phi) const {
    using std::cos, std::sin;
    phi[0] = c * cos(q[2]) + d - a * cos(q[0]) - b * cos(q[0] + q[1]);
    phi[1] = c * sin(q[2]) - a * sin(q[0]) - b * sin(q[0] + q[1]);
  }
};
const char* const four_bar = R"toml(
[parameters]
m1 = 1
m2 = 2
m3 = 1.5
a = 0.5
b = 2
c = 1.5
d = 2
g = 9.81
[lagrangian]
coordinates = ["O", "A", "C"]
units = ["rad", "rad", "rad"]
position = [1.5707963267948966, -1.06, 1.74]
lagrangian = """m1*a*a/6*O.dot^2 + m2*b*b/24*(O.dot + A.dot)^2 + m3*c*c/6*C.dot^2
  + m2/2*((a*sin(O)*O.dot + b/2*sin(O + A)*(O.dot + A.dot))^2
          + (a*cos(O)*O.dot + b/2*cos(O + A)*(O.dot + A.dot))^2)
  - g*(m1*a/2*sin(O) + m2*(a*sin(O) + b/2*sin(O + A)) + m3*c/2*sin(C))"""
constraints = [{ name = "x", equation = "c*cos(C) + d - a*cos(O) - b*cos(O + A)" },
               { name = "y", equation = "c*sin(C) - a*sin(O) - b*sin(O + A)" }]
[assembly]
hold = ["O"]
)toml";
Scene written_four_bar() {
  Scene scene;
  scene.lagrangian = lagrangian_of(
      FourBar{}, {{"O", "rad", 1.5707963267948966}, {"A", "rad", -1.06}, {"C", "rad", 1.74}},
      {{"x", {}, false, {}}, {"y", {}, false, {}}});
  scene.held = {"O"};
  return scene;
}

/// All that the formulas may have: full M(q, t), terms linear in the rates, t, forces, a choice.
struct Crowded {
  template <class S>
  S lagrangian(const S* q, const S* v, const S& t) const {
    using std::cos, std::exp, std::pow, std::sin;
    const S &x = q[0], &y = q[1], &z = q[2];
    return (1 + pow(x, 2)) * pow(v[0], 2) + (2 + cos(y) + 0.1 * sin(t)) * pow(v[1], 2) +
           pow(v[2], 2) + 0.5 * sin(x * y) * v[0] * v[1] + 0.3 * z * v[1] * v[2] +
           (y - 0.5 * x * t) * v[0] + x * z * v[2] - pow(x, 2) - exp(0.3 * y) * z - 0.2 * t * x * y;
  }
  template <class S>
  void forces(const S* q, const S* v, const S& t, S* tau) const {
    using std::abs, std::cos;
    tau[1] = -0.3 * v[1] * abs(v[1]) + 0.1 * v[0];
    tau[2] = choose(q[0] > 0.2 && !(q[0] >= 3), cos(t) * q[0], q[0] + 0 * t);
  }
  template <class S>
  void constraints(const S* q, const S& t, S* phi) const {
    using std::pow, std::sin;
    phi[0] = q[0] * q[1] + pow(q[2], 2) - 0.2 * sin(t) * q[0] - 0.4;
  }
};
const char* const crowded = R"toml(
[lagrangian]
coordinates = ["x", "y", "z"]
units = ["m", "m", "m"]
position = [0.3, -0.4, 0.7]
velocity = [0.5, 0.2, -0.3]
lagrangian = """(1 + x^2)*x.dot^2 + (2 + cos(y) + 0.1*sin(t))*y.dot^2 + z.dot^2 + 0.5*sin(x*y)*x.dot*y.dot
  + 0.3*z*y.dot*z.dot + (y - 0.5*x*t)*x.dot + x*z*z.dot - x^2 - exp(0.3*y)*z - 0.2*t*x*y"""
force = { y = "-0.3*y.dot*abs(y.dot) + 0.1*x.dot", z = "if(x > 0.2 and not x >= 3, cos(t)*x, x + 0*t)" }
constraints = [{ name = "tie", equation = "x*y + z^2 - 0.2*sin(t)*x - 0.4" }]
)toml";
Scene written_crowded() {
  Scene scene;
  scene.lagrangian =
      lagrangian_of(Crowded{}, {{"x", "m", 0.3, 0.5}, {"y", "m", -0.4, 0.2}, {"z", "m", 0.7, -0.3}},
                    {{"tie", {}, false, {}}});
  return scene;
}

RunResult run(const Scene& scene, RunSettings settings) {
  const Mechanism mechanism(scene);
  RunRequest request;
  request.settings = std::move(settings);
  request.keep_trajectory = true;
  return run_form(mechanism, assemble(mechanism).start, request);
}

void expect_one_run(const Scene& typed, const Scene& written, const std::string& form) {
  RunSettings s;
  s.form = form;
  s.gauge = takes_gauge(form) ? "leak:3" : "";
  if (is_dae_form(form)) {
    s.integrator = "ida";
  } else {
    s.integrator = "rk4";
    s.step = 0.005;
  }
  s.end_time = 0.5;
  s.samples = 20;
  const RunResult a = run(typed, s), b = run(written, s);
  ASSERT_EQ(a.status, "done") << a.reason;
  ASSERT_EQ(b.status, "done") << b.reason;
  ASSERT_EQ(a.trajectory.rows.size(), b.trajectory.rows.size());
  ASSERT_GT(a.trajectory.rows.size(), 10U);
  for (std::size_t i = 0; i < a.trajectory.rows.size(); ++i)
    for (std::size_t k = 0; k < a.trajectory.rows[i].size(); ++k)
      ASSERT_EQ(std::bit_cast<std::uint64_t>(a.trajectory.rows[i][k]),
                std::bit_cast<std::uint64_t>(b.trajectory.rows[i][k]))
          << "row " << i << ", column " << k << ": " << a.trajectory.rows[i][k] << " and "
          << b.trajectory.rows[i][k];
  EXPECT_EQ(a.position_drift_max, b.position_drift_max);
  EXPECT_EQ(a.energy_error_max, b.energy_error_max);
}

class EveryFormOfWritten : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(TracedLagrangian, EveryFormOfWritten, testing::ValuesIn(form_names()),
                         [](const auto& form) {
                           std::string name = form.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST_P(EveryFormOfWritten, MovesAWrittenFourBarAsTheTypedOne) {
  expect_one_run(parse_scene(four_bar), written_four_bar(), GetParam());
}
TEST_P(EveryFormOfWritten, MovesWhatHasEverythingAsTheTypedOne) {
  expect_one_run(parse_scene(crowded), written_crowded(), GetParam());
}

TEST(TracedLagrangian, ServesPlainNumbersToo) {
  const Crowded system;
  const double q[]{0.3, -0.4, 0.7}, v[]{0.5, 0.2, -0.3};
  double tau[3]{};
  system.forces(q, v, 0.25, tau);
  EXPECT_EQ(tau[2], std::cos(0.25) * 0.3);
  const LagrangianSpec spec = *written_crowded().lagrangian;
  const double x[]{0.3, -0.4, 0.7, 0.5, 0.2, -0.3, 0.25};
  const std::vector<std::string> names{"x", "y", "z", "x.dot", "y.dot", "z.dot", "t"};
  EXPECT_NEAR(Expression(spec.lagrangian.text, names)(x), system.lagrangian(q, v, 0.25), 1e-15);
  ASSERT_EQ(spec.forces.size(), 2U);  // of three; the one on x stays 0
  EXPECT_EQ(spec.forces[0].coordinate, "y");
}

TEST(TracedLagrangian, IsASceneThatFilesHold) {
  const Scene written = written_crowded(), again = parse_scene(scene_text(written));
  EXPECT_EQ(again.lagrangian->lagrangian.text, written.lagrangian->lagrangian.text);
  EXPECT_EQ(again.lagrangian->forces[1].value.text,
            "if(0.2 < x and not 3 <= x, cos(t)*x, x + 0*t)");
}

/// n angles, each counted from the link before: rotations multiply, and every link has those before
/// it in it, twice, so that without definitions its text would grow like 4^n.
struct RelativeChain {
  int n;
  template <class S>
  S lagrangian(const S* q, const S* v, const S&) const {
    using std::cos, std::sin;
    S c = 1, s = 0, x = 0, y = 0, vx = 0, vy = 0, w = 0, sum = 0;
    for (int k = 0; k < n; ++k) {
      const S turned = c * cos(q[k]) - s * sin(q[k]);
      s = s * cos(q[k]) + c * sin(q[k]);
      c = turned;
      w += v[k];
      x += c, y += s;
      vx -= s * w, vy += c * w;
      sum += 0.5 * (vx * vx + vy * vy) - 9.81 * y;
    }
    return sum;
  }
};
TEST(TracedLagrangian, OfManyLinksIsWrittenByDefinitions) {
  const int n = 24;
  std::vector<LagrangianSpec::Coordinate> angles;
  for (int k = 0; k < n; ++k) angles.push_back({"q" + std::to_string(k), "rad", 0.1 * k, 0.2});
  Scene scene;
  scene.lagrangian = lagrangian_of(RelativeChain{n}, angles);
  EXPECT_LT(scene.lagrangian->lagrangian.text.size(), 50'000U);
  RunSettings s;
  s.form = "momentum";
  s.integrator = "dop853";
  s.rtol = s.atol = 1e-11;
  s.end_time = 0.5;
  s.samples = 5;
  const RunResult found = run(scene, s);
  ASSERT_EQ(found.status, "done") << found.reason;
  EXPECT_LT(found.energy_error_max, 1e-6);
}

std::string sentence(const std::function<void()>& act) {
  try {
    act();
  } catch (const std::exception& e) {
    return e.what();
  }
  return "nothing was thrown";
}

struct Quartic {
  template <class S>
  S lagrangian(const S*, const S* v, const S&) const {
    return v[0] * v[0] * v[0] * v[0];
  }
};
struct Steep {
  template <class S>
  S lagrangian(const S* q, const S* v, const S&) const {
    using std::sqrt;
    return 0.5 * v[0] * v[0] - sqrt(q[0]);
  }
};
struct Free {
  template <class S>
  S lagrangian(const S*, const S* v, const S&) const {
    return 0.5 * v[0] * v[0];
  }
};
struct Tied : Free {
  template <class S>
  void constraints(const S*, const S& t, S* phi) const {
    phi[0] = t;
  }
};

TEST(TracedLagrangian, IsRefusedInOneSentence) {
  const auto mechanism = [](LagrangianSpec spec) {
    return sentence([&] {
      Scene scene;
      scene.lagrangian = std::move(spec);
      Mechanism{scene};
    });
  };
  EXPECT_EQ(
      mechanism(lagrangian_of(Quartic{}, {{"x", "m"}})),
      "scene: lagrangian: its second derivative by 'x.dot' twice has 'x.dot' in it, expected a "
      "formula quadratic in the rates");
  EXPECT_EQ(mechanism(lagrangian_of(Steep{}, {{"x", "m", 0}})),
            "scene: lagrangian: its derivative by 'x' is infinite at the start, expected a finite "
            "number");
  EXPECT_EQ(mechanism(lagrangian_of(Free{}, {})),
            "scene: lagrangian: has no coordinates, expected at least one");
  EXPECT_EQ(mechanism(lagrangian_of(Tied{}, {{"x", "m"}}, {{"tie", {}, false, {}}})),
            "scene: constraint 'tie' has no coordinate in it, expected an equation that ties "
            "coordinates");
  EXPECT_EQ(sentence([] {
              lagrangian_of(Tied{}, {{"x", "m"}});
            }),
            "the class has constraints(q, t, phi) and no constraint has a name, expected one name "
            "for each of their values");
  EXPECT_EQ(sentence([] {
              lagrangian_of(Free{}, {{"x", "m"}}, {{"tie", {}, false, {}}});
            }),
            "1 constraints have names and the class has no constraints(q, t, phi), expected both");
}

}  // namespace
}  // namespace momenta::dae_written_lagrangian
