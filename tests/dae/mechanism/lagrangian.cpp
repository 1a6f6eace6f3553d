// The laws of systems that are typed as a Lagrangian: the same motion as the scene of bodies with
// the same coordinates, in every form; power; derivatives against differences in quad precision;
// the literature's numbers.

#include "equations/examples.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/expression/functions_quad.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/mechanism/lagrangian_rows.h>
#include <momenta/dae/output/chart.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/index_study.h>
#include <momenta/dae/study/modes_study.h>
#include <momenta/dae/study/own_reference.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <random>

namespace momenta::dae_lagrangian {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using equations::example;

Scene typed(const std::string& text) {
  return parse_scene(text, "typed.toml");
}

/// examples/four_bar in its three angles, the coupler's counted from the crank.
const char* const four_bar = R"toml(
name = "Planar crank-rocker"
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
kinetic = """m1*a^2/6*O.dot^2 + m2*b^2/24*(O.dot + A.dot)^2 + m3*c^2/6*C.dot^2
  + m2/2*((a*sin(O)*O.dot + b/2*sin(O + A)*(O.dot + A.dot))^2
          + (a*cos(O)*O.dot + b/2*cos(O + A)*(O.dot + A.dot))^2)"""
potential = "g*(m1*a/2*sin(O) + m2*(a*sin(O) + b/2*sin(O + A)) + m3*c/2*sin(C))"
constraints = [{ name = "x", equation = "c*cos(C) + d - a*cos(O) - b*cos(O + A)" },
               { name = "y", equation = "c*sin(C) - a*sin(O) - b*sin(O + A)" }]
[assembly]
hold = ["O"]
[run]
end = 2
step = 0.005
leak = 3
samples = 40
)toml";
/// A point mass on a rod, with a damper along x, over a point that moves up and down.
const char* const shaken_pendulum = R"toml(
[parameters]
m = 1.3
g = 9.81
l = 1
h = 0.1
[lagrangian]
coordinates = ["x", "y"]
units = ["m", "m"]
position = [-1, 0]
lagrangian = "0.5*m*(x.dot^2 + y.dot^2) - m*g*y"
force = { x = "-0.2*x.dot" }
constraints = [{ name = "rod", equation = "hypot(x, y - h*sin(5*t)) - l" }]
)toml";
/// All that the formulas may have: full M(q, t), terms linear in the rates, t in L and in Φ.
const char* const crowded = R"toml(
[lagrangian]
coordinates = ["x", "y", "z"]
position = [0.3, -0.4, 0.7]
velocity = [0.5, 0.2, -0.3]
lagrangian = """(1 + x^2)*x.dot^2 + (2 + cos(y) + 0.1*sin(t))*y.dot^2 + z.dot^2 + 0.5*sin(x*y)*x.dot*y.dot
  + 0.3*z*y.dot*z.dot + (y - 0.5*x*t)*x.dot + x*z*z.dot - x^2 - exp(0.3*y)*z - 0.2*t*x*y"""
force = { y = "-0.3*y.dot*abs(y.dot) + 0.1*x.dot", z = "cos(t)*x" }
constraints = [{ name = "tie", equation = "x*y + z^2 - 0.2*sin(t)*x - 0.4" }]
)toml";

RunResult run(const Scene& scene, RunSettings settings) {
  const Mechanism mechanism(scene);
  RunRequest request;
  request.settings = std::move(settings);
  request.keep_trajectory = true;
  return run_form(mechanism, assemble(mechanism).start, request);
}

