// The adjoint of runs: against tangents of the same runs, against products with a matrix of
// derivatives that is made column by column, and against runs in quadruple precision.

#include <gtest/gtest.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/dae/gradient/acceleration_adjoint.h>
#include <momenta/dae/gradient/form_tangents.h>
#include <momenta/dae/gradient/recorded_run.h>
#include <momenta/dae/gradient/stage_adjoint.h>
#include <momenta/dae/gradient/start_adjoint.h>
#include <momenta/dae/integrator/butcher_tableau.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <cmath>
#include <optional>
#include <tuple>

#include "equations/gradient_runs.h"
#include "equations/gradient_twin.h"
#include "equations/linkages.h"
#include "equations/refusal.h"

namespace momenta::dae_adjoint {
namespace {

using Eigen::Index;
using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using equations::asked, equations::driven, equations::four_bar, equations::of_scene,
    equations::of_text;

SceneText example(const std::string& path) {
  return of_text(reading::text_of(MOMENTA_SOURCE_DIR "/examples/" + path));
}

/// The four-bar without its spring, whose joint O rubs.
std::string rubbed_four_bar() {
  std::string text = four_bar;
  const std::size_t force = text.find("[[force]]");
  text.erase(force, text.find("[[marker]]") - force);
  return text.insert(text.find("velocity = 0.7"), "damping = 0.3\nfriction = 0.2\n");
}

/// Scenes of every kind of force that an adjoint takes.
std::vector<std::pair<std::string, SceneText>> scenes() {
  return {{"four-bar with a spring and a damper", of_text(four_bar)},
          {"four-bar that rubs", of_text(rubbed_four_bar())},
          {"driven", of_text(driven())},
          {"chain", example("chain/scene.toml")},
          {"slider-crank", example("slider_crank/scene.toml")},
          {"Andrews", example("andrews/scene.toml")},
          {"Bricard", example("bricard/scene.toml")},
          {"spatial slider-crank", example("spatial_slider_crank/scene.toml")},
          {"motor", example("motor/scene.toml")},
          {"spring pendulum", example("extremes/spring_pendulum.toml")},
          {"double pendulum by formulas", example("lagrangian/double_pendulum.toml")}};
}

/// The form at its start, pushed off it, with what is needed to differentiate it there.
struct AtAState {
  /// `leaves`: q is pushed off the loops too, where these are not redundant.
  AtAState(const SceneText& scene, const FormOptions& options, Index directions, bool leaves,
           const std::string& form_name = "momentum")
      : mechanism(scene.scene(), scene.options),
        start(assemble(mechanism).start),
        form(make_form(form_name, mechanism, options, start)),
        others(static_cast<std::size_t>(directions)) {
    y = form->ode() ? ode().initial(start) : std::vector<double>();
    ode().begin_step(0, y.data());
    srand(5);
    const VectorXd away = VectorXd::Random(static_cast<Index>(y.size()));
    for (std::size_t i = leaves ? 0 : static_cast<std::size_t>(mechanism.nq()); i < y.size(); ++i)
      y[i] +=
          1e-2 * (std::abs(y[i]) + 0.1 * size(static_cast<int>(i))) * away[static_cast<Index>(i)];
  }
  OdeForm& ode() { return dynamic_cast<OdeForm&>(*form); }
  /// Of rates and momenta at 1/s, however fast the mechanism is.
  double size(int i) { return ode().scale(i) * (i < mechanism.nq() ? 1 : ode().time_scale()); }
  AdjointState state() {
    const Index n = mechanism.nv();
    return {0, Map<const VectorXd>(y.data(), n), Map<const VectorXd>(y.data() + n, n),
            Map<const VectorXd>(ode().rates().data(), n),
            Map<const VectorXd>(ode().multipliers().data(), mechanism.m())};
  }

