// Laws of linear models: they are the derivatives of the nonlinear equations, both kinds are one
// system, and their poles are those of small motions.

#include "equations/ensemble.h"
#include "equations/linkages.h"
#include "equations/parts.h"
#include "equations/quad_linear_twin.h"
#include "equations/refusal.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/analysis/linear/linear_model.h>
#include <momenta/dae/analysis/linear/linearisation.h>
#include <momenta/dae/run/state_after.h>
#include <momenta/dae/study/modes_study.h>
#include <momenta/dae/topology/assembly/drive_reach.h>

#include <Eigen/Dense>
#include <complex>
#include <filesystem>

namespace momenta::dae_linear_models {
namespace {

using namespace equations;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using Complex = std::complex<double>;

Scene example(const std::string& name) {
  return read_scene(std::filesystem::path(MOMENTA_SOURCE_DIR) / "examples" /
                    (name.ends_with(".toml") ? name : name + "/scene.toml"));
}

/// A state of the motion itself, away from rest.
Start later(const Mechanism& mechanism, double time) {
  RunSettings settings = default_settings(mechanism.scene().run, "momentum", "dop853", 1e-11);
  settings.end_time = time;
  return state_after(mechanism, equations::start_of(mechanism), settings, 60);
}

template <typename State>
LinearModel model_of(const Mechanism& mechanism, const State& at,
                     LinearRequest::Kind kind = LinearRequest::Kind::minimal) {
  LinearRequest request;
  request.kind = kind;
  return linear_model(mechanism, at, request);
}

/// A and B over C and D.
MatrixXd joined(const LinearModel& m) {
  MatrixXd all(m.A.rows() + m.C.rows(), m.A.cols() + m.B.cols());
  all << m.A, m.B, m.C, m.D;
  return all;
}

MatrixXcd response(const LinearModel& m, Complex s) {
  if (m.A.rows() == 0) return m.D.cast<Complex>();  // drives hold all there is
  const MatrixXcd inside = s * m.E.cast<Complex>() - m.A.cast<Complex>();
  return m.C.cast<Complex>() * inside.fullPivLu().solve(m.B.cast<Complex>()) + m.D.cast<Complex>();
}

/// Largest difference of entries, each against the largest of its column and of its row.
double apart(const MatrixXd& a, const MatrixXd& b) {
  EXPECT_EQ(a.rows(), b.rows());
  EXPECT_EQ(a.cols(), b.cols());
  double most = 0;
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    for (Eigen::Index j = 0; j < a.cols(); ++j)
      most = std::max(
          most, std::abs(a(i, j) - b(i, j)) / std::max({1e-300, b.row(i).cwiseAbs().maxCoeff()}));
  return most;
}

/// Four-bar with a marker on its coupler, moved by springs and dampers too.
Scene marked_four_bar() {
  Scene scene = example("four_bar");
  scene.joints[0].stiffness = 3;
  scene.joints[0].rest = 1.2;
  scene.joints[1].damping = 0.4;
  scene.markers.push_back(equations::make_marker("tip", scene.bodies[1].name, {0.3, 0.2, 0}));
  return scene;
}

/// The crank by a law in time.
Scene driven_four_bar() {
  Scene scene = marked_four_bar();
  scene.joints[0].stiffness = scene.joints[0].rest = 0;
  scene.joints[0].position.clear();
  scene.drives.push_back(equations::harmonic(scene.joints[0].name, 1.1, 0.4, 3));
  return scene;
}

constexpr double rounding = 1e-13;  // of a row's largest entry

struct Case {
  const char* name;
  Scene scene;
  double time;
};

std::vector<Case> moving() {
  std::vector<Case> all;
  all.push_back({"four-bar", marked_four_bar(), 0.37});
  all.push_back({"driven", driven_four_bar(), 0.3});
  all.push_back({"andrews", example("andrews"), 0.01});
  all.push_back({"bricard", bricard(), 0.2});
  all.push_back({"row", row_of_four_bars(3, 1.1, 0.7), 0.2});
  all.push_back({"motor", example("motor"), 0.2});
  all.push_back({"whitworth", example("slots_and_cams/whitworth.toml"), 0.1});
  all.push_back({"cam", example("slots_and_cams/disc_cam.toml"), 0.1});
  all.push_back({"lagrangian", example("lagrangian/double_pendulum.toml"), 0.3});
  all.push_back({"car axis", example("lagrangian/car_axis.toml"), 0.3});
  return all;
}

TEST(LinearModels, AreTheDerivativesOfTheNonlinearEquations) {
  for (const Case& c : moving()) {
    SCOPED_TRACE(c.name);
    const Mechanism mechanism(c.scene);
    ASSERT_FALSE(mechanism.plan().quasi_velocities);
    const Start at = later(mechanism, c.time);
    ASSERT_GT(at.u.cwiseAbs().maxCoeff(), c.scene.drives.empty() ? 1e-2 : 0.0);
    const LinearModel model = model_of(mechanism, at);
    const OperatingPoint point = operating_point(mechanism, at);
    const IndependentCoordinates chosen = independent_coordinates(point, {});
    QuadLinearTwin twin(point, chosen);
    EXPECT_LT(apart(joined(model), twin.differences()), rounding);
  }
}

TEST(LinearModels, OfBothKindsAreOneSystem) {
  for (const Case& c : moving()) {
    SCOPED_TRACE(c.name);
    const Mechanism mechanism(c.scene);
    const Start at = later(mechanism, c.time);
    const LinearModel minimal = model_of(mechanism, at),
                      descriptor = model_of(mechanism, at, LinearRequest::Kind::descriptor);
    ASSERT_EQ(minimal.inputs.size(), descriptor.inputs.size());
    ASSERT_EQ(minimal.outputs.size(), descriptor.outputs.size());
    for (const Complex s : {Complex(0.3, 2), Complex(0, 11), Complex(-2, 0.5)}) {
      const MatrixXcd a = response(minimal, s), b = response(descriptor, s);
      for (Eigen::Index i = 0; i < a.rows(); ++i)
        EXPECT_LE((a - b).row(i).cwiseAbs().maxCoeff(), 1e-10 * b.row(i).cwiseAbs().maxCoeff())
            << minimal.outputs[static_cast<std::size_t>(i)].name;
    }
    if (minimal.poles.size() == 0) continue;  // drives hold all there is
    // Finite eigenvalues of the pencil: 1/(s − τ) of (τE − A)⁻¹E where that is not zero.
    const double shift = 1.7 + minimal.A.norm() / 100;
    const MatrixXd inverse = (descriptor.A - shift * descriptor.E).fullPivLu().solve(descriptor.E);
    const VectorXcd all = Eigen::EigenSolver<MatrixXd>(inverse, false).eigenvalues();
    std::vector<Complex> largest(all.begin(), all.end());
    std::sort(largest.begin(), largest.end(),
              [](const Complex& x, const Complex& y) { return std::abs(x) > std::abs(y); });
    const auto count = static_cast<std::size_t>(minimal.poles.size());
    ASSERT_GT(largest.size(), count);
    // Those that are zero are so by rounding.
    EXPECT_LT(std::abs(largest[count]), 1e-3 * std::abs(largest[count - 1]));
    std::vector<Complex> finite;
    for (std::size_t k = 0; k < count; ++k) finite.push_back(shift + 1.0 / largest[k]);
    const double size = minimal.poles.cwiseAbs().maxCoeff();
    for (const Complex pole : minimal.poles) {
      double nearest = 1e300;
      for (const Complex s : finite) nearest = std::min(nearest, std::abs(s - pole));
      // Andrews' squeezer has entries of 10⁷ in A − τE.
      EXPECT_LT(nearest, 1e-8 * size) << pole;
    }
  }
}

TEST(LinearModels, HaveThePolesOfSmallMotions) {
  Scene damped = row_of_four_bars(2, 1.1);
  for (JointSpec& j : damped.joints) {
    j.damping = 0.3;
    j.stiffness = 4;
    j.rest = 0.2;
  }
  for (const Scene& scene : {marked_four_bar(), example("four_bar"), damped, flying_rod()}) {
    SCOPED_TRACE(scene.name);
    const Mechanism mechanism(scene);
    const ModesResult modes = find_modes(mechanism, equations::start_of(mechanism), {});
    for (const auto kind : {LinearRequest::Kind::minimal, LinearRequest::Kind::descriptor}) {
      const LinearModel model = model_of(mechanism, modes.equilibrium, kind);
      ASSERT_EQ(model.poles.size(), 2 * modes.spectrum.mobility);
      const double size = model.poles.cwiseAbs().maxCoeff();
      for (const Mode& mode : modes.spectrum.modes) {
        if (mode.kind() == Mode::Kind::rigid) continue;  // double zeros are split by √ε
        double nearest = 1e300;
        for (const Complex s : model.poles) nearest = std::min(nearest, std::abs(s - mode.s));
        EXPECT_LT(nearest, 1e-9 * size) << mode.s;
      }
    }
  }
}

/// A bob of mass m on a massless rod of length l below a slide that a drive moves, l θ̈ = −g sin θ −
/// f̈ cos θ, and what the drive exerts, (M + m) f̈ + m l (θ̈ cos θ − θ̇² sin θ).
TEST(LinearModels, OfAPendulumOnADrivenSlideAreThoseByHand) {
  const double m = 0.7, M = 1.3, l = 0.8, g = 9.81, theta = 0.6, omega = 1.4, f2 = -0.9;
  Scene scene;
  scene.gravity = {0, -g, 0};
  BodySpec slide, bob;
  slide.name = "slide";
  slide.mass = M;
  bob.name = "bob";
  bob.mass = m;
  bob.com = {0, -l, 0};
  for (BodySpec* b : {&slide, &bob}) b->inertia.setZero();
  scene.bodies = {slide, bob};
  JointSpec x, turn;
  x.name = "x";
  x.kind = JointKind::prismatic;
  x.child = "slide";
  x.axis = {1, 0, 0};
  turn.name = "turn";
  turn.kind = JointKind::revolute;
  turn.parent = "slide";
  turn.child = "bob";
  turn.axis = {0, 0, 1};
  turn.position = {theta};
  turn.velocity = {omega};
  scene.joints = {x, turn};
  scene.drives = {equations::polynomial("x", {0.1, 0.2, f2 / 2})};
  const Mechanism mechanism(scene);
  LinearRequest request;
  request.inputs = {"turn.tau", "drives"};
  request.outputs = {"x.effort", "turn.udot"};
  const LinearModel model = linear_model(mechanism, assemble(mechanism).start, request);
  const double s = std::sin(theta), c = std::cos(theta), second = -(g * s + f2 * c) / l;
  const double by_theta = -(g * c - f2 * s) / l;
  MatrixXd A(2, 2), B(2, 4), C(2, 2), D(2, 4);
  A << 0, 1, by_theta, 0;
  B << 0, 0, 0, 0, 1 / (m * l * l), 0, 0, -c / l;
  C << m * l * (by_theta * c - second * s - omega * omega * c), -2 * m * l * omega * s, by_theta, 0;
  D << c / l, 0, 0, M + m - m * c * c, 1 / (m * l * l), 0, 0, -c / l;
  EXPECT_LT(apart(model.A, A), 1e-14);
  EXPECT_LT((model.B - B).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_LT((model.C - C).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((model.D - D).cwiseAbs().maxCoeff(), 1e-14);
  const double residual = (model.udot[0] - second) / second;
  EXPECT_LT(std::abs(residual), 1e-14);
}

Scene two_rods_on_balls() {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  for (const char* name : {"a", "b"}) {
    scene.bodies.push_back(rod(name, 0.1));
    JointSpec ball = equations::make_joint(JointKind::spherical, std::string(name) + "_ball",
                                           scene.bodies.size() == 1 ? "ground" : "a", name,
                                           {scene.bodies.size() == 1 ? 0.0 : 1.0, 0, 0});
    ball.velocity = {0.4, -0.7, 1.1};
    scene.joints.push_back(ball);
  }
  return scene;
}

/// Differences of u̇ along δ and δu, of balls, whose u is not q̇.
TEST(LinearModels, OfBallsAreDifferencesOfAccelerations) {
  const Mechanism mechanism(two_rods_on_balls());
  const Start at = later(mechanism, 0.2);
  const LinearModel model = model_of(mechanism, at);
  const auto e = mechanism.evaluation<double>();
  const int nv = mechanism.nv();
  ASSERT_EQ(mechanism.m(), 0);
  constexpr double h = 1e-6;
  const auto acceleration = [&](const VectorXd& delta, const VectorXd& du) {
    VectorXd q = at.q, qdot = VectorXd::Zero(mechanism.nq()), udot(nv);
    e->place(at.t, q.data());
    e->coordinate_rates(q.data(), delta.data(), qdot.data());
    q += qdot;
    mechanism.tree().normalise(q);
    const VectorXd u = at.u + du;
    EXPECT_TRUE(e->open_accelerations(at.t, q.data(), u.data(), udot.data()));
    return udot;
  };
  const VectorXd none = VectorXd::Zero(nv);
  for (int j = 0; j < nv; ++j) {
    const VectorXd step = h * VectorXd::Unit(nv, j);
    const VectorXd by_pose = (acceleration(step, none) - acceleration(-step, none)) / (2 * h),
                   by_rate = (acceleration(none, step) - acceleration(none, -step)) / (2 * h);
    EXPECT_LT((model.A.col(j).tail(nv) - by_pose).cwiseAbs().maxCoeff(),
              1e-7 * (1 + by_pose.cwiseAbs().maxCoeff()));
    EXPECT_LT((model.A.col(nv + j).tail(nv) - by_rate).cwiseAbs().maxCoeff(),
              1e-7 * (1 + by_rate.cwiseAbs().maxCoeff()));
  }
}

TEST(LinearModels, RefuseSingularPosesAndWhatIsNotThere) {
  const Mechanism flat(row_of_four_bars(2, 0));
  const std::string singular = sentence_of([&] { model_of(flat, equations::start_of(flat)); });
  EXPECT_NE(singular.find("the pose is singular: loop '"), std::string::npos) << singular;
  EXPECT_NE(singular.find("at this pose alone"), std::string::npos) << singular;
  const Mechanism four_bar(example("four_bar"));
  const Start at = equations::start_of(four_bar);
  using Names = std::vector<std::string>;
  const auto refused = [&](Names LinearRequest::*which, const Names& names, const char* mentions) {
    LinearRequest request;
    request.*which = names;
    const std::string sentence = sentence_of([&] { linear_model(four_bar, at, request); });
    EXPECT_NE(sentence.find(mentions), std::string::npos) << sentence;
  };
  refused(&LinearRequest::inputs, {"O.tua"}, "did you mean 'O.tau'");
  refused(&LinearRequest::outputs, {"rates", "O.u"}, "is chosen twice");
  refused(&LinearRequest::independent, {"O", "A"}, "are 2, expected 1");
  refused(&LinearRequest::independent, {"X"}, "independent coordinate 'X' is not known");
  Scene welded;
  welded.bodies = {rod("b")};
  welded.joints = {hinge("O", "ground", "b", {0, 0, 0}, 0)};
  welded.joints[0].kind = JointKind::weld;
  welded.joints[0].position.clear();
  LinearRequest of_none;
  of_none.inputs = {"O"};
  EXPECT_EQ(sentence_of([&] {
              const Mechanism fixed(welded);
              linear_model(fixed, equations::start_of(fixed), of_none);
            }),
            "input 'O' is not known; expected none, for the model has no input");
  Start lost = at;
  lost.u[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(sentence_of([&] { model_of(four_bar, lost); }).find("the state is not finite"),
            std::string::npos);
}

/// q" = −(1 + t) q − 0.1 t q̇ − 2 t q at t = 3, where nothing is driven.
TEST(LinearModels, AreAboutTheTimeThatIsAskedFor) {
  const Mechanism mechanism(parse_scene(
      "[[body]]\nname = \"m\"\nmass = 1\ninertia = 1\n[[joint]]\nname = \"X\"\nkind = "
      "\"prismatic\"\nchild = \"m\"\n[[force]]\nkind = \"torque\"\njoint = \"X\"\nlaw = \"-(1 + "
      "t)*q - 0.1*t*u\"\n[[force]]\nkind = \"potential\"\nV = \"t*X.q^2\"\n"));
  const Assembly at = assemble_at(mechanism, 3);
  EXPECT_EQ(at.start.t, 3);
  Eigen::Matrix2d known;
  known << 0, 1, -10, -0.3;
  EXPECT_LT((linear_model(mechanism, at.start, {}).A - known).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(LinearModels, TakeTheCoordinatesThatAreNamed) {
  const Mechanism mechanism(marked_four_bar());
  const Start at = later(mechanism, 0.37);
  MatrixXcd usual = response(model_of(mechanism, at), {0.2, 3});
  for (const char* name : {"O", "A.q", "C"}) {
    LinearRequest request;
    request.independent = {name};
    const LinearModel model = linear_model(mechanism, at, request);
    EXPECT_EQ(model.states[0].name.substr(0, 1), std::string(name).substr(0, 1));
    const MatrixXcd other = response(model, {0.2, 3});
    // About a motion displacements depend on the coordinates; efforts on accelerations do not.
    EXPECT_EQ(other.rows(), usual.rows());
    EXPECT_LT((model.D - model_of(mechanism, at).D).cwiseAbs().maxCoeff(),
              1e-12 * model.D.cwiseAbs().maxCoeff());
  }
}

}  // namespace
}  // namespace momenta::dae_linear_models