class EveryForm : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Lagrangian, EveryForm, testing::ValuesIn(form_names()),
                         [](const auto& form) {
                           std::string name = form.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// Of ODE forms, with fixed steps, the runs: what differs is the order of additions.
TEST_P(EveryForm, MovesATypedFourBarAsItsBodiesMove) {
  RunSettings s;
  s.form = GetParam();
  if (is_dae_form(s.form)) return;  // steps that are chosen differ by rounding: residuals, below
  s.gauge = takes_gauge(s.form) ? "leak:3" : "";
  s.step = 0.005;
  s.integrator = "rk4";
  s.end_time = 2;
  s.samples = 40;
  const RunResult a = run(example("four_bar/scene.toml"), s), b = run(typed(four_bar), s);
  ASSERT_EQ(a.status, "done") << a.reason;
  ASSERT_EQ(b.status, "done") << b.reason;
  ASSERT_EQ(a.trajectory.rows.size(), b.trajectory.rows.size());
  double worst = 0;
  for (std::size_t i = 0; i < a.trajectory.rows.size(); ++i)
    for (std::size_t k = 1; k <= 6; ++k)
      worst = equations::larger(worst, std::abs(a.trajectory.rows[i][k] - b.trajectory.rows[i][k]));
  EXPECT_LT(worst, 1e-11);
  const auto alike = [&](double x, double y, const char* what) {
    EXPECT_NEAR(x, y, 1e-6 * y + 1e-13) << what;
  };
  alike(a.position_drift_max, b.position_drift_max, "position drift");
  alike(a.velocity_drift_max, b.velocity_drift_max, "velocity drift");
  alike(a.energy_error_max, b.energy_error_max, "energy error");
}

// Of DAE forms the residuals and their derivatives, off the constraints too.
TEST_P(EveryForm, HasTheResidualsOfATypedFourBarsBodies) {
  if (!is_dae_form(GetParam())) return;
  const Mechanism bodies(example("four_bar/scene.toml")), formulas(typed(four_bar));
  FormOptions options;
  options.gauge = parse_gauge(takes_gauge(GetParam()) ? "leak:3" : "none");
  const Start start = assemble(bodies).start;
  const auto a = make_form(GetParam(), bodies, options, start),
             b = make_form(GetParam(), formulas, options, start);
  const int n = a->dae()->size();
  ASSERT_EQ(n, b->dae()->size());
  const auto size = static_cast<std::size_t>(n);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int state = 0; state < 20; ++state) {
    std::vector<double> y(size), ydot(size), r(size), s(size), J(size * size), K(size * size);
    for (double& x : y) x = normal(random);
    for (double& x : ydot) x = normal(random);
    ASSERT_TRUE(a->dae()->residual(0, y.data(), ydot.data(), r.data()));
    ASSERT_TRUE(b->dae()->residual(0, y.data(), ydot.data(), s.data()));
    ASSERT_TRUE(a->dae()->jacobian(0, y.data(), ydot.data(), 7.0, J.data()));
    ASSERT_TRUE(b->dae()->jacobian(0, y.data(), ydot.data(), 7.0, K.data()));
    for (std::size_t i = 0; i < size; ++i) EXPECT_NEAR(r[i], s[i], 1e-11) << "row " << i;
    for (std::size_t i = 0; i < size * size; ++i) EXPECT_NEAR(J[i], K[i], 1e-10) << "entry " << i;
  }
}

TEST_P(EveryForm, MovesAConstraintThatMoves) {
  RunSettings s;
  s.form = GetParam();
  if (is_dae_form(s.form)) s.integrator = "ida";
  s.gauge = takes_gauge(s.form) ? "leak:3" : "";
  s.end_time = 1;
  s.samples = 10;
  s.rtol = s.atol = 1e-9;
  RunSettings reference = s;
  reference.form = "projected";
  reference.integrator = "dop853";
  reference.gauge = "";
  reference.rtol = reference.atol = 1e-12;
  const RunResult exact = run(typed(shaken_pendulum), reference),
                  found = run(typed(shaken_pendulum), s);
  ASSERT_EQ(exact.status, "done") << exact.reason;
  ASSERT_EQ(found.status, "done") << found.reason;
  for (std::size_t k = 1; k <= 4; ++k)
    EXPECT_NEAR(found.trajectory.rows.back()[k], exact.trajectory.rows.back()[k], 2e-5) << k;
}

/// ∂/∂x_i by central differences in quad, good to 1e-17 or so.
template <class F>
Quad difference(F&& f, std::vector<Quad> x, std::size_t i) {
  const Quad h = 1e-11;
  const Quad at = x[i];
  x[i] = at + h;
  const Quad right = f(x);
  x[i] = at - h;
  return (right - f(x)) / (Quad(2) * h);
}