  Mechanism mechanism;
  Start start;
  std::unique_ptr<Form> form;
  std::vector<OtherParameter> others;
  std::vector<double> y;
};

FormOptions gauge(Gauge::Kind kind, double kappa = 0, double beta = 0) {
  FormOptions options;
  options.gauge.kind = kind;
  options.gauge.kappa = kappa;
  options.beta = beta;
  return options;
}

TEST(Adjoint, OfTheRightHandSideIsItsDerivativeTransposed) {
  int swept = 0;
  for (const FormOptions& options : {gauge(Gauge::Kind::none), gauge(Gauge::Kind::leak, 3, 7)})
    for (const auto& [name, scene] : scenes()) {
      const Mechanism sizes(scene.scene(), scene.options);
      const Index size = sizes.nq() + sizes.nv();
      AtAState at(scene, options, size, name != "Bricard");
      std::vector<double> f(at.y.size());
      ASSERT_TRUE(at.ode().rhs(0, at.y.data(), f.data())) << at.ode().failure();
      FormTangents tangents(at.mechanism, at.ode(), at.others);
      tangents.by_rows();  // by its own way
      MatrixXd fy;
      ASSERT_TRUE(tangents.rates(0, at.y.data(), f.data(), MatrixXd::Identity(size, size), fy));
      const std::vector<OtherParameter> none;
      StageAdjoint adjoint(at.mechanism, at.ode(), none);
      const VectorXd w = VectorXd::Random(size);
      VectorXd product, by_nothing;
      // By the sweeps, where they carry the mechanism and let no row fade, and by rows.
      if (at.ode().pivots().faded > 0) adjoint.by_rows();
      for (int way = 0; way < 2; ++way) {
        swept += adjoint.swept();
        ASSERT_TRUE(adjoint.rates(at.state(), w, product, by_nothing));
        const VectorXd expected = fy.transpose() * w;
        for (Index i = 0; i < size; ++i)
          EXPECT_NEAR(product[i], expected[i],
                      1e-12 * (fy.col(i).cwiseAbs().dot(w.cwiseAbs()) + 1e-3 * expected.norm()))
              << name << ", " << i << (adjoint.swept() ? ", swept" : "");
        adjoint.by_rows();
      }
    }
  EXPECT_GE(swept, 7);
}

TEST(Adjoint, OfWhatIsDoneAfterAStepIsItsDerivativeTransposed) {
  int swept = 0;
  for (const Gauge::Kind kind : {Gauge::Kind::reset, Gauge::Kind::flip})
    for (const auto& [name, scene] : scenes()) {
      FormOptions options = gauge(kind);
      options.project = true;
      const Mechanism sizes(scene.scene(), scene.options);
      if (sizes.m() == 0) continue;
      const Index size = sizes.nq() + sizes.nv(), n = sizes.nv();
      AtAState at(scene, options, size, name != "Bricard");
      std::vector<double> after = at.y;
      bool changed = false;
      ASSERT_TRUE(at.ode().after_step(0, after.data(), changed)) << at.ode().failure();
      FormTangents tangents(at.mechanism, at.ode(), at.others);
      MatrixXd Y = MatrixXd::Identity(size, size);
      ASSERT_TRUE(tangents.after_step(0, at.y.data(), after.data(), Y));
      AdjointState state = at.state();
      state.q = Map<const VectorXd>(after.data(), n);
      if (kind == Gauge::Kind::flip) state.sigma = -state.sigma;
      const std::vector<OtherParameter> none;
      StageAdjoint adjoint(at.mechanism, at.ode(), none);
      const VectorXd w = VectorXd::Random(size);
      VectorXd by_nothing;
      const VectorXd expected = Y.transpose() * w;
      if (at.ode().pivots().faded > 0) adjoint.by_rows();
      for (int way = 0; way < 2; ++way) {
        VectorXd lambda = w;
        swept += adjoint.swept();
        ASSERT_TRUE(adjoint.gauge(state, lambda, by_nothing));
        ASSERT_TRUE(adjoint.correction(0, Map<const VectorXd>(at.y.data(), n), lambda, by_nothing));
        for (Index i = 0; i < size; ++i)
          EXPECT_NEAR(lambda[i], expected[i],
                      1e-11 * (Y.col(i).cwiseAbs().dot(w.cwiseAbs()) + 1e-2 * expected.norm()))
              << name << ", " << i << (adjoint.swept() ? ", swept" : "");
        adjoint.by_rows();
      }
    }
  EXPECT_GE(swept, 6);
}

/// Both modes, every derivative, times the size of its variable, within a part of the value, of the
/// largest of them, and of `whole`, of what the functional is a part of. Steps with error control
/// follow all tangents forward, and one before a sweep back: up to the tolerance.
void expect_same(const SceneText& scene, GradientRequest request, double within, double whole = 0) {
  request.mode = GradientMode::forward;
  const GradientResult forward = gradient(scene, request);
  request.mode = GradientMode::adjoint;
  const GradientResult adjoint = gradient(scene, request);
  EXPECT_FALSE(forward.adjoint);
  EXPECT_TRUE(adjoint.adjoint);
  const bool own_steps = forward.settings.step == 0;
  if (own_steps) within = 1e3 * forward.settings.rtol;
  if (!own_steps) {
    EXPECT_EQ(forward.steps, adjoint.steps);
  }
  EXPECT_NEAR(forward.value, adjoint.value,
              (own_steps ? within : 1e-13) * (1 + std::abs(forward.value)));
  double largest = whole + std::abs(forward.value);
  for (std::size_t j = 0; j < forward.variables.size(); ++j)
    largest = std::max(
        largest, std::abs(forward.gradient[static_cast<Index>(j)]) * forward.variables[j].size);
  ASSERT_GT(forward.gradient.norm(), 0);
  for (std::size_t j = 0; j < forward.variables.size(); ++j) {
    const auto at = static_cast<Index>(j);
    EXPECT_NEAR(forward.gradient[at] * forward.variables[j].size,
                adjoint.gradient[at] * forward.variables[j].size, within * largest)
        << request.of << " by " << forward.variables[j].name << ", " << request.settings.gauge
        << ", " << request.settings.integrator;
  }
}

const std::vector<std::string> all_of_four_bar{"g", "crank", "coupler", "mass",
                                               "k", "O.q",   "O.u",     "body.rocker.mass"};

TEST(Adjoint, IsTheForwardGradientInEveryGauge) {
  // Without the damper stages need no solution of (7) before the sweeps, and are not computed
  // again.
  std::string undamped = four_bar;
  undamped.replace(undamped.find("damping = 0.4"), 13, "damping = 0.0");
  const std::vector<std::string> inertial{"g", "mass", "O.q", "O.u", "body.rocker.mass"};
  for (const auto& [scene, by] :
       {std::pair{of_text(four_bar), all_of_four_bar}, std::pair{of_text(undamped), inertial}})
    for (const char* rule : {"none", "reset", "flip", "leak:3"})
      for (const bool project : {false, true}) {
        GradientRequest request = asked("P.x + 0.3*C.u^2 - P.vy", by, "momentum", rule, 0.5, 0.01);
        request.settings.project = project;
        expect_same(scene, request, 1e-12);
        request.settings.beta = 20;
        expect_same(scene, request, 1e-12);
      }
  // Losses of joints alone: of dampers Q_u is constant, of friction it asks for u.
  const std::string rate = "velocity = 0.7\n";
  for (const char* losses : {"damping = 0.4\n", "damping = 0.4\nfriction = 0.2\n"}) {
    std::string lossy = undamped;
    lossy.replace(lossy.find(rate), rate.size(), rate + losses);
    for (const char* rule : {"none", "reset", "flip"})
      expect_same(of_text(lossy),
                  asked("P.x + 0.3*C.u^2 - P.vy", {"mass", "O.u", "joint.O.damping"}, "momentum",
                        rule, 0.5, 0.01),
                  1e-12);
  }
}

TEST(Adjoint, IsTheForwardGradientOfEveryMethodAndOfIntegrals) {
  const SceneText scene = of_text(four_bar);
  for (const char* method : {"rk4", "dp5", "dop853", "vern9"})
    for (const bool integral : {false, true}) {
      GradientRequest request =
          asked("(P.x - 0.5*crank)^2 + t*O.u", all_of_four_bar, "momentum", "reset", 0.5, 0.01);
      request.settings.integrator = method;
      request.settings.project = true;
      request.integral = integral;
      expect_same(scene, request, 1e-12);
      if (request.settings.integrator == "rk4") continue;
      request.settings.step = 0;
      request.settings.rtol = request.settings.atol = 1e-7;
      GradientRequest forward = request;
      forward.mode = GradientMode::forward;
      if (gradient(scene, forward).steps > 1) expect_same(scene, request, 1e-11);
    }
}

struct TableRow {
  const char *scene, *of;
  std::vector<std::string> by;
  double end, step;
  double whole = 0;
};

/// The scenes of docs/theory/gradients.md, section 5. Of the chain's last angle, which hardly moves
/// at first, in radians.
std::vector<TableRow> table() {
  return {{"chain/scene.toml", "J9.q", {"gravity.1", "J1.q"}, 0.5, 0.005, 1},
          {"four_bar/scene.toml", "B.y", {"body.rocker.mass", "O.u"}, 0.5, 0.01},
          {"slider_crank/scene.toml", "B.x", {"body.rod.mass"}, 0.2, 0.01},
          {"andrews/scene.toml",
           "O.q",
           {"body.crank.mass", "loop.E4.origin.child.1", "loop.E6.origin.child.0"},
           0.003,
           0.0001},
          {"bricard/scene.toml", "P3.y", {"body.rod1.mass", "gravity.1"}, 0.3, 0.02},
          {"spatial_slider_crank/scene.toml", "S.q", {"body.rod.mass"}, 0.3, 0.005},
          {"driven/scene.toml", "tip.x", {"M.q"}, 0.4, 0.01},
          {"extremes/spring_pendulum.toml", "bob.y", {"joint.spring.stiffness"}, 0.2, 0.002}};
}

TEST(Adjoint, IsTheForwardGradientOfTheScenesOfTheTable) {
  for (const TableRow& row : table())
    for (const char* rule : {"none", "reset"})
      expect_same(example(row.scene), asked(row.of, row.by, "momentum", rule, row.end, row.step),
                  1e-12, row.whole);
}

TEST(Adjoint, IsThatOfQuadruplePrecision) {
  std::string text = four_bar;
  text.replace(text.find("velocity = 0.7"), 14, "velocity = 0.0");
  text.replace(text.find("damping = 0.4"), 13, "damping = 0.0");  // lengths are taken at once
  const SceneText scene = of_text(text);
  const std::vector<std::string> by{"crank", "coupler", "mass", "k", "g"};
  const Mechanism own(scene.scene(), scene.options);
  for (const char* rule : {"reset", "none"}) {
    GradientRequest request = asked("C.q", by, "momentum", rule, 0.4, 0.01);
    request.mode = GradientMode::adjoint;
    const GradientResult r = gradient(scene, request);
    EXPECT_EQ(r.at_once, 5);
    for (std::size_t j = 0; j < by.size(); ++j) {
      const RunVariable& v = r.variables[j];
      const VectorXd exact = equations::differenced(
          [&](double value) {
            const Mechanism other(scene.scene({{v.name, value}}), scene.options);
            const Start start = assemble(other, 0, other.tree().q0, VectorXd::Zero(3)).start;
            const auto y = equations::QuadRun(other, std::string(rule) == "reset", 0, 1e-20)(
                start.q, 0.01, 40);
            VectorXd numbers(static_cast<Index>(y.size()));
            for (std::size_t i = 0; i < y.size(); ++i)
              numbers[static_cast<Index>(i)] = value_of(y[i]);
            return numbers;
          },
          v.value, v.size / 256);
      EXPECT_NEAR(r.gradient[static_cast<Index>(j)], exact[2],
                  1e-10 * (1 / v.size + std::abs(exact[2])))
          << v.name;
    }
  }
}

TEST(Adjoint, TakesAsManyProductsWhateverTheNumberOfParameters) {
  const SceneText scene = of_text(four_bar);
  GradientRequest request = asked("P.x", {"mass"}, "momentum", "reset", 0.5, 0.01);
  request.mode = GradientMode::adjoint;
  const GradientResult of_one = gradient(scene, request);
  request.by = all_of_four_bar;
  const GradientResult of_all = gradient(scene, request);
  EXPECT_EQ(of_one.products, 4 * of_one.steps + 1);
  EXPECT_EQ(of_all.products, of_one.products);
  request.mode = GradientMode::automatic;
  EXPECT_FALSE(gradient(scene, request).adjoint);
  request.by.push_back("idle");
  EXPECT_TRUE(gradient(scene, request).adjoint);
}

const std::string bushing = R"toml(
[[force]]
name = "G"
kind = "bushing"
parent = "crank"
child = "rocker"
origin = { parent = [0.2, 0.1, 0], child = [0.3, 0, 0] }
stiffness = 3
damping = 0.7
rotational_damping = 0.4
)toml";

TEST(Adjoint, TakesInertiasAndGravityAtOnce) {
  const std::vector<std::string> inertias{"g", "mass", "body.crank.mass", "body.rocker.mass"};
  for (const char* rule : {"none", "reset", "flip", "leak:3"}) {
    GradientRequest request = asked("P.x + 0.3*C.u^2", inertias, "momentum", rule, 0.5, 0.01);
    request.settings.project = true;
    request.mode = GradientMode::adjoint;
    EXPECT_EQ(gradient(of_text(four_bar), request).at_once, 4);
    expect_same(of_text(four_bar), request, 1e-12);
    request =
        asked("tip.x + 0.1*M.u", {"body.pendulum.mass", "swing"}, "momentum", rule, 0.4, 0.02);
    request.settings.project = true;
    expect_same(of_text(driven()), request, 1e-12);
  }
  // In space, and with products and centres of mass.
  std::string text = reading::text_of(MOMENTA_SOURCE_DIR "/examples/bricard/scene.toml");
  GradientRequest request = asked("P3.y + 0.1*P3.vx", {"gravity.0", "gravity.1", "gravity.2"},
                                  "momentum", "reset", 0.3, 0.02);
  for (const BodySpec& body : of_text(text).scene().bodies)
    request.by.push_back("body." + body.name + ".mass");
  request.mode = GradientMode::adjoint;
  const GradientResult r = gradient(of_text(text), request);
  EXPECT_EQ(r.at_once, static_cast<long>(request.by.size()));
  expect_same(of_text(text), request, 1e-12);
  // Places are taken from rows where there are bushings, springs are not.
  request = asked("P.x", {"crank", "k", "idle", "O.q"}, "momentum", "reset");
  request.mode = GradientMode::adjoint;
  EXPECT_EQ(gradient(of_text(four_bar + bushing), request).at_once, 2);
  EXPECT_EQ(gradient(of_text(four_bar), request).at_once, 3);
}

/// A four-bar in a plane, with forces of every kind that numbers are taken of at once.
std::string sprung_four_bar() {
  std::string text = four_bar;
  const auto put = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  put("damping = 0.4\n", "name = \"S\"\n");
  put("velocity = 0.7\n",
      "velocity = 0.7\nstiffness = 3\nrest = 0.2\ndamping = 0.4\nfriction = 0.2\n"
      "rotor_inertia = 0.1\n");
  return text + R"toml(
[[force]]
name = "T"
kind = "torque"
joint = "C"
value = 1.5
[[force]]
name = "sum"
kind = "coordinate-spring"
joints = ["O", "A"]
ratios = [1, 0.5]
stiffness = 2
damping = 0.3
rest = 0.2
)toml";
}

