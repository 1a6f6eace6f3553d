// Drives of loops as inputs of linear models: derivatives of the nonlinear equations by what is
// prescribed, the model of the same mechanism cut elsewhere, and runs with a small input.

#include "equations/dense_lagrangian.h"
#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/parts.h"
#include "equations/quad_linear_twin.h"
#include "equations/recut.h"

#include <gtest/gtest.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/analysis/linear/linear_model.h>
#include <momenta/dae/analysis/linear/loop_drives.h>
#include <momenta/dae/run/state_after.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <Eigen/Dense>
#include <complex>

namespace momenta::dae_linear_loop_drives {
namespace {

using namespace equations;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using equations::example;
using reading::digits;

/// 0 at the start; later f, ḟ and f̈ all move something.
DriveSpec waving(const std::string& loop, int coordinate, const std::string& origin) {
  DriveSpec d;
  d.loop = loop;
  d.coordinate = coordinate;
  d.origin = origin;
  d.kind = "formula";
  const int k = origin.empty() ? coordinate : 3 + origin[0] - 'x';
  d.law = digits(0.05 + 0.01 * k) + "*sin(" + digits(5.1 + k) + "*t) + 0.1*t";
  return d;
}

/// Seven hinges in a row, the last body held to the ground by a loop of this kind, in axes that are
/// its own at the start; drives of coordinates and of the origin by bits.
Scene closed_arm(LoopKind kind, int coordinates, int origins) {
  Scene s;
  s.gravity = {0.4, -9.81, 1.1};
  std::string before = "ground";
  for (int k = 0; k < 7; ++k) {
    const std::string name = "b" + std::to_string(k);
    s.bodies.push_back(rod(name, 0.1 + 0.02 * k));
    JointSpec j = hinge("J" + std::to_string(k), before, name,
                        {k == 0 ? 0.0 : 0.8, 0.1 * (k % 2), 0.05 * k}, 0.3 + 0.25 * k);
    j.axis = Vector3d(0.3 * (k % 3), 0.4 * ((k + 1) % 2), 1 - 0.4 * (k % 4)).normalized();
    j.stiffness = 2;
    j.rest = 0.1;
    s.joints.push_back(j);
    before = name;
  }
  const Tree tree = build_tree(s);
  const Eigen::Isometry3d pose = DenseLagrangian(s, tree).poses(0, tree.q0).back();
  LoopSpec l = equations::make_loop(kind, "L", "ground", "b6");
  l.axis = Vector3d(0.2, -0.5, 1).normalized();
  if (kind == LoopKind::universal) l.axis2 = Vector3d(1, 0.3, -0.2).normalized();
  if (kind == LoopKind::planar) l.direction = Vector3d(1, 0.2, 0.1).normalized();
  l.origin_child = {0.7, 0.1, -0.2};
  l.origin_parent = pose * l.origin_child;
  if (kind == LoopKind::distance) {
    l.origin_parent += Vector3d(0.5, -0.4, 0.3);
    l.length = Vector3d(0.5, -0.4, 0.3).norm();
  }
  l.rotation = Eigen::Quaterniond(pose.linear());
  if (kind == LoopKind::coupler) {
    l = LoopSpec{};
    l.name = "L";
    l.kind = kind;
    l.joints = {"J1", "J3"};
    l.ratios = {1, -0.7};
    l.offset = s.joints[1].position[0] - 0.7 * s.joints[3].position[0];
  }
  s.loops = {l};
  for (int i = 0; i < 3; ++i)
    if ((coordinates >> i & 1) != 0) {
      DriveSpec d = waving("L", i, "");
      if (kind == LoopKind::distance) d.law = digits(l.length) + " + " + d.law;
      if (kind == LoopKind::coupler) d.law = digits(l.offset) + " + " + d.law;
      s.drives.push_back(d);
    }
  for (int i = 0; i < 3; ++i)
    if ((origins >> i & 1) != 0) {
      DriveSpec d = waving("L", 0, std::string(1, static_cast<char>('x' + i)));
      d.law = digits(l.origin_parent[i]) + " + " + d.law;
      s.drives.push_back(d);
    }
  return s;
}

/// The law of a drive with h (t − t₀)^k/k! more: at t₀ its f, ḟ or f̈ alone is another. Times
/// 1 − (1 − t/t₀)³, so that the start, by which a length is measured, stays.
Scene with_more(Scene scene, int drive, double t, int order, double h) {
  DriveSpec& d = scene.drives[static_cast<std::size_t>(drive)];
  const std::string since = "*(t - " + digits(t) + ")^";
  d.law += " + (" + digits(order == 2 ? h / 2 : h) + ")" +
           (order == 0 ? "" : since + std::to_string(order)) + "*(1 - (1 - t/" + digits(t) + ")^3)";
  return scene;
}

/// Columns by drives of loops of [ẋ; y], from four values each: h⁴ and ε/h are left.
MatrixXd differences(const Mechanism& mechanism, const Start& at, const OperatingPoint& point,
                     const IndependentCoordinates& chosen) {
  const double h = 2e-4;
  MatrixXd all;
  Eigen::Index column = 0;
  for (const int drive : chosen.loop_drives)
    for (int order = 0; order < 3; ++order) {
      const auto value = [&](double step) {
        // Drives of joints are free in `freed`: those of loops are all it has.
        Scene scene = with_more(point.freed->scene(), drive, at.t, order, step);
        const Mechanism other(std::move(scene), mechanism.options());
        const OperatingPoint there = [&] {
          OperatingPoint p = operating_point(other, Start{at.t, point.q, point.u, {}, {}, {}});
          p.free = point.free;
          p.driven = point.driven;
          p.driven_accelerations = point.driven_accelerations;
          return p;
        }();
        const std::vector<double> y = QuadLinearTwin(there, chosen).at_state();
        return VectorXd(Eigen::Map<const VectorXd>(y.data(), static_cast<long>(y.size())));
      };
      const VectorXd slope =
          (8 * (value(h) - value(-h)) - (value(2 * h) - value(-2 * h))) / (12 * h);
      if (all.size() == 0)
        all.resize(slope.size(), 3 * static_cast<Eigen::Index>(chosen.loop_drives.size()));
      all.col(column++) = slope;
    }
  return all;
}

Start later(const Mechanism& mechanism, double time) {
  RunSettings settings = default_settings(mechanism.scene().run, "momentum", "dop853", 1e-11);
  settings.end_time = time;
  return state_after(mechanism, equations::start_of(mechanism), settings, 60);
}

void expect_derivatives(const Scene& scene, double time, std::size_t drives,
                        const std::string& what) {
  SCOPED_TRACE(what);
  const Mechanism mechanism(scene);
  const Start at = later(mechanism, time);
  const LinearModel model = linear_model(mechanism, at);
  const OperatingPoint point = operating_point(mechanism, at);
  const IndependentCoordinates chosen = independent_coordinates(point, {});
  ASSERT_EQ(chosen.loop_drives.size(), drives);
  const MatrixXd found = [&] {
    MatrixXd all(model.B.rows() + model.D.rows(), 3 * static_cast<Eigen::Index>(drives));
    all << model.B.rightCols(all.cols()), model.D.rightCols(all.cols());
    return all;
  }();
  const MatrixXd expected = differences(mechanism, at, point, chosen);
  ASSERT_EQ(found.rows(), expected.rows());
  for (Eigen::Index i = 0; i < found.rows(); ++i) {
    const double size = std::max(expected.row(i).cwiseAbs().maxCoeff(), 1e-3);
    EXPECT_LT((found.row(i) - expected.row(i)).cwiseAbs().maxCoeff(), 1e-9 * size)
        << (i < model.B.rows() ? model.states[static_cast<std::size_t>(i)].name
                               : model.outputs[static_cast<std::size_t>(i - model.B.rows())].name);
  }
}

TEST(LinearLoopDrives, AreTheDerivativesByWhatIsPrescribed) {
  struct Case {
    LoopKind kind;
    int coordinates, origins;
    std::size_t drives;
  };
  const Case cases[] = {
      {LoopKind::revolute, 1, 7, 4},    {LoopKind::prismatic, 1, 2, 2},
      {LoopKind::cylindrical, 3, 0, 2}, {LoopKind::universal, 1, 0, 1},
      {LoopKind::universal, 2, 1, 2},   {LoopKind::universal, 3, 0, 2},
      {LoopKind::planar, 7, 0, 3},      {LoopKind::spherical, 7, 4, 4},
      {LoopKind::point, 0, 7, 3},       {LoopKind::slot, 1, 1, 2},
      {LoopKind::distance, 1, 2, 2},    {LoopKind::coupler, 1, 0, 1},
  };
  for (const Case& c : cases)
    expect_derivatives(
        closed_arm(c.kind, c.coordinates, c.origins), 0.1, c.drives,
        std::to_string(static_cast<int>(c.kind)) + " " + std::to_string(c.coordinates));
}

/// A four-bar that shakes a pendulum on its coupler, its crank driven by `law`, which starts at
/// 1.2; as a joint, or as the loop where the mechanism is cut.
Scene shaken(const std::string& law, bool of_loop) {
  Scene scene = example("driven/scene.toml");
  std::swap(scene.bodies[2], scene.bodies[3]);  // in the order of the tree, as recut() has them
  scene.held.clear();
  DriveSpec& drive = scene.drives[0];
  drive.kind = "polynomial";
  drive.coefficients = {1.2};
  if (of_loop) {
    const Mechanism whole(scene);
    scene = recut(scene, whole.tree(), assemble(whole).start.q, "O", "B");
  }
  scene.drives[0].kind = "formula";
  scene.drives[0].law = law;
  return scene;
}

TEST(LinearLoopDrives, OfAMechanismCutElsewhereAreThoseOfTheJoint) {
  const std::string law = "1.2 + 0.5*sin(2*t)";
  const Mechanism joint(shaken(law, false)), loop(shaken(law, true));
  ASSERT_TRUE(loop.plan().planar);
  LinearRequest request;
  request.independent = {"M"};
  request.inputs = {"drives"};
  request.outputs = {"M.q", "M.u", "M.udot", "tip.x", "tip.vy"};
  const LinearModel a = linear_model(joint, later(joint, 0.4), request),
                    b = linear_model(loop, later(loop, 0.4), request);
  ASSERT_EQ(b.inputs.size(), 3u);
  EXPECT_EQ(b.inputs[0].label(), "O.q [rad]");
  EXPECT_EQ(b.inputs[1].label(), "O.u [rad/s]");
  EXPECT_EQ(b.inputs[2].label(), "O.udot [rad/s^2]");
  const double size = a.B.cwiseAbs().maxCoeff();
  EXPECT_LT((a.A - b.A).cwiseAbs().maxCoeff(), 1e-9 * a.A.cwiseAbs().maxCoeff());
  EXPECT_LT((a.B - b.B).cwiseAbs().maxCoeff(), 1e-9 * size);
  EXPECT_LT((a.C - b.C).cwiseAbs().maxCoeff(), 1e-9 * a.C.cwiseAbs().maxCoeff());
  EXPECT_LT((a.D - b.D).cwiseAbs().maxCoeff(), 1e-9 * a.D.cwiseAbs().maxCoeff());
}

TEST(LinearLoopDrives, OfBothKindsAreOneSystem) {
  const Mechanism mechanism(closed_arm(LoopKind::revolute, 1, 7));
  const Start at = later(mechanism, 0.1);
  LinearRequest request;
  const LinearModel minimal = linear_model(mechanism, at, request);
  request.kind = LinearRequest::Kind::descriptor;
  const LinearModel descriptor = linear_model(mechanism, at, request);
  const auto response = [](const LinearModel& m, std::complex<double> s) {
    const Eigen::MatrixXcd inside =
        s * m.E.cast<std::complex<double>>() - m.A.cast<std::complex<double>>();
    return Eigen::MatrixXcd(m.C * inside.fullPivLu().solve(m.B.cast<std::complex<double>>()) +
                            m.D.cast<std::complex<double>>());
  };
  const Eigen::MatrixXcd a = response(minimal, {0.3, 2}), b = response(descriptor, {0.3, 2});
  ASSERT_EQ(a.cols(), b.cols());
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-9 * a.cwiseAbs().maxCoeff());
}

/// Runs with f₀ ± ε w(t) about rest, and the linear model with w, w = sin³ 3t: its f̈ is continuous.
TEST(LinearLoopDrives, FollowRunsWithASmallInput) {
  const double epsilon = 1e-4, end = 1;
  const std::string wave = "sin(3*t)^3";
  const auto law = [&](double e) { return "1.2 + (" + digits(e) + ")*" + wave; };
  Scene still = shaken(law(0), true);
  const Mechanism mechanism(still);
  // The pendulum hangs.
  Start rest = equations::start_of(mechanism);
  const std::vector<Column> names = mechanism.coordinate_columns();
  Eigen::Index hinge_place = 0;
  while (names[static_cast<std::size_t>(hinge_place)].name != "M.q") ++hinge_place;
  const std::vector<Column> markers = mechanism.marker_columns();
  const auto place = [&](double angle) {
    Scene scene = still;
    for (JointSpec& j : scene.joints)
      if (j.name == "M") j.position = {angle};
    return scene;
  };
  // tip.x equals that of the hinge where the rod is vertical: the angle that does it is linear.
  const auto e = mechanism.evaluation<double>();
  const auto tip = [&](double angle) {
    VectorXd q = rest.q, values(static_cast<Eigen::Index>(markers.size()));
    const VectorXd none = VectorXd::Zero(mechanism.nv());
    q[hinge_place] = angle;
    e->place(0, q.data());
    e->move(none.data());
    e->markers(values.data());
    return Vector3d(values[0], values[1], values[2]);
  };
  const Vector3d one = tip(0), other = tip(2 * std::numbers::pi / 3),
                 third = tip(4 * std::numbers::pi / 3), centre = (one + other + third) / 3;
  const Vector3d from = one - centre;
  const double down =
      std::remainder(-std::numbers::pi / 2 - std::atan2(from.y(), from.x()), 2 * std::numbers::pi);
  const Vector3d at_rest = tip(down);
  ASSERT_NEAR(at_rest.x(), centre.x(), 1e-12);
  still = place(down);
  const Mechanism hanging(still);
  LinearRequest request;
  request.independent = {"M"};
  request.inputs = {"drives"};
  request.outputs = {"M.q", "tip.x", "tip.vx", "M.u"};
  const LinearModel model = linear_model(hanging, equations::start_of(hanging), request);
  ASSERT_EQ(model.B.cols(), 3);
  const auto input = [](double t) {
    const double s = std::sin(3 * t), c = std::cos(3 * t);
    return Vector3d(s * s * s, 9 * s * s * c, 54 * s * c * c - 27 * s * s * s);
  };
  // Runge's and Kutta's method.
  VectorXd x = VectorXd::Zero(model.A.rows());
  const int steps = 2000;
  const double h = end / steps;
  const auto rate = [&](const VectorXd& y, double t) {
    return VectorXd(model.A * y + model.B * input(t));
  };
  for (int k = 0; k < steps; ++k) {
    const double t = k * h;
    const VectorXd k1 = rate(x, t), k2 = rate(x + h / 2 * k1, t + h / 2),
                   k3 = rate(x + h / 2 * k2, t + h / 2), k4 = rate(x + h * k3, t + h);
    x += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  const VectorXd y = model.C * x + model.D * input(end);
  const auto run = [&](double amount) {
    Scene moved = still;
    moved.drives[0].law = law(amount);
    const Mechanism m(moved);
    const Start last = later(m, end);
    const auto values = m.evaluation<double>();
    VectorXd found(6);
    values->place(last.t, last.q.data());
    values->move(last.u.data());
    values->markers(found.data());
    return VectorXd(Eigen::Vector4d(last.q[hinge_place], found[0], found[3], last.u[hinge_place]));
  };
  const VectorXd found = (run(epsilon) - run(-epsilon)) / (2 * epsilon);
  for (Eigen::Index i = 0; i < 4; ++i)
    EXPECT_NEAR(found[i], y[i], 1e-5 * (1 + std::abs(y[i])))
        << model.outputs[static_cast<std::size_t>(i)].name;
  EXPECT_GT(std::abs(y[0]), 0.01);
}

/// Two driven loops that hold one slide twice: neither can be varied by itself.
TEST(LinearLoopDrives, ThatLoopsDoNotFollowAreNoInputs) {
  Scene s = closed_arm(LoopKind::revolute, 1, 0);
  LoopSpec twin = s.loops[0];
  twin.name = "twin";
  s.loops.push_back(twin);
  DriveSpec d = s.drives[0];
  d.loop = "twin";
  s.drives.push_back(d);
  const Mechanism mechanism(s);
  const LinearModel model = linear_model(mechanism, later(mechanism, 0.1));
  for (const Column& c : model.inputs) EXPECT_NE(c.name.substr(0, 2), "L.") << c.name;
  for (const Column& c : model.inputs) EXPECT_NE(c.name.substr(0, 5), "twin.") << c.name;
}

}  // namespace
}  // namespace momenta::dae_linear_loop_drives