// Formulas of the tapes against differences of L and Φ themselves, in quad.
TEST(Lagrangian, TapesAreDerivativesOfTheFormulas) {
  const Scene scene = typed(crowded);
  const LagrangianModel model = build_lagrangian_model(scene);
  // L and Φ once more, over q, q̇, t.
  const std::vector<std::string> names{"x", "y", "z", "x.dot", "y.dot", "z.dot", "t"};
  const auto formula = [&](const std::string& text) {
    return [e = Expression(text, names)](const std::vector<Quad>& x) {
      std::vector<Quad> line(e.tape().size());
      Quad value;
      evaluate(e, x.data(), line.data(), &value);
      return value;
    };
  };
  const auto L = formula(scene.lagrangian->lagrangian.text);
  const auto phi = formula(scene.lagrangian->constraints[0].equation.text);
  const std::vector<Quad> x{0.31, -0.42, 0.77, 0.5, 0.2, -0.3, 0.9};
  const Quad udot[]{0.7, -0.1, 0.4}, sigma[]{1.7};
  LagrangianRows<Quad> rows(model);
  const Quad *q = x.data(), *u = q + 3;
  rows.place(0.9, q);
  rows.move(u);
  std::vector<Quad> p(3), pdot(3), tau(3), mass(6), gradient(3), rate(1), second(1), applied(3);
  rows.momenta(nullptr, p.data());
  rows.momentum_rates(q, u, nullptr, 0, pdot.data());
  rows.joint_forces(q, u, udot, nullptr, tau.data());
  rows.accelerations(second.data());
  rows.velocities(rate.data());
  rows.constraint_forces(sigma, gradient.data());
  rows.applied_forces(0.9, q, u, applied.data(), true);
  const double bound = 1e-15;
  const auto by_rate = [&](std::size_t i) {
    return [&L, i](const std::vector<Quad>& at) { return difference(L, at, 3 + i); };
  };
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(value_of(p[i]), value_of(difference(L, x, 3 + i)), bound) << i;
    EXPECT_NEAR(value_of(pdot[i] - applied[i]), value_of(difference(L, x, i)), bound) << i;
    EXPECT_NEAR(value_of(gradient[i]), value_of(sigma[0] * difference(phi, x, i)), bound) << i;
    // d/dt ∂L/∂q̇ by the chain rule
    Quad sum = difference(by_rate(i), x, 6);
    for (std::size_t j = 0; j < 3; ++j)
      sum += difference(by_rate(i), x, j) * u[j] + difference(by_rate(i), x, 3 + j) * udot[j];
    EXPECT_NEAR(value_of(tau[i]), value_of(sum - pdot[i]), 1e-9) << i;
  }
  const auto phi_dot = [&](const std::vector<Quad>& at) {
    Quad sum = difference(phi, at, 6);
    for (std::size_t j = 0; j < 3; ++j) sum += difference(phi, at, j) * at[3 + j];
    return sum;
  };
  EXPECT_NEAR(value_of(rate[0]), value_of(phi_dot(x)), bound);
  Quad again = difference(phi_dot, x, 6);
  for (std::size_t j = 0; j < 3; ++j)
    again += difference(phi_dot, x, j) * u[j] + difference(phi_dot, x, 3 + j) * udot[j];
  EXPECT_NEAR(value_of(second[0]), value_of(again), 1e-9);
  // What closes (8): Φ̇_qᵀσ
  std::vector<Quad> with(3);
  rows.place(0.9, q);
  rows.move(u);
  rows.momentum_rates(q, u, sigma, 0.25, with.data());
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(value_of(with[i] - pdot[i] + Quad(0.25) * gradient[i]),
                value_of(sigma[0] * difference(phi_dot, x, i)), 1e-9)
        << i;
}