/// A chain on a line of given length, with a slide, a coupler, and a turned joint.
const std::string slide_and_coupler = R"toml(
name = "slide and coupler"
gravity = [0, -9.81, 0]
[parameters]
turn = 0.3
[[body]]
name = "a"
mass = 1
com = [0.3, 0.1, 0]
inertia = 0.1
[[body]]
name = "b"
mass = 2
com = [0.1, -0.05, 0]
inertia = 0.2
[[body]]
name = "c"
mass = 2
com = [0.2, 0, 0]
inertia = 0.2
[[joint]]
name = "J"
kind = "revolute"
child = "a"
origin = { parent = [0.1, 0, 0], child = [-0.1, 0.02, 0] }
position = 0.3
velocity = 0.4
[[joint]]
name = "W"
kind = "prismatic"
parent = "a"
child = "b"
axis = [0.9, 0.1, 0]
rotation = { axis = "z", angle = "turn" }
origin = { parent = [0.4, 0.1, 0], child = [0, 0, 0] }
position = 0.2
[[joint]]
name = "K"
kind = "revolute"
parent = "b"
child = "c"
origin = { parent = [0.2, 0.1, 0], child = [0, 0, 0] }
position = 0.2
[[loop]]
name = "D"
kind = "distance"
parent = "ground"
child = "c"
origin = { parent = [1.3, 0.4, 0], child = [0.4, 0.05, 0] }
length = 1.1
[[loop]]
name = "Q"
kind = "coupler"
joints = ["J", "K"]
ratios = [1, 0.7]
offset = 0.1
)toml";

/// In space: a tree of several kinds of joints and two loops of points, axes and a distance.
const std::string in_space = R"toml(
name = "in space"
gravity = [0, 0, -9.81]
[parameters]
tilt = 0.4
end_tilt = 0.2
[[body]]
name = "a"
mass = 1
com = [0.3, 0.1, 0]
inertia = [0.1, 0.12, 0.13]
[[body]]
name = "b"
mass = 2
com = [0.1, -0.05, 0.03]
inertia = [0.1, 0.12, 0.13]
[[body]]
name = "c"
mass = 2
com = [0.2, 0, 0.1]
inertia = [0.1, 0.12, 0.13]
[[body]]
name = "d"
mass = 2
com = [0.2, 0, 0.1]
inertia = [0.1, 0.12, 0.13]
[[joint]]
name = "J1"
kind = "revolute"
child = "a"
axis = "y"
origin = { parent = [0.1, 0, 0.2], child = [-0.1, 0.02, 0] }
position = 0.3
velocity = 0.4
rotor_inertia = 0.3
[[joint]]
name = "J2"
kind = "cylindrical"
parent = "a"
child = "b"
axis = [0.9, 0.1, 0.2]
rotation = { axis = "z", angle = "tilt" }
origin = { parent = [0.6, 0.1, 0.1], child = [0, 0.05, 0] }
position = [0.2, 0.1]
[[joint]]
name = "J3"
kind = "revolute"
parent = "b"
child = "c"
axis = "x"
origin = { parent = [0.5, 0.1, 0], child = [0, 0, 0] }
position = 0.2
friction = 0.2
[[joint]]
name = "J4"
kind = "universal"
parent = "c"
child = "d"
axis = "y"
axis2 = "z"
origin = { parent = [0.5, 0.1, 0.1], child = [0, 0, 0] }
position = [0.2, 0.1]
[[loop]]
name = "D"
kind = "distance"
parent = "ground"
child = "c"
origin = { parent = [1.3, 0.4, 1], child = [0.4, 0.05, 0.1] }
length = 1.2
[[loop]]
name = "L"
kind = "universal"
parent = "ground"
child = "d"
axis = "y"
axis2 = "z"
rotation = { axis = "x", angle = "end_tilt" }
origin = { parent = [2.1, 0.95, -0.1], child = [0.4, 0.05, 0.1] }
[[force]]
name = "S"
kind = "spring-damper"
parent = "a"
child = "c"
origin = { parent = [0, 1, 0], child = [0.3, 0, 0.1] }
stiffness = 20
rest = 0.3
)toml";

