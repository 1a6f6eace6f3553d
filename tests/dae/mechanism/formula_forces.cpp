// Forces and drives by formulas in mechanisms with loops: the motion of the built-in forces in
// every form, energy and the work of formulas, exact Jacobians against differences, wherever loops
// are cut and bodies folded, many states as one, quad precision, small motions, the index.

#include "equations/exact_jacobian.h"
#include "equations/examples.h"
#include "equations/large_scenes.h"
#include "equations/linkages.h"
#include "equations/other_trees.h"
#include "equations/parts.h"
#include "equations/random_tree.h"
#include "equations/refusal.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/expression/functions_quad.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/analysis/chain/closed_chain.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/index_study.h>
#include <momenta/dae/study/modes_study.h>
#include <momenta/dae/topology/assembly/assembly.h>
#include <momenta/dae/topology/cut/integrated_scene.h>

namespace momenta::dae_formula_forces {
namespace {

using namespace equations;
using Eigen::VectorXd;
using equations::example;

ForceSpec by_law(const std::string& kind, const std::string& law) {
  ForceSpec f;
  f.kind = kind;
  f.law = law;
  return f;
}
ForceSpec torque(const std::string& joint, const std::string& law) {
  ForceSpec f = by_law("torque", law);
  f.joint = joint;
  return f;
}
ForceSpec spring(const std::string& child, const std::string& law) {
  ForceSpec f = by_law("spring-damper", law);
  f.child = child;
  f.origin_parent = {1.5, 0.4, 0};
  f.origin_child = {0.3, 0, 0};
  return f;
}
MarkerSpec marker(const std::string& name, const std::string& body, double x) {
  return equations::make_marker(name, body, {x, 0.1, 0});
}

/// A four-bar with formulas of everything in it, smooth.
Scene four_bar_by_formulas() {
  Scene s = example("four_bar");
  s.markers = {marker("M", "coupler", 0.7), marker("N", "rocker", 0.4)};
  ForceSpec named = spring("rocker", "3 * (length - 0.8) + 0.4 * rate * length");
  named.name = "S";
  s.forces = {named, torque("O", "2 * sin(3 * t) - 0.3 * u - tanh(q)"),
              by_law("potential", "2 * ((M.x - 0.4)^2 + M.y^2) + cos(O.q) * S.length^2 + M.x * t")};
  ForceSpec push;
  push.kind = "wrench";
  push.body = "coupler";
  push.point = {0.2, 0, 0};
  push.force_law = {"-0.2 * M.vx * abs(N.vy)", "0.3 * O.u * t", ""};
  push.torque_law[2] = "0.1 * S.rate";
  push.in_body_axes = true;
  s.forces.push_back(push);
  return s;
}

RunResult run_of(const Scene& scene, const std::string& form, double end, double rtol,
                 MechanismOptions options = {}) {
  const Mechanism mechanism(scene, options);
  RunRequest request;
  request.settings = default_settings({}, form, "", rtol);
  request.settings.atol = rtol;
  request.settings.end_time = end;
  request.settings.samples = 20;
  request.keep_trajectory = true;
  return run_form(mechanism, assemble(mechanism).start, request);
}

/// Positions, rates and markers of two runs agree.
void expect_same(const RunResult& a, const RunResult& b, double bound, const std::string& what) {
  ASSERT_EQ(a.status, "done") << what << ": " << a.reason;
  ASSERT_EQ(b.status, "done") << what << ": " << b.reason;
  ASSERT_EQ(a.trajectory.columns, b.trajectory.columns) << what;
  ASSERT_EQ(a.trajectory.rows.size(), b.trajectory.rows.size()) << what;
  for (std::size_t c = 0; c < a.trajectory.columns.size(); ++c) {
    const std::string& name = a.trajectory.columns[c];
    if (name.find("drift") != name.npos || name.find("energy") != name.npos ||
        name.find("impulse") != name.npos)
      continue;
    double size = 1;
    for (const auto& row : b.trajectory.rows) size = std::max(size, std::abs(row[c]));
    for (std::size_t i = 0; i < a.trajectory.rows.size(); ++i)
      ASSERT_NEAR(a.trajectory.rows[i][c], b.trajectory.rows[i][c], bound * size)
          << what << ": " << name << " in row " << i;
  }
}

TEST(FormulaForcesInLoops, EveryFormMovesAlike) {
  for (const Algebra algebra : {Algebra::planar, Algebra::spatial}) {
    const MechanismOptions options{.algebra = algebra};
    const Scene scene = four_bar_by_formulas();
    const RunResult tight = run_of(scene, "momentum", 1, 1e-12, options);
    for (const std::string& form : form_names()) {
      const bool late = form.find("-index3") != form.npos;
      expect_same(run_of(scene, form, 1, 1e-9, options), tight,
                  late                ? 1e-2
                  : is_dae_form(form) ? 1e-4
                                      : 1e-6,
                  form);
    }
  }
}

TEST(FormulaForcesInLoops, AreTheBuiltInOnesWhereTheyAreWrittenSo) {
  Scene built_in = example("four_bar"), by_formula = built_in;
  ForceSpec s = spring("coupler", "");
  s.stiffness = 7;
  s.damping = 0.4;
  s.rest = 0.6;
  ForceSpec pull = torque("O", "");
  pull.value = 1.3;
  built_in.forces = {s, pull};
  by_formula.forces = {spring("coupler", "7 * (length - 0.6) + 0.4 * rate"),
                       torque("O", "1.3 + 0 * u")};
  for (const std::string form : {"momentum", "projected", "stabilised-index2"})
    expect_same(run_of(by_formula, form, 3, 1e-11), run_of(built_in, form, 3, 1e-11), 1e-7, form);
}

/// d/dt (T + V) is the power of the formulas, ∂V/∂t included.
TEST(FormulaForcesInLoops, EnergyBalances) {
  const Scene scene = four_bar_by_formulas();
  for (const std::string form : {"momentum", "acceleration"}) {
    const RunResult r = run_of(scene, form, 3, 1e-12);
    ASSERT_EQ(r.status, "done") << r.reason;
    EXPECT_GT(r.energy_scale, 1);
    EXPECT_LT(r.energy_error_max, 1e-8 * r.energy_scale) << form;
  }
  // of coordinates alone: kept, and nothing is integrated beside it
  Scene kept = example("four_bar");
  kept.forces = {by_law("potential", "sin(2 * A.q) - 3 * cos(O.q)")};
  const RunResult r = run_of(kept, "momentum", 3, 1e-12);
  EXPECT_LT(r.energy_error_max, 1e-8 * r.energy_scale);
}

void expect_exact_jacobians(const Mechanism& mechanism, unsigned seed) {
  const Start start = assemble(mechanism).start;
  for (const std::string& name : form_names()) {
    if (!is_dae_form(name)) continue;
    const auto form = make_form(name, mechanism, {}, start);
    DaeSystem& dae = *form->dae();
    const auto n = static_cast<std::size_t>(dae.size());
    std::vector<double> y(n), ydot(n);
    ASSERT_TRUE(dae.start(start.t, y.data(), ydot.data()));
    RandomTree random(seed);
    for (double& x : y) x += random.uniform(-0.1, 0.1);
    for (double& x : ydot) x += random.uniform(-1, 1);
    const double t = 2.4;  // at other conditions than the start's
    equations::expect_exact_jacobian(dae, t, y, ydot, name);
  }
}

TEST(FormulaForcesInLoops, ExactJacobians) {
  expect_exact_jacobians(Mechanism(four_bar_by_formulas()), 1);
  // From 60 unknowns on the pattern is found at the start, where t is 0 and conditions are others.
  Scene row = row_of_four_bars(9, 1.5, -1);
  const std::string first = row.joints.front().name, last = row.joints.back().name;
  row.forces = {torque(first, "t * sin(" + last + ".q) + if(t < 1, 0, " + last + ".u * q)")};
  expect_exact_jacobians(Mechanism(row), 2);
}

/// Runs that fold bodies and cut elsewhere report the motion of the scene as it is written.
TEST(FormulaForcesInLoops, SameMotionWhateverIsFoldedAndCut) {
  const auto same = [](const Scene& scene, double end, bool anew) {
    const Mechanism mechanism(scene);
    const Start start = assemble(mechanism).start;
    EXPECT_EQ(IntegratedScene(mechanism, start).anew(), anew);
    expect_same(run_of(scene, "momentum", end, 1e-11),
                run_of(scene, "momentum", end, 1e-11, {.cut = CutChoice::scene}), 1e-7, scene.name);
  };
  Scene welded = equations::geared(example("four_bar"), {0.5, 0.2, 0}, 0.4);
  welded.markers = {marker("W", "weight", 0.1)};
  ForceSpec push;
  push.kind = "wrench";
  push.body = "weight";
  push.force_law = {"W.vx", "t", ""};
  welded.forces = {by_law("potential", "3 * W.x^2"), push};
  same(welded, 2, true);
  welded.forces[1].in_body_axes = true;  // the weight's axes stay
  same(welded, 2, true);
  Scene wheel = equations::geared(example("four_bar"), {0.5, 0.2, 0},
                                  0.4);  // the wheel stays, since formulas name its joint
  wheel.forces = {torque("shaft", "-0.1 * u + sin(t)")};
  same(wheel, 2, true);
  wheel.forces = {by_law("potential", "cos(shaft.q)")};
  same(wheel, 2, true);
  Scene measured = equations::geared(example("four_bar"), {0.5, 0.2, 0},
                                     0.4);  // a spring with both ends on one body once it is folded
  ForceSpec gauge = by_law("spring-damper", "");
  gauge.name = "S";
  gauge.parent = "rocker";
  gauge.child = "weight";
  gauge.origin_child = {0.1, 0, 0};
  measured.forces = {gauge, torque("O", "S.length * cos(t)")};
  same(measured, 2, true);
  // Rows cut at random are cut anew, but for the joints that formulas name.
  for (unsigned seed = 0; seed < 3; ++seed) {
    Scene row = equations::at_start(equations::row_of_four_bars(6, 1.1));
    RandomTree random(seed);
    equations::cut_elsewhere(random, row);
    row.forces = {torque(row.joints[5].name, "0.1 * '" + row.joints[7].name + "'.q - 0.02 * u")};
    same(row, 0.5, true);
  }
}

TEST(FormulaForcesInLoops, ManyStatesAreAsOne) {
  const Scene scene = four_bar_by_formulas();
  ClosedChain chain(scene);
  RandomTree random(5);
  constexpr int count = 11;
  StateMatrix q(chain.nq(), count), p(chain.nv(), count), qdot = q, pdot = p;
  for (int i = 0; i < count; ++i)
    for (int k = 0; k < chain.nv(); ++k) {
      q(k, i) = scene.joints[static_cast<std::size_t>(k)].position[0];
      p(k, i) = random.uniform(-1, 1);
    }
  ASSERT_TRUE(chain.rates_of_states(0.3, q, p, qdot, pdot));
  for (int i = 0; i < count; ++i) {
    VectorXd one(chain.nq()), two(chain.nv());
    ASSERT_TRUE(chain.rates(0.3, q.col(i), p.col(i), one, two));
    EXPECT_EQ(one, VectorXd(qdot.col(i)));
    EXPECT_EQ(two, VectorXd(pdot.col(i)));
  }
}

TEST(FormulaForcesInLoops, QuadPrecisionAgrees) {
  for (const Algebra algebra : {Algebra::planar, Algebra::spatial}) {
    const Mechanism mechanism(four_bar_by_formulas(), {.algebra = algebra});
    const auto plain = mechanism.evaluation<double>();
    const auto quad = mechanism.evaluation<Quad>();
    RandomTree random(6);
    const auto n = static_cast<std::size_t>(mechanism.nv());
    std::vector<double> q(n), u(n), tau(n);
    std::vector<Quad> q4(n), u4(n), tau4(n);
    for (std::size_t i = 0; i < n; ++i) {
      q4[i] = q[i] = random.uniform(-1, 1);
      u4[i] = u[i] = random.uniform(-1, 1);
    }
    plain->applied_forces(0.3, q.data(), u.data(), tau.data());
    quad->applied_forces(0.3, q4.data(), u4.data(), tau4.data());
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(tau[i], value_of(tau4[i]), 1e-13);
  }
}

TEST(FormulaForcesInLoops, SmallMotionsOfPotentialsAreThoseOfSprings) {
  Scene springs = example("four_bar"), formulas = springs;
  ForceSpec s = spring("coupler", "");
  s.stiffness = 90;
  s.damping = 0.4;
  s.rest = 0.6;
  springs.forces = {s};
  ForceSpec damper = spring("coupler", "");
  damper.damping = 0.4;
  damper.name = "S";
  formulas.forces = {damper, by_law("potential", "45 * (S.length - 0.6)^2")};
  const auto modes = [](const Scene& scene) {
    const Mechanism mechanism(scene);
    return find_modes(mechanism, assemble(mechanism).start, {});
  };
  const ModesResult a = modes(springs), b = modes(formulas);
  ASSERT_EQ(a.spectrum.modes.size(), b.spectrum.modes.size());
  ASSERT_FALSE(a.spectrum.modes.empty());
  for (std::size_t i = 0; i < a.spectrum.modes.size(); ++i)
    EXPECT_LE(std::abs(a.spectrum.modes[i].s - b.spectrum.modes[i].s),
              1e-6 * std::abs(a.spectrum.modes[i].s));
}

TEST(FormulaForcesInLoops, TheIndexStays) {
  const Mechanism mechanism(four_bar_by_formulas());
  const Mechanism without(example("four_bar"));
  const auto indices = [](const Mechanism& m) {
    std::vector<int> all;
    for (const FormIndex& f : run_index_study(m, assemble(m).start, {}).forms)
      all.push_back(f.dae ? f.found.index : 0);
    return all;
  };
  EXPECT_EQ(indices(mechanism), indices(without));
}

TEST(FormulaForcesInLoops, WithoutAValueAtTheStartAreTold) {
  const auto sentence = [](const std::string& force) {
    const Mechanism rod(
        parse_scene("gravity = [0, -9.81, 0]\n[[body]]\nname = \"rod\"\nmass = 1\n"
                    "shape = { kind = \"rod\", length = 1 }\n[[joint]]\nname = "
                    "\"O\"\nkind = \"revolute\"\nchild = \"rod\"\naxis = \"z\"\n"
                    "[[marker]]\nname = \"P\"\nbody = \"rod\"\n[[force]]\n" +
                        force,
                    "rod.toml"));
    return sentence_of([&] { (void)assemble(rod); });
  };
  const std::string potential = "kind = \"potential\"\nV = ", root = "sqrt(P.x^2 + P.y^2)",
                    slope =
                        ", or a derivative of it, is not finite at the start, and sqrt and hypot "
                        "have no slope at 0; expected another start, or sqrt(x^2 + e^2) with a "
                        "small e";
  EXPECT_EQ(sentence(potential + "\"" + root + "\"\n"),
            "rod.toml:14:1: force of kind 'potential': V" + slope);
  EXPECT_EQ(sentence("name = \"pull\"\n" + potential + "\"2*hypot(P.x, P.y)\"\n"),
            "rod.toml:14:1: force 'pull': V" + slope);
  EXPECT_EQ(
      sentence("kind = \"torque\"\njoint = \"O\"\nlaw = \"log(q)\"\n"),
      "rod.toml:14:1: force of kind 'torque': law, or a derivative of it, is not finite at the "
      "start; expected a start where it has a value");
  // What the sentence advises has a slope.
  const Mechanism smooth(parse_scene(
      "[[body]]\nname = \"rod\"\nmass = 1\nshape = { kind = \"rod\", length = 1 }\n[[joint]]\nname "
      "= \"O\"\nkind = \"revolute\"\nchild = \"rod\"\naxis = \"z\"\n[[marker]]\nname = "
      "\"P\"\nbody = \"rod\"\n[[force]]\nkind = \"potential\"\nV = \"sqrt(P.x^2 + P.y^2 + "
      "1e-6)\"\n"));
  EXPECT_EQ(assemble(smooth).start.udot, VectorXd::Zero(1));
}

TEST(FormulaForcesInLoops, DrivesByFormulaAreTheBuiltInOnes) {
  Scene harmonic = example("driven"), formula = harmonic;
  ASSERT_EQ(harmonic.drives.front().kind, "harmonic");
  DriveSpec& d = formula.drives.front();
  d.kind = "formula";
  const auto number = [](double x) { return "(" + std::to_string(x) + ")"; };
  for (double* x : {&harmonic.drives.front().offset, &harmonic.drives.front().amplitude,
                    &harmonic.drives.front().frequency, &harmonic.drives.front().phase})
    *x = std::stod(std::to_string(*x));
  const DriveSpec& h = harmonic.drives.front();
  d.law = number(h.offset) + " + " + number(h.amplitude) + " * sin(" + number(h.frequency) +
          " * t + " + number(h.phase) + ")";
  for (const std::string form : {"momentum", "acceleration", "acceleration-index2"})
    expect_same(run_of(formula, form, 2, 1e-10), run_of(harmonic, form, 2, 1e-10), 1e-7, form);
}

}  // namespace
}  // namespace momenta::dae_formula_forces