// p of (7) and ṗ of (8) say the same as (1a): d/dt (M u + Φ_qᵀσ + b) = ṗ where λ = σ̇.
TEST(Lagrangian, MomentaAndAccelerationsSayTheSame) {
  const Mechanism mechanism(typed(crowded));
  const Start start = assemble(mechanism).start;
  const auto e = mechanism.evaluation<Quad>();
  const double h = 1e-9, sigma = 0.8;
  const auto n = static_cast<std::size_t>(mechanism.nv());
  const auto p_at = [&](double s) {
    std::vector<Quad> q(n), u(n), p(n);
    for (std::size_t i = 0; i < n; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      q[i] = Quad(start.q[k]) + Quad(s) * Quad(start.u[k]) +
             Quad(0.5) * Quad(s) * Quad(s) * Quad(start.udot[k]);
      u[i] = Quad(start.u[k]) + Quad(s) * Quad(start.udot[k]);
    }
    const Quad impulse[]{Quad(sigma) + Quad(s) * Quad(start.lambda[0])};
    e->place(s, q.data());
    e->move(u.data());
    e->momenta(impulse, p.data());
    return p;
  };
  const std::vector<Quad> right = p_at(h), left = p_at(-h);
  std::vector<Quad> q(start.q.begin(), start.q.end()), u(start.u.begin(), start.u.end()), pdot(n);
  const Quad impulse[]{sigma};
  e->place(0, q.data());
  e->move(u.data());
  e->momentum_rates(q.data(), u.data(), impulse, 0, pdot.data());
  for (std::size_t i = 0; i < n; ++i)
    EXPECT_NEAR(value_of((right[i] - left[i]) / Quad(2 * h)), value_of(pdot[i]), 1e-11) << i;
}