std::string with(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

/// A damper with a dead band and stops across a four-bar, and wrenches in both axes.
std::string pushed_four_bar() {
  return with(four_bar, "rest = 0.6\n",
              "rest = 0.6\nname = \"S\"\ndead_band = 0.2\nlimits = [0.5, 1.0]\n"
              "stop_stiffness = 40\nstop_damping = 3\nstop_width = 0.3\n") +
         R"toml(
[[force]]
name = "W"
kind = "wrench"
body = "coupler"
point = [0.7, 0.2, 0]
force = [3, -2, 0]
torque = [0, 0, 0.5]
[[force]]
name = "V"
kind = "wrench"
body = "rocker"
point = [0.5, 0.1, 0]
force = [1, 2, 0]
torque = [0, 0, -0.4]
axes = "body"
)toml";
}
std::string pushed_in_space() {
  return with(in_space, "rest = 0.3\n", "rest = 0.3\ndamping = 2\n") + R"toml(
[[force]]
name = "W"
kind = "wrench"
body = "b"
point = [0.7, 0.2, 0.1]
force = [3, -2, 1]
torque = [0.2, 0.3, 0.5]
[[force]]
name = "V"
kind = "wrench"
body = "d"
point = [0.5, 0.1, -0.2]
force = [1, 2, -1]
torque = [0.1, 0.2, -0.4]
axes = "body"
)toml";
}
/// A tree in space whose first joint moves by a formula.
std::string driven_in_space() {
  const std::string tree =
      in_space.substr(0, in_space.find("[[loop]]")) + in_space.substr(in_space.find("[[force]]"));
  return with(with(tree, "position = 0.3\nvelocity = 0.4\n", ""), "end_tilt = 0.2",
              "end_tilt = 0.2\namp = 0.7\nfast = 3") +
         R"toml(
[[drive]]
joint = "J1"
kind = "formula"
law = "0.3 + amp*sin(fast*t + 0.2)"
)toml";
}

TEST(Adjoint, TakesLengthsSpringsAndPlacesAtOnce) {
  struct Row {
    std::string text, of;
    std::vector<std::string> by;
    double step;
    std::optional<long> on_accelerations = {};  ///< how many are taken at once there, if not all
  };
  for (const Row& row : std::vector<Row>{
           {sprung_four_bar(),
            "P.x + 0.3*C.u^2",
            {"crank", "coupler", "rocker", "k", "mass", "joint.O.stiffness", "joint.O.rest",
             "joint.O.damping", "joint.O.friction", "joint.O.rotor_inertia", "force.S.rest",
             "force.S.stiffness", "force.S.origin.parent.0", "force.S.origin.child.1",
             "force.T.value", "force.sum.stiffness", "force.sum.damping", "force.sum.rest",
             "joint.C.origin.parent.1"},
            0.01},
           {slide_and_coupler,
            "J.q + 0.1*W.u",
            {"turn", "loop.D.length", "loop.Q.offset", "loop.D.origin.parent.0",
             "loop.D.origin.child.1", "joint.J.origin.child.0", "joint.W.origin.parent.1",
             "joint.K.origin.parent.0", "body.b.com.0"},
            0.01},
           {in_space,
            "J2.q1 + 0.1*J1.u",
            {"tilt", "end_tilt", "joint.J2.origin.parent.2", "joint.J2.origin.child.1",
             "joint.J4.origin.parent.1", "loop.L.origin.child.2", "loop.L.origin.parent.0",
             "loop.D.length", "loop.D.origin.child.0", "force.S.origin.child.0",
             "force.S.stiffness", "joint.J1.rotor_inertia", "joint.J3.friction"},
            0.01},
           {reading::text_of(MOMENTA_SOURCE_DIR "/examples/chain/scene.toml"),
            "J9.q",
            {"joint.J3.origin.parent.0", "joint.J7.origin.parent.1", "body.rod5.mass"},
            0.005},
           {pushed_four_bar(),
            "P.x + 0.3*C.u^2",
            {"crank", "coupler", "rocker", "k", "mass", "force.S.rest", "force.S.damping",
             "force.S.origin.parent.0", "force.S.origin.child.1", "force.W.force.0",
             "force.W.point.1", "force.W.torque.2", "force.V.force.1", "force.V.point.0",
             "force.V.torque.2", "joint.C.origin.parent.1", "loop.B.origin.child.1"},
            0.01,
            1},
           {pushed_in_space(),
            "J2.q1 + 0.1*J1.u",
            {"tilt", "end_tilt", "joint.J2.origin.parent.2", "joint.J4.origin.parent.1",
             "loop.L.origin.child.2", "loop.D.length", "force.S.damping", "force.S.origin.child.0",
             "force.W.force.2", "force.W.point.0", "force.W.torque.1", "force.V.force.0",
             "force.V.point.2", "force.V.torque.0"},
            0.01,
            1},
           {four_bar + bushing,
            "P.x + 0.3*C.u^2",
            {"force.G.stiffness", "force.G.damping", "force.G.rotational_damping", "mass", "k"},
            0.01,
            2},
           {with(in_space + bushing, "parent = \"crank\"\nchild = \"rocker\"",
                 "rotational_stiffness = 2\nparent = \"a\"\nchild = \"c\""),
            "J2.q1 + 0.1*J1.u",
            {"force.G.stiffness", "force.G.damping", "force.G.rotational_damping",
             "force.G.rotational_stiffness"},
            0.01,
            0},
           {with(with(driven(), "frequency = 2.0", "frequency = \"fast\""), "swing = 2.5",
                 "swing = 2.5\nfast = 2.0"),
            "tip.x + 0.1*M.u",
            {"swing", "fast", "long", "body.coupler.mass", "joint.M.origin.parent.0",
             "loop.B.origin.child.0"},
            0.02,
            0},
           {driven_in_space(),
            "J2.q1 + 0.1*J3.u",
            {"amp", "fast", "tilt", "joint.J2.origin.parent.2", "force.S.stiffness",
             "joint.J1.rotor_inertia"},
            0.01,
            0}}) {
    for (const auto& [rule, project, beta] : {std::tuple{"none", false, 0.0},
                                              {"reset", true, 0.0},
                                              {"flip", true, 20.0},
                                              {"leak:3", false, 5.0}}) {
      GradientRequest request = asked(row.of, row.by, "momentum", rule, 4 * row.step, row.step);
      request.settings.project = project;
      request.settings.beta = beta;
      request.mode = GradientMode::adjoint;
      EXPECT_EQ(gradient(of_text(row.text), request).at_once, static_cast<long>(row.by.size()));
      expect_same(of_text(row.text), request, 1e-12, 1);
    }
    for (const auto& [form, project] :
         {std::pair{"acceleration", false}, {"projected", true}, {"baumgarte", true}}) {
      GradientRequest request = asked(row.of, row.by, form, "", 4 * row.step, row.step);
      request.settings.project = project;
      request.mode = GradientMode::adjoint;
      EXPECT_EQ(gradient(of_text(row.text), request).at_once,
                row.on_accelerations.value_or(static_cast<long>(row.by.size())));
      expect_same(of_text(row.text), request, 1e-12, 1);
    }
  }
}

TEST(Adjoint, SweepsStagesApartWhereASpringHasNoLength) {
  // At the start, one stage of those that are swept side by side: in all, two steps of four.
  const std::string text = R"toml(
name = "through the spring's end"
gravity = [1, -9.81, 0]
[[body]]
name = "slide"
mass = 2
inertia = 0.1
[[body]]
name = "bob"
mass = 1
com = [0.4, 0, 0]
inertia = 0.2
[[joint]]
name = "X"
kind = "prismatic"
child = "slide"
axis = "x"
velocity = 1
[[joint]]
name = "C"
kind = "revolute"
parent = "slide"
child = "bob"
axis = "z"
origin = { child = [0.1, 0, 0] }
[[force]]
name = "S"
kind = "spring-damper"
parent = "ground"
child = "slide"
stiffness = 200
rest = 0.3
)toml";
  GradientRequest request =
      asked("X.q + 0.3*C.u", {"force.S.stiffness", "force.S.rest", "body.slide.mass"}, "momentum",
            "none", 0.02, 0.01);
  request.integral = true;
  expect_same(of_text(text), request, 1e-12);
  request.by.push_back("joint.C.origin.child.0");
  request.mode = GradientMode::adjoint;
  EXPECT_EQ(gradient(of_text(text), request).at_once, 4);
  expect_same(of_text(text), request, 1e-12);
  // Stages in front of a dead band, in its corner, within and beyond; at ten times the step half of
  // it gives another derivative.
  request.settings.step = 0.001;
  expect_same(of_text(with(with(text, "velocity = 1\n", "position = 0.001\nvelocity = 1\n"),
                           "rest = 0.3\n", "rest = 0.006\ndead_band = 0.008\n")),
              request, 1e-12);
}

TEST(Adjoint, KeepsNumbersWhereTheyAre) {
  StepArena kept;
  std::vector<std::pair<double*, std::size_t>> rows;
  const std::size_t counts[] = {3, 1000, 1, 70000, 8192, 300000, 5};
  for (std::size_t i = 0; i < 30; ++i) {
    const std::size_t count = counts[i % std::size(counts)];
    rows.emplace_back(kept.next(count), count);
    std::fill_n(rows.back().first, count, static_cast<double>(i));
  }
  for (std::size_t i = 0; i < rows.size(); ++i)
    EXPECT_TRUE(std::all_of(rows[i].first, rows[i].first + rows[i].second, [&](double x) {
      return x == static_cast<double>(i);
    })) << i;
}

/// Against the derivatives of all applied forces.
TEST(Adjoint, HasLossesAlongLinesInTwoSweeps) {
  const auto damped = [](std::string text) {
    text.replace(text.find("rest = 0.3\n"), 11, "rest = 0.3\ndamping = 0.7\n");
    return text;
  };
  std::string stopped = sprung_four_bar();
  stopped.replace(stopped.find("rest = 0.6\n"), 11,
                  "rest = 0.6\ndamping = 0.3\nlimits = [0.1, 0.3]\nstop_stiffness = 50\n"
                  "stop_damping = 3\n");
  int skew_ones = 0;
  for (const std::string& text : {std::string(four_bar), stopped, damped(in_space)}) {
    const Mechanism mechanism(of_text(text).scene(), {});
    const std::unique_ptr<LineLosses> losses = make_line_losses(mechanism);
    ASSERT_TRUE(losses && losses->any() && losses->at_state()) << text;
    TransposedForces twin(mechanism);
    srand(7);
    const Index n = mechanism.nv();
    const VectorXd q = VectorXd::Random(n), u = VectorXd::Random(n), b = VectorXd::Random(n),
                   du = VectorXd::Random(n), still = VectorXd::Zero(n);
    VectorXd skew(n), by_u(n), along(n), twin_by_q(n), twin_by_u(n), twin_along(n);
    losses->at(q, u, b, skew, by_u);
    losses->along_rates(du, along);
    twin.transposed(0, q, u, b, twin_by_q, twin_by_u);
    twin.along(0, q, u, b, still, twin_along);
    const VectorXd twin_skew = twin_by_q - twin_along;
    twin.along(0, q, u, still, du, twin_along);
    EXPECT_LT((by_u - twin_by_u).norm(), 1e-13 * twin_by_u.norm());
    EXPECT_LT((skew - twin_skew).norm(), 1e-13 * (twin_skew.norm() + twin_by_q.norm()));
    EXPECT_LT((along - twin_along).norm(), 1e-13 * twin_along.norm());
    skew_ones += twin_skew.norm() > 0.01 * twin_by_u.norm();
  }
  EXPECT_EQ(skew_ones, 3);
  const SceneText formulas = example("lagrangian/double_pendulum.toml");
  EXPECT_EQ(make_line_losses(Mechanism(formulas.scene(), formulas.options)), nullptr);
}

/// Tangents by the sweeps, and of inertias and forces from tables, against rows, differences of
/// mechanisms with neighbouring numbers and a factorised matrix.
TEST(Tangents, BySweepsAreThoseByRows) {
  int swept = 0;
  struct Row {
    std::string text;
    std::vector<std::string> by;
  };
  for (const Row& row : std::vector<Row>{
           {four_bar,
            {"g", "crank", "coupler", "k", "mass", "O.q", "body.rocker.mass", "gravity.0",
             "body.crank.mass", "loop.B.origin.child.0"}},
           {sprung_four_bar(),
            {"g", "crank", "coupler", "k", "mass", "O.q", "joint.O.stiffness", "joint.O.damping",
             "joint.O.friction", "joint.O.rotor_inertia", "force.S.rest", "force.T.value",
             "force.sum.stiffness", "force.sum.damping", "gravity.0", "body.rocker.mass"}},
           {slide_and_coupler, {"turn", "loop.D.length", "loop.Q.offset", "body.b.com.0"}},
           {in_space,
            {"tilt", "end_tilt", "loop.L.origin.child.2", "loop.D.length", "force.S.stiffness",
             "joint.J1.rotor_inertia", "joint.J3.friction", "gravity.0", "body.c.mass",
             "body.d.com.1", "body.a.inertia.1"}},
           {reading::text_of(MOMENTA_SOURCE_DIR "/examples/andrews/scene.toml"),
            {"body.crank.mass", "loop.E4.origin.child.1", "loop.E6.origin.child.0"}}}) {
    const SceneText scene = of_text(row.text);
    const Mechanism sizes(scene.scene(), scene.options);
    const std::vector<RunVariable> variables = run_variables(scene, sizes, row.by);
    const auto slopes = make_number_slopes(sizes, false);
    const std::vector<OtherParameter> by_tables = other_parameters(
                                          scene, sizes, variables,
                                          {.slopes = slopes.get(), .plain_forces = true}),
                                      by_rows = other_parameters(scene, sizes, variables);
    const auto k = static_cast<Index>(row.by.size());
    for (FormOptions options :
         {gauge(Gauge::Kind::reset), gauge(Gauge::Kind::flip), gauge(Gauge::Kind::leak, 3, 7)}) {
      options.project = true;
      AtAState at(scene, options, k, true);
      OdeForm& form = at.ode();
      FormTangents tangents(at.mechanism, form, by_tables), expected(at.mechanism, form, by_rows);
      swept += tangents.swept();
      expected.by_rows();
      const auto expect_same_columns = [&](const MatrixXd& found, const MatrixXd& wanted) {
        const double size = wanted.norm();
        for (Index j = 0; j < k; ++j)
          EXPECT_LT((found.col(j) - wanted.col(j)).norm(), 1e-12 * size)
              << row.by[static_cast<std::size_t>(j)];
      };
      const auto size = static_cast<Index>(at.y.size());
      const MatrixXd Y = VectorXd::LinSpaced(size, 1, 2).asDiagonal() * MatrixXd::Random(size, k);
      std::vector<double> f(at.y.size()), after = at.y;
      ASSERT_TRUE(form.rhs(0, at.y.data(), f.data())) << form.failure();
      ASSERT_EQ(form.pivots().faded, 0);
      MatrixXd found, wanted;
      ASSERT_TRUE(tangents.rates(0, at.y.data(), f.data(), Y, found));
      ASSERT_TRUE(expected.rates(0, at.y.data(), f.data(), Y, wanted));
      expect_same_columns(found, wanted);
      bool changed = false;
      ASSERT_TRUE(form.after_step(0, after.data(), changed)) << form.failure();
      found = wanted = Y;
      ASSERT_TRUE(tangents.after_step(0, at.y.data(), after.data(), found));
      ASSERT_TRUE(expected.after_step(0, at.y.data(), after.data(), wanted));
      expect_same_columns(found, wanted);
    }
  }
  EXPECT_EQ(swept, 9);  // not springs of sums, nor in space springs of points
}