// Damping, t in L and terms linear in the rates: ḣ = Q·u − L_t, no constraint moving.
TEST(Lagrangian, EnergyChangesByThePowerThatIsTold) {
  const Mechanism mechanism(typed(R"toml(
[lagrangian]
coordinates = ["x", "y"]
position = [0.4, 0.1]
velocity = [0.3, -0.5]
lagrangian = "(1 + 0.2*cos(y))*x.dot^2/2 + (1 + 0.3*sin(t))*y.dot^2/2 + x*y.dot*cos(t) - x^2 - 0.1*t*y^2"
force = { x = "-0.4*x.dot" }
)toml"));
  const Start start = assemble(mechanism).start;
  const RunResult run =
      run_form(mechanism, start, equations::adaptive("momentum", "dop853", "none", 1e-13, 5));
  ASSERT_EQ(run.status, "done") << run.reason;
  ASSERT_FALSE(run.series.energy.empty());
  EXPECT_LT(run.energy_error_max, 1e-10);
  EXPECT_GT(run.kinetic_energy_max, 0.05);
}

/// The sentence with which a mechanism of this text is refused.
std::string refused(const std::string& text) {
  try {
    const Mechanism mechanism(typed(text));
    assemble(mechanism);
  } catch (const SceneError& e) {
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
    return e.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return "";
}
void expect_refused(const std::string& text, const std::string& part) {
  const std::string sentence = refused(text);
  EXPECT_NE(sentence.find(part), std::string::npos) << sentence << "\nmissing: " << part;
}

TEST(Lagrangian, RefusesWhatIsNoMechanism) {
  const std::string x = "[lagrangian]\ncoordinates = [\"x\", \"y\"]\n";
  expect_refused(x + "lagrangian = \"x.dot^4 + y.dot^2\"\n",
                 "typed.toml:3:14: lagrangian: its second derivative by 'x.dot' twice has 'x.dot' "
                 "in it, expected a formula quadratic in the rates");
  expect_refused(x + "lagrangian = \"x.dot^2 + y.dot^2 + x.dot*sign(x.dot)\"\n",
                 "typed.toml:3:14: lagrangian: its 'sign' turns with the rate 'x.dot', expected a "
                 "formula that is smooth in the rates");
  expect_refused(x + "kinetic = \"x.dot^2 + if(y.dot < x, 1, 2)*y.dot^2\"\n",
                 "kinetic: its 'if' turns with the rate 'y.dot'");
  for (const char* factor : {"sign(x - 0.5)*x.dot", "y.dot*floor(2*x)", "if(x > 0, 1, 2)*y.dot^2",
                             "(x.dot + floor(y))^2"})
    expect_refused(x + "lagrangian = \"x.dot^2 + y.dot^2 + " + factor + "\"\n",
                   "has an 'if', sign or floor of the coordinate '");
  for (const char* smooth : {"x.dot*abs(x)", "y.dot*max(0, x)", "if(x > 0, x, 2*x)",
                             "2*(y.dot^2 - if(x > 0, x, 0)^2)", "x.dot*sign(t - 1)"})
    EXPECT_NO_THROW(Mechanism(typed(x + "lagrangian = \"x.dot^2 + y.dot^2 + " + smooth + "\"\n")))
        << smooth;
  expect_refused(x + "kinetic = \"x.dot^2 + y.dot^2\"\nconstraints = [{ name = \"c\", equation "
                     "= \"abs(x) + abs(y) - 1\" }]\n",
                 "constraint 'c' has 'abs', where no second derivative may exist; expected a "
                 "smooth formula");
  EXPECT_NO_THROW(Mechanism(
      typed(x + "lagrangian = \"abs(x)*x.dot^2 + y.dot^2 + x.dot^2 + tanh(9*x)*x.dot\"\n")));
  expect_refused(x + "kinetic = \"x.dot^2 + y.dot^2*sin(x.dot)\"\n",
                 "kinetic: its second derivative by 'x.dot' twice has 'x.dot' in it");
  expect_refused(
      x + "kinetic = \"x.dot^2\"\n",
      "coordinate 'y' has no inertia: its rate is not in the Lagrangian, and it is in no "
      "constraint; expected one of them");
  expect_refused(
      x + "lagrangian = \"0.5*x.dot^2 + x*y.dot - 0.5*y^2\"\n",
      "coordinate 'y' has no inertia: the Lagrangian is linear in its rate, and it is in "
      "no constraint; expected a Lagrangian quadratic in it, or a constraint");
  expect_refused(x + "kinetic = \"(x.dot + y.dot)^2\"\n", "' has no inertia, alone or with");
  expect_refused(x + "kinetic = \"x.dot^2 - y.dot^2\"\n", "coordinate 'y' has no inertia");
  expect_refused(x + "kinetic = \"x.dot^2 + y.dot^2\"\npotential = \"log(x)\"\n",
                 "kinetic - potential: its derivative by 'x' is infinite at the start");
  expect_refused(x + "kinetic = \"x.dot^2 + y.dot^2\"\nforce = { y = \"sqrt(x - 1)\" }\n",
                 "typed.toml:4:15: force on 'y': is nan at the start, expected a finite number");
  expect_refused(x + "kinetic = \"x.dot^2 + y.dot^2\"\nconstraints = [{ name = \"c\", equation "
                     "= \"sqrt(x - 1)\" }]\n",
                 "constraint 'c': has the value nan at the start");
  expect_refused(x + "kinetic = \"x.dot^2 + y.dot^2\"\nconstraints = [{ name = \"c\", equation "
                     "= \"x^2 + y^2 + 1\" }]\n",
                 "constraint 'c' stays open by 1");
  expect_refused(x + "kinetic = \"x.dot^2\"\nconstraints = [{ name = \"c\", equation = \"x\" }]\n",
                 "coordinate 'y' has no inertia: its rate is not in the Lagrangian");
}

// A massless coordinate that a constraint holds, and constraints that say the same twice.
TEST(Lagrangian, HoldsMasslessCoordinatesAndRedundantConstraints) {
  const std::string pendulum =
      "[lagrangian]\ncoordinates = [\"a\", \"x\", \"y\"]\nposition = [1, \"sin(1)\", \"-cos(1)\"]\n"
      "kinetic = \"x.dot^2/2 + y.dot^2/2\"\npotential = \"9.81*y\"\nconstraints = [\n"
      "{ name = \"x\", equation = \"x - sin(a)\" }, { name = \"y\", equation = \"y + cos(a)\" }";
  const std::string rod = ", { name = \"rod\", equation = \"hypot(x, y) - 1\" }";
  const Mechanism angle(
      typed("[lagrangian]\ncoordinates = [\"a\"]\nposition = [1]\nkinetic = "
            "\"a.dot^2/2\"\npotential = \"-9.81*cos(a)\"\n"));
  RunSettings s;
  s.form = "momentum-index2";
  s.integrator = "ida";
  s.gauge = "leak:3";
  s.rtol = s.atol = 1e-9;
  s.end_time = 1;
  s.samples = 5;
  RunRequest request;
  request.settings = s;
  request.keep_trajectory = true;
  const RunResult expected = run_form(angle, assemble(angle).start, request);
  for (const std::string& more : {std::string(), rod}) {
    const Mechanism mechanism(typed(pendulum + more + "]\n"));
    const Assembly a = assemble(mechanism);
    EXPECT_EQ(a.rank, 2);
    EXPECT_EQ(a.mobility, 1);
    EXPECT_EQ(a.dependent_rows.size(), more.empty() ? 0U : 1U);
    const RunResult found = run_form(mechanism, a.start, request);
    ASSERT_EQ(found.status, "done") << found.reason;
    EXPECT_NEAR(found.trajectory.rows.back()[1], expected.trajectory.rows.back()[1], 1e-5);
    // Those that take rates from p alone say so.
    for (const auto& [form, integrator] :
         {std::pair("momentum-index3", "ida"), std::pair("momentum", "rattle")}) {
      RunRequest other = request;
      other.settings.form = form;
      other.settings.integrator = integrator;
      other.settings.gauge = "none";
      other.settings.step = 0.01;
      const RunResult refused = run_form(mechanism, a.start, other);
      EXPECT_NE(refused.status, "done");
      EXPECT_NE(refused.reason.find("takes rates from M u = p, and coordinate 'a' has no inertia "
                                    "without the constraints; expected"),
                std::string::npos)
          << refused.reason;
    }
  }
}

/// A chain of n point masses on rods, in x and y.
Scene cartesian_chain(int n) {
  std::string names, position, kinetic, potential, constraints;
  for (int i = 1; i <= n; ++i) {
    const std::string k = std::to_string(i), before = std::to_string(i - 1);
    const std::string dx = i == 1 ? "x1" : "(x" + k + " - x" + before + ")",
                      dy = i == 1 ? "y1" : "(y" + k + " - y" + before + ")";
    const std::string more = i == 1 ? "" : ", ", plus = i == 1 ? "" : " + ";
    names += more + "\"x" + k + "\", \"y" + k + "\"";
    position += more + k + ", 0";
    kinetic += plus + "x" + k + ".dot^2/2 + y" + k + ".dot^2/2";
    potential += plus + "9.81*y" + k;
    constraints +=
        more + "{ name = \"r" + k + "\", equation = \"hypot(" + dx + ", " + dy + ") - 1\" }";
  }
  return typed("[lagrangian]\ncoordinates = [" + names + "]\nposition = [" + position +
               "]\nkinetic = \"" + kinetic + "\"\npotential = \"" + potential +
               "\"\nconstraints = [" + constraints + "]\n");
}

// M with zeros between entries: the factor's columns reach their ancestors.
TEST(Lagrangian, SolvesASparseMassMatrix) {
  const Mechanism mechanism(
      typed("[lagrangian]\ncoordinates = [\"a\", \"b\", \"c\", \"d\", \"e\"]\nkinetic = "
            "\"a.dot^2 + b.dot^2 + c.dot^2 + d.dot^2 + e.dot^2 + 0.3*c.dot*d.dot + "
            "0.2*b.dot*c.dot + 0.4*a.dot*d.dot\"\n"));
  MatrixXd M = 2 * MatrixXd::Identity(5, 5);
  M(2, 3) = M(3, 2) = 0.3;
  M(1, 2) = M(2, 1) = 0.2;
  M(0, 3) = M(3, 0) = 0.4;
  const VectorXd q = VectorXd::Zero(5), p = VectorXd::LinSpaced(5, 1, 3);
  VectorXd u(5), pdot(5);
  const auto e = mechanism.evaluation<double>();
  ASSERT_TRUE(e->open_momentum_rates(0, q.data(), p.data(), u.data(), pdot.data()));
  EXPECT_LT((M * u - p).norm(), 1e-14);
  EXPECT_EQ(mechanism.kkt_pattern().mass.size(), 11U);  // e stands alone
}

ModesResult modes_of(const std::string& text) {
  const Mechanism mechanism(typed(text));
  return find_modes(mechanism, assemble(mechanism).start, {});
}

// m ẍ + c ẋ + k x = 0
TEST(Lagrangian, SmallMotionsAreThoseOfADampedOscillator) {
  const ModesResult found = modes_of(
      "[lagrangian]\ncoordinates = [\"x\"]\nposition = [0.3]\nlagrangian = \"x.dot^2 - 25*(x - "
      "1)^2\"\nforce = { x = \"-1.2*x.dot\" }\n");
  ASSERT_EQ(found.spectrum.modes.size(), 1U);
  EXPECT_NEAR(found.equilibrium.q[0], 1, 1e-9);
  const auto s = found.spectrum.modes[0].s;
  EXPECT_NEAR(s.real(), -1.2 / 4, 1e-12);
  EXPECT_NEAR(s.imag(), std::sqrt(4 * 2 * 50 - 1.2 * 1.2) / 4, 1e-12);
}

// A point on an isotropic spring, seen from a frame that turns at w: ω₀ ± w.
TEST(Lagrangian, SmallMotionsInATurningFrameSplit) {
  const ModesResult found = modes_of(
      "[lagrangian]\ncoordinates = [\"x\", \"y\"]\nlagrangian = \"((x.dot - 0.3*y)^2 + (y.dot + "
      "0.3*x)^2 - x^2 - y^2)/2\"\n");
  ASSERT_EQ(found.spectrum.modes.size(), 2U);
  EXPECT_FALSE(found.spectrum.conservative);
  EXPECT_NEAR(std::abs(found.spectrum.modes[0].s), 0.7, 1e-12);
  EXPECT_NEAR(std::abs(found.spectrum.modes[1].s), 1.3, 1e-12);
}

// The index belongs to the form, whatever the constraint and its motion.
TEST(Lagrangian, HasTheIndexOfItsForms) {
  const Mechanism bodies(example("pendulum/cartesian.toml")), formulas(typed(shaken_pendulum));
  const IndexStudy a = run_index_study(bodies, assemble(bodies).start, {}),
                   b = run_index_study(formulas, assemble(formulas).start, {});
  ASSERT_EQ(a.forms.size(), b.forms.size());
  for (std::size_t i = 0; i < a.forms.size(); ++i)
    EXPECT_EQ(a.forms[i].text(), b.forms[i].text()) << a.forms[i].form;
}

// Whatever the units: the page of a run has a curve for each column.
TEST(Lagrangian, ChartsHaveEveryCoordinate) {
  RunSettings s;
  s.end_time = 0.1;
  s.samples = 5;
  const RunResult found = run(
      typed("[lagrangian]\ncoordinates = [\"x\", \"y\"]\nunits = [\"1\", \"mol\"]\nvelocity = [1, "
            "2]\nkinetic = \"x.dot^2 + y.dot^2\"\n"),
      s);
  std::vector<std::string> curves;
  for (const Chart& chart : charts_of_run(found))
    for (const Curve& curve : chart.curves) curves.push_back(curve.name + " " + chart.unit);
  for (const char* name : {"x 1", "y mol", "x.dot 1/s", "y.dot mol/s"})
    EXPECT_EQ(std::count(curves.begin(), curves.end(), name), 1) << name;
}

// Dense and sparse matrices give the same motion, that of bodies on hinges.
TEST(Lagrangian, ChainsInCartesianCoordinatesMoveAsBodiesOnHinges) {
  constexpr int n = 4;
  std::string bodies = "gravity = [0, -9.81, 0]\n";
  for (int i = 1; i <= n; ++i) {
    const std::string k = std::to_string(i), before = std::to_string(i - 1);
    bodies += "[[body]]\nname = \"b" + k +
              "\"\nmass = 1\ncom = [1, 0, 0]\ninertia = 0\n[[joint]]\nname = \"j" + k +
              "\"\nkind = \"revolute\"\nchild = \"b" + k + "\"\n" +
              (i == 1 ? "" : "parent = \"b" + before + "\"\norigin = { parent = [1, 0, 0] }\n");
  }
  bodies += "[[marker]]\nname = \"tip\"\nbody = \"b4\"\npoint = [1, 0, 0]\n";
  RunSettings s;
  s.form = "projected";
  s.gauge = "";
  s.rtol = s.atol = 1e-11;
  s.end_time = 1;
  s.samples = 4;
  const RunResult hinges = run(typed(bodies), s);
  ASSERT_EQ(hinges.status, "done") << hinges.reason;
  const auto& columns = hinges.trajectory.columns;
  const auto tip = static_cast<std::size_t>(std::find(columns.begin(), columns.end(), "tip.x [m]") -
                                            columns.begin());
  for (const KktChoice kkt : {KktChoice::dense, KktChoice::sparse}) {
    const Mechanism mechanism(cartesian_chain(n), {.kkt = kkt});
    EXPECT_EQ(mechanism.kkt_pattern().mass.size(), static_cast<std::size_t>(2 * n));
    RunRequest request;
    request.settings = s;
    request.keep_trajectory = true;
    const RunResult found = run_form(mechanism, assemble(mechanism).start, request);
    ASSERT_EQ(found.status, "done") << found.reason;
    EXPECT_NEAR(found.trajectory.rows.back()[2 * n - 1], hinges.trajectory.rows.back()[tip], 1e-7);
    EXPECT_NEAR(found.trajectory.rows.back()[2 * n], hinges.trajectory.rows.back()[tip + 1], 1e-7);
  }
}

// The literature's solution at t = 3: Mazzia and Magherini, Test Set for Initial Value Problem
// Solvers, release 2.4, car axis problem.
TEST(Lagrangian, CarAxisEndsWhereTheTestSetSays) {
  const double expected[]{0.493455784275402809122e-1,  0.496989460230171153861,
                          0.104174252488542151681e1,   0.373911027265361256927,
                          -0.770583684040972357970e-1, 0.744686658723778553466e-2,
                          0.175568157537232222276e-1,  0.770341043779251976443};
  for (const char* form : {"momentum", "projected", "baumgarte", "momentum-index2"}) {
    RunSettings s;
    s.form = form;
    s.end_time = 3;
    s.samples = 3;
    s.integrator = is_dae_form(form) ? "radau5" : "dop853";
    s.gauge = takes_gauge(form) ? "leak:3" : "";
    s.rtol = s.atol = is_dae_form(form) ? 1e-10 : 1e-12;
    const RunResult found = run(example("lagrangian/car_axis.toml"), s);
    ASSERT_EQ(found.status, "done") << form << ": " << found.reason;
    for (std::size_t i = 0; i < 8; ++i)
      EXPECT_NEAR(found.trajectory.rows.back()[i + 1], expected[i], 1e-6) << form << " " << i;
  }
}

// The same double pendulum, of bodies and of formulas, in quad: references agree to their digits.
TEST(Lagrangian, DoublePendulumIsThatOfItsBodies) {
  const Scene formulas = example("lagrangian/double_pendulum.toml");
  const Scene bodies = typed(R"toml(
gravity = [0, -9.81, 0]
[[body]]
name = "upper"
mass = 1
com = [0, -1, 0]
inertia = [0, 0, 0]
[[body]]
name = "lower"
mass = 1
com = [0, -0.7, 0]
inertia = [0, 0, 0]
[[joint]]
name = "O"
kind = "revolute"
child = "upper"
position = 2
[[joint]]
name = "A"
kind = "revolute"
parent = "upper"
child = "lower"
origin = { parent = [0, -1, 0] }
position = -1
)toml");
  const Mechanism a(formulas), b(bodies);
  const OwnReference of_a = own_reference(a, assemble(a).start, 2, 4, {}),
                     of_b = own_reference(b, assemble(b).start, 2, 4, {});
  EXPECT_LT(of_a.accuracy, 1e-15);
  const auto &x = of_a.reference.values(), &y = of_b.reference.values();
  ASSERT_EQ(x.size(), y.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(x[i][0], y[i][0], 1e-12) << i;
    EXPECT_NEAR(x[i][1], y[i][0] + y[i][1], 1e-12) << i;
  }
}

}  // namespace
}  // namespace momenta::dae_lagrangian