TEST(Tangents, OfManyLoopsTakeTheSparseMatrix) {
  const Mechanism mechanism(equations::row_of_four_bars(12, 1.1, 1), {.cut = CutChoice::scene});
  const auto e = mechanism.evaluation<double>();
  StageMatrix sparse(mechanism), dense(mechanism);
  dense.dense();
  ASSERT_TRUE(sparse.is_sparse());
  const VectorXd q = assemble(mechanism).start.q;
  const Index size = mechanism.nv() + mechanism.m();
  const MatrixXd right = MatrixXd::Random(size, 3);
  for (const double turned : {0.0, 0.3, 0.6}) {
    e->place(0, VectorXd(q.array() + turned).eval().data());
    sparse.factor(*e);
    dense.factor(*e);
    EXPECT_FALSE(sparse.singular());
    EXPECT_FALSE(dense.singular());
    const MatrixXd expected = dense.solve(right);
    EXPECT_LT((sparse.solve(right) - expected).norm(), 1e-12 * expected.norm());
  }
}

/// A run that is recorded, and the stages of its steps computed from their starts.
TEST(Adjoint, KeepsTheStagesOfARun) {
  const SceneText scene = of_text(four_bar);
  for (const char* method : {"rk4", "dp5", "dop853", "vern9"})
    for (const Gauge::Kind kind : {Gauge::Kind::none, Gauge::Kind::reset}) {
      AtAState at(scene, gauge(kind), 1, false);
      const ButcherTableau tableau = butcher_tableau(method);
      IntegrationOptions options;
      options.rtol = options.atol = 1e-6;
      if (std::string(method) == "rk4") options.step = 0.02;
      RecordedRun record(at.ode(), at.ode(), options.step, 0.4, tableau.c, true);
      Observer observer;
      std::vector<std::vector<double>> reached;
      observer.step = [&](double t0, double t1, const Interpolant& between) {
        between(t1, reached.emplace_back(at.y.size()).data());
        return record.keep(t0, t1);
      };
      const IntegrationResult run =
          integrate(method, record, 0, at.ode().initial(at.start), {0, 0.4}, options, observer);
      ASSERT_TRUE(run.done) << run.reason;
      ASSERT_EQ(record.steps().size(), reached.size());
      const auto n = static_cast<Index>(at.y.size());
      MatrixXd k(n, static_cast<Index>(tableau.b.size()));
      for (std::size_t i = 0; i < reached.size(); ++i) {
        ASSERT_TRUE(record.has_stages(i)) << method << ", step " << i;
        const RecordedRun::Step& step = record.steps()[i];
        at.ode().begin_step(step.t0, record.start(i));
        for (std::size_t j = 0; j < tableau.b.size(); ++j) {
          VectorXd y = Map<const VectorXd>(record.start(i), n);
          for (std::size_t l = 0; l < j; ++l)
            y += step.h * tableau.a[j][l] * k.col(static_cast<Index>(l));
          EXPECT_LT((y - Map<const VectorXd>(record.stage(i, j), n)).norm(), 1e-13 * y.norm())
              << method << ", step " << i << ", stage " << j;
          const double t = tableau.c[j] == 1 ? step.t1 : step.t0 + tableau.c[j] * step.h;
          ASSERT_TRUE(at.ode().rhs(t, y.data(), k.col(static_cast<Index>(j)).data()));
          ASSERT_NE(record.rates(i, j), nullptr) << method << ", step " << i;
          for (Index l = 0; l < n / 2; ++l)
            EXPECT_NEAR(record.rates(i, j)[l], at.ode().rates()[static_cast<std::size_t>(l)], 1e-12)
                << method << ", step " << i << ", stage " << j;
        }
        if (kind == Gauge::Kind::none) continue;
        const Map<const VectorXd> end(reached[i].data(), n);
        EXPECT_LT((end - Map<const VectorXd>(record.reached(i), n)).norm(), 1e-13 * end.norm());
      }
    }
}

TEST(Adjoint, ReadsASceneOnceForOwnNumbersOfAllParts) {
  const SceneText scene = of_text(sprung_four_bar());
  const Mechanism mechanism(scene.scene(), scene.options);
  const std::unique_ptr<NumberSlopes> slopes = make_number_slopes(mechanism, false);
  ASSERT_TRUE(slopes->of_places());
  const auto taken = [&](const std::vector<std::string>& names) {
    return other_parameters(scene, mechanism, run_variables(scene, mechanism, names),
                            {slopes.get()});
  };
  // Two numbers of one body, and one whose scene has other lengths.
  const std::vector<std::string> names{"body.crank.mass",
                                       "body.rocker.mass",
                                       "mass",
                                       "body.crank.shape.length",
                                       "crank",
                                       "joint.O.rest",
                                       "joint.O.damping",
                                       "force.S.stiffness",
                                       "force.sum.rest"};
  const std::vector<OtherParameter> together = taken(names);
  const NumberSlopes::Range crank = slopes->of("body.crank.mass").ranges.at(0);
  EXPECT_EQ(crank.count, 4);
  EXPECT_EQ(slopes->of("force.S.rest").ranges.at(0).count, 8);
  EXPECT_FALSE(slopes->of("force.S.rest").of_places);
  EXPECT_TRUE(slopes->of("body.nobody.mass").ranges.empty());
  EXPECT_TRUE(slopes->of("loop.B.origin.child.0").of_places);
  for (std::size_t j = 0; j < names.size(); ++j) {
    const VectorXd alone = taken({names[j]}).front().numbers;
    ASSERT_EQ(together[j].numbers.size(), alone.size()) << names[j];
    EXPECT_GT(alone.norm(), 0) << names[j];
    EXPECT_LT((together[j].numbers - alone).norm(), 1e-12 * alone.norm()) << names[j];
    // A length is where the start is assembled from.
    EXPECT_EQ(together[j].by_mechanisms, names[j] == "crank") << names[j];
  }
  EXPECT_GT(together[0].numbers.segment(crank.first, crank.count).norm(), 0);
}

/// Of places that stand in several frames, by six readings for as many as share nothing.
TEST(Adjoint, ReadsASceneOnceForPlacesThatShareNothing) {
  for (const auto& [text, names] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {in_space,
            {"joint.J1.origin.parent.0", "joint.J1.origin.child.1", "joint.J2.origin.parent.2",
             "joint.J2.origin.child.1", "joint.J3.origin.parent.1", "joint.J4.origin.parent.1",
             "loop.D.length", "loop.L.origin.child.2", "loop.L.origin.parent.0",
             "force.S.origin.child.0", "joint.J3.position", "body.a.com.1"}},
           {sprung_four_bar(),
            {"joint.A.origin.parent.1", "joint.C.origin.parent.0", "loop.B.origin.parent.0",
             "loop.B.origin.child.1", "joint.O.velocity", "body.rocker.mass"}}}) {
    const SceneText scene = of_text(text);
    const Mechanism mechanism(scene.scene(), scene.options);
    const std::unique_ptr<NumberSlopes> slopes = make_number_slopes(mechanism, true);
    const auto taken = [&](const std::vector<std::string>& of) {
      return other_parameters(scene, mechanism, run_variables(scene, mechanism, of),
                              {slopes.get(), true, true});
    };
    const std::vector<OtherParameter> together = taken(names);
    for (std::size_t j = 0; j < names.size(); ++j) {
      const std::vector<OtherParameter> own = taken({names[j]});
      const OtherParameter& alone = own.front();
      ASSERT_EQ(together[j].numbers.size(), alone.numbers.size()) << names[j];
      EXPECT_GT(alone.numbers.norm(), 0) << names[j];
      EXPECT_LT((together[j].numbers - alone.numbers).norm(), 1e-12 * alone.numbers.norm())
          << names[j];
      EXPECT_EQ(together[j].of_places, alone.of_places) << names[j];
      EXPECT_FALSE(together[j].by_mechanisms) << names[j];
    }
  }
}

/// Against the differences of whole assemblies: of guesses that close and others, in a plane and in
/// space, with and without loops, slides, held joints and drives.
TEST(Adjoint, OfTheStartIsTheDifferenceOfItsAssemblies) {
  std::string far = four_bar;  // Newton's first steps are cut
  far.replace(far.find("damping = 0.4"), 13, "damping = 0.0");
  far.replace(far.find("position = 1.7"), 14, "position = 2.6");
  struct Row {
    SceneText scene;
    std::vector<std::string> by;
  };
  for (const Row& row : std::vector<Row>{
           {of_text(sprung_four_bar()),
            {"crank", "coupler", "rocker", "mass", "joint.C.origin.parent.1", "O.q", "C.q", "A.u",
             "O.u"}},
           {of_text(far), {"crank", "coupler", "rocker", "C.q", "A.q", "O.u"}},
           {of_text(slide_and_coupler),
            {"turn", "loop.D.length", "loop.Q.offset", "loop.D.origin.parent.0",
             "joint.K.origin.parent.0", "joint.W.position", "body.b.com.0", "W.q", "J.q", "K.u"}},
           {of_text(in_space),
            {"tilt", "end_tilt", "joint.J2.origin.parent.2", "loop.L.origin.child.2",
             "loop.D.length", "body.c.mass", "J2.q0", "J1.q", "J3.u"}},
           {example("andrews/scene.toml"),
            {"loop.E4.origin.child.1", "body.crank.mass", "O.q", "O.u"}},
           {example("chain/scene.toml"), {"joint.J3.origin.parent.0", "J1.q", "J9.u"}},
           {of_scene(equations::row_of_four_bars(3, 1.2, 0.7)),
            {"loop.C1.origin.child.0", "loop.C2.origin.parent.0", "joint.B1.origin.parent.0"}},
           {of_text(driven()), {"M.q", "M.u", "body.pendulum.mass"}}}) {
    const Mechanism mechanism(row.scene.scene(), row.scene.options);
    const std::vector<RunVariable> by = run_variables(row.scene, mechanism, row.by);
    std::vector<RunVariable> near = by;  // so that differences have their digits in bent scenes
    for (RunVariable& v : near) v.size /= 4;
    const std::vector<OtherParameter> nearby = other_parameters(row.scene, mechanism, near);
    StartAdjoint start(mechanism, assemble(mechanism).start);
    ASSERT_TRUE(start.follows_assembly()) << mechanism.scene().name;
    const std::vector<OtherParameter> others =
        other_parameters(row.scene, mechanism, by, {&start.numbers(), true, true});
    for (const char* form : {"momentum", "acceleration"}) {
      const MatrixXd expected =
          start_tangents(mechanism, form, gauge(Gauge::Kind::none), near, nearby).of_state;
      const MatrixXd slopes = start.rows(form[0] == 'm');
      for (std::size_t j = 0; j < by.size(); ++j) {
        EXPECT_FALSE(others[j].by_mechanisms) << by[j].name;
        const VectorXd found = start.by(by[j], others[j], slopes),
                       column = expected.col(static_cast<Index>(j));
        EXPECT_LT((found - column).norm(), 1e-10 * (1 / by[j].size + column.norm()))
            << mechanism.scene().name << ", " << form << ", by " << by[j].name;
      }
    }
  }
}

/// Where equations are redundant, or the way to the pose is another one, it is differenced.
TEST(Adjoint, OfTheStartIsNotThatOfRedundantLoops) {
  SceneText scene = example("bricard/scene.toml");
  scene.fixed = {{"joint." + scene.scene().joints[0].name + ".velocity", 0.5}};
  const Mechanism mechanism(scene.scene(), scene.options);
  StartAdjoint start(mechanism, assemble(mechanism).start);
  EXPECT_FALSE(start.follows_assembly());
  const std::vector<RunVariable> by = run_variables(scene, mechanism, {"body.rod1.mass"});
  const std::vector<OtherParameter> differenced = other_parameters(scene, mechanism, by),
                                    others =
                                        other_parameters(scene, mechanism, by, {&start.numbers()});
  ASSERT_TRUE(others[0].starts_at_once);  // p = M u has inertias all the same
  const VectorXd column =
      start_tangents(mechanism, "momentum", gauge(Gauge::Kind::none), by, differenced)
          .of_state.col(0);
  EXPECT_GT(column.norm(), 0);
  EXPECT_LT((start.by(by[0], others[0], start.rows(true)) - column).norm(), 1e-10 * column.norm());
}

/// Of w, by each part of y: the transposed derivative, and the column by column one.
void expect_transposed(const VectorXd& found, const MatrixXd& Y, const VectorXd& w, double within,
                       const std::string& what) {
  const VectorXd expected = Y.transpose() * w;
  for (Index i = 0; i < found.size(); ++i)
    EXPECT_NEAR(
        found[i], expected[i],
        within * (Y.col(i).cwiseAbs().dot(w.cwiseAbs()) + expected.norm() + 1e-2 * w.norm()))
        << what << ", " << i;
}

FormOptions fed_back(double alpha, double beta) {
  FormOptions options;
  options.baumgarte_alpha = alpha;
  options.baumgarte_beta = beta;
  return options;
}

TEST(Adjoint, OfAccelerationsIsTheirDerivativeTransposed) {
  for (const char* form : {"acceleration", "baumgarte"})
    for (const auto& [name, scene] : scenes()) {
      const Mechanism sizes(scene.scene(), scene.options);
      const Index size = sizes.nq() + sizes.nv(), n = sizes.nv();
      AtAState at(scene, fed_back(3, 7), size, name != "Bricard", form);
      std::vector<double> f(at.y.size());
      ASSERT_TRUE(at.ode().rhs(0, at.y.data(), f.data())) << at.ode().failure();
      FormTangents tangents(at.mechanism, at.ode(), at.others);
      MatrixXd fy;
      ASSERT_TRUE(tangents.rates(0, at.y.data(), f.data(), MatrixXd::Identity(size, size), fy));
      AdjointState state = at.state();
      state.u = state.p;
      state.slope = Map<const VectorXd>(f.data() + n, n);
      const std::vector<OtherParameter> none;
      AccelerationAdjoint adjoint(at.mechanism, at.ode(), none);
      const VectorXd w = VectorXd::Random(size);
      VectorXd product, by_nothing;
      if (at.ode().pivots().faded > 0) adjoint.by_rows();
      for (const char* way : {"recursion", "matrix"}) {
        ASSERT_TRUE(adjoint.rates(state, w, product, by_nothing));
        expect_transposed(product, fy, w, 1e-12, name + ", " + form + ", by " + way);
        adjoint.by_rows();
      }
    }
}

TEST(Adjoint, OfCorrectionsOfAccelerationsIsTheirDerivativeTransposed) {
  for (const char* form : {"projected", "baumgarte"})
    for (const auto& [name, scene] : scenes()) {
      FormOptions options = fed_back(3, 7);
      options.project = true;
      const Mechanism sizes(scene.scene(), scene.options);
      if (sizes.m() == 0) continue;
      const Index size = sizes.nq() + sizes.nv(), n = sizes.nv();
      AtAState at(scene, options, size, name != "Bricard", form);
      std::vector<double> after = at.y;
      bool changed = false;
      ASSERT_TRUE(at.ode().after_step(0, after.data(), changed)) << at.ode().failure();
      FormTangents tangents(at.mechanism, at.ode(), at.others);
      MatrixXd Y = MatrixXd::Identity(size, size);
      ASSERT_TRUE(tangents.after_step(0, at.y.data(), after.data(), Y));
      AdjointState state = at.state();
      state.q = Map<const VectorXd>(after.data(), n);
      const std::vector<OtherParameter> none;
      AccelerationAdjoint adjoint(at.mechanism, at.ode(), none);
      const VectorXd w = VectorXd::Random(size);
      VectorXd by_nothing;
      if (at.ode().pivots().faded > 0) adjoint.by_rows();
      for (const char* way : {"recursion", "matrix"}) {
        VectorXd lambda = w;
        ASSERT_TRUE(adjoint.gauge(state, lambda, by_nothing));
        ASSERT_TRUE(adjoint.correction(0, Map<const VectorXd>(at.y.data(), n), lambda, by_nothing));
        expect_transposed(lambda, Y, w, 1e-11, name + ", " + form + ", by " + way);
        adjoint.by_rows();
      }
    }
}

/// Second derivatives by differences of rows of degree two, swept or not, and by series.
TEST(Adjoint, TakesSecondDerivativesInThreeWays) {
  int swept = 0;
  for (const auto& [name, scene] : scenes()) {
    const Mechanism mechanism(scene.scene(), scene.options);
    if (mechanism.plan().drives) continue;
    const Index n = mechanism.nv(), m = mechanism.m();
    const TransposedForces forces(mechanism);
    MixedRates mixed(mechanism, 3, 7, forces.any(), forces.at_points());
    srand(7);
    const VectorXd q = assemble(mechanism).start.q + 0.1 * VectorXd::Random(n);
    for (const double size : {0.0, 1e-3, 1.0, 1e3}) {
      const VectorXd u = size * VectorXd::Random(n), udot = 10 * VectorXd::Random(n),
                     lambda = VectorXd::Random(m), nu = 1e-4 * VectorXd::Random(n),
                     mu = VectorXd::Random(m);
      const MixedRates::At at{0.1, q, u, udot, lambda};
      mixed.by_series(at, nu, mu);
      const VectorXd by_q = mixed.by_q, by_u = mixed.by_u;
      EXPECT_GT(by_q.norm(), 0) << name;
      for (const bool by_rows : {true, false}) {
        if (by_rows)
          mixed.polarised(at, nu, mu);
        else
          mixed(at, nu, mu);
        EXPECT_LT((mixed.by_q - by_q).norm(), 1e-12 * by_q.norm()) << name << ", u of " << size;
        EXPECT_LT((mixed.by_u - by_u).norm(), 1e-12 * (by_u.norm() + 1e-2 * by_q.norm()))
            << name << ", u of " << size;
      }
    }
    swept += mixed.swept();
  }
  EXPECT_GE(swept, 4);
}

TEST(Adjoint, IsTheForwardGradientOnAccelerations) {
  for (const TableRow& row : table())
    for (const auto& [form, project] :
         {std::pair{"acceleration", false}, {"projected", true}, {"baumgarte", false}}) {
      GradientRequest request = asked(row.of, row.by, form, "", row.end, row.step);
      request.settings.project = project;
      expect_same(example(row.scene), request, 1e-12, row.whole);
    }
  for (const char* method : {"rk4", "dp5", "vern9"})
    for (const bool integral : {false, true}) {
      GradientRequest request =
          asked("(P.x - 0.5*crank)^2 + t*O.u", all_of_four_bar, "baumgarte", "", 0.5, 0.05);
      request.settings.integrator = method;
      request.settings.project = integral;
      request.integral = integral;
      expect_same(of_text(four_bar), request, 1e-12);
    }
  // The last stage of dp5 is the first of the next step, before what corrects it.
  GradientRequest loose = asked("P.x + 0.3*C.u^2", {"g", "crank", "O.q"}, "momentum", "none", 0.5);
  loose.settings.integrator = "dp5";
  loose.settings.project = true;
  loose.settings.step = 0.1;
  expect_same(of_text(four_bar), loose, 1e-12);
  // What is prescribed has a part in time, and numbers are taken from rows.
  for (const char* form : {"acceleration", "projected", "baumgarte"}) {
    const GradientRequest request = asked(
        "tip.x + 0.1*M.u", {"body.pendulum.mass", "swing", "long", "M.q"}, form, "", 0.4, 0.02);
    expect_same(of_text(driven()), request, 1e-12);
  }
}

/// The sentence with which it is refused.
std::string refusal(const SceneText& scene, GradientRequest request) {
  request.mode = GradientMode::adjoint;
  return equations::thrown([&] { gradient(scene, request); });
}

TEST(Adjoint, RefusesInOneSentence) {
  const SceneText scene = of_text(four_bar);
  EXPECT_EQ(
      refusal(scene, asked("P.x", {"crank"}, "partitioned", "")),
      "form 'partitioned' has no gradient; expected one of: momentum, acceleration, projected "
      "or baumgarte");
  EXPECT_EQ(equations::thrown<std::invalid_argument>([&] { gradient_mode("backwards"); }),
            "mode 'backwards' is not known; expected one of: automatic, forward or adjoint");
  GradientRequest request = asked("P.x", {"crank"}, "momentum", "reset");
  request.trajectory = true;
  EXPECT_EQ(refusal(scene, request),
            "an adjoint has no derivatives of the trajectory; expected the mode 'forward'");
  const SceneText rod = of_scene(equations::flying_rod());
  const std::string mass = "body." + rod.scene().bodies[0].name + ".mass";
  EXPECT_NE(refusal(rod, asked("energy", {mass}, "momentum", "reset"))
                .find("are no derivatives of coordinates"),
            std::string::npos);
  EXPECT_NE(refusal(example("bicycle/scene.toml"), asked("energy", {"gravity.2"}, "momentum", ""))
                .find("expected the mode 'forward'"),
            std::string::npos);
  EXPECT_NE(refusal(of_scene(equations::row_of_four_bars(1, 0, 1)),
                    asked("energy", {"gravity.1"}, "momentum", "reset"))
                .find("become dependent"),
            std::string::npos);
}

}  // namespace
}  // namespace momenta::dae_adjoint
