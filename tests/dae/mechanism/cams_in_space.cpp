// Higher pairs whose plane moves with its body in space: the plane mechanism turned in space, and
// on a base that is pushed, that spins, or that tumbles freely.
//
//   pushed with acceleration a, turned by R    the plane mechanism under Rᵀ(g − a)
//   spinning about the plane's normal          the same in the plane's own kernel, whatever the
//                                              base does along the normal
//   tumbling freely                            momentum, angular momentum and energy stay; two
//                                              circles that touch are a rod between their centres

#include <gtest/gtest.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/core/open_chain/centroidal.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <algorithm>

#include "equations/carried.h"
#include "equations/parts.h"

namespace momenta::dae_cams_in_space {
namespace {

using namespace equations;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// A crank that turns, a follower that slides or swings, and a higher pair between them.
Scene pair_of(const std::string& loop, bool swings) {
  return parse_scene(R"(
[[body]]
name = "cam"
mass = 2
com = [0.02, 0.01, 0]
inertia = 0.05
[[body]]
name = "follower"
mass = 0.5
com = [0.03, 0.1, 0]
inertia = 0.01
[[joint]]
name = "O"
kind = "revolute"
child = "cam"
position = 0.3
velocity = 6
[[joint]]
name = "S"
child = "follower"
)" +
                         std::string(swings ? R"(
kind = "revolute"
origin = { parent = [0.4, 0.1, 0], child = [0.4, 0, 0] }
)"
                                            : R"(
kind = "prismatic"
axis = "y"
position = 0.07
)") + R"(
[[loop]]
name = "contact"
parent = "cam"
child = "follower"
)" + loop + R"(
[[force]]
kind = "spring-damper"
child = "follower"
origin = { parent = [0, 0.6, 0], child = [0, 0.2, 0] }
stiffness = 40
damping = 0.3
rest = 0.45
[assembly]
hold = ["O"]
)",
                     "pair.toml");
}
struct Case {
  std::string name;
  Scene scene;
};
std::vector<Case> cases() {
  const auto cam = [](const std::string& parent, const std::string& child) {
    return "kind = \"cam\"\nprofile = { parent = { " + parent + " }, child = { " + child + " } }";
  };
  const std::string ellipse = "kind = \"ellipse\", semi_axes = [0.1, 0.06]",
                    flat = "kind = \"flat\", normal = \"-y\"",
                    roller = "kind = \"circle\", radius = 0.03",
                    outline =
                        "kind = \"spline\", points = [[0.1, 0, 0], [0.06, 0.07, 0], [-0.02, "
                        "0.09, 0], [-0.09, 0.02, 0], [-0.06, -0.08, 0], [0.04, -0.07, 0]]";
  return {
      {"ellipse and flat face", pair_of(cam(ellipse, flat), false)},
      {"ellipse and roller on a lever", pair_of(cam(ellipse, roller), true)},
      {"spline and roller", pair_of(cam(outline, roller), false)},
      {"pin in a round groove",
       pair_of("kind = \"slot\"\ncurve = \"circle\"\nradius = 0.09\norigin = { parent = [0.03, 0, "
               "0] }",
               false)},
      {"rack", pair_of("kind = \"rack\"\nradius = 0.1\norigin = { parent = [0, 0, 0], child = [0, "
                       "0, 0] }\ndirection = \"x\"",
                       true)},
  };
}

/// Columns of one body of numbers: q, u, then Φ, Φ̇ and λ.
struct Motion {
  std::string status, reason;
  std::vector<VectorXd> rows;  ///< O.q S.q O.u S.u and λ by sample
  double position_drift = 0, velocity_drift = 0;
};
/// ODE forms in fixed steps, which take the same ones in a plane and in space; DAE forms
/// adaptively.
Motion run(const Scene& scene, Algebra algebra, const std::string& form) {
  const Mechanism mechanism(scene, {.algebra = algebra});
  EXPECT_EQ(mechanism.plan().planar, algebra != Algebra::spatial) << scene.name;
  RunRequest request;
  request.settings.form = form;
  request.settings.integrator = is_dae_form(form) ? "radau5" : "rk4";
  if (is_dae_form(form))
    request.settings.rtol = request.settings.atol = 1e-9;
  else
    request.settings.step = 1e-3;
  request.settings.end_time = 0.5;
  request.settings.samples = 20;
  request.keep_trajectory = request.multipliers = true;
  const RunResult result = run_form(mechanism, assemble(mechanism).start, request);
  const std::vector<std::string> columns = trajectory_columns(mechanism);
  std::vector<std::size_t> places;
  for (const char* name : {"O.q ", "S.q ", "O.u ", "S.u "})
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (columns[i].starts_with(name)) places.push_back(i);
  // In space a row before keeps a pin in the plane of its groove.
  places.push_back(0);
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i].starts_with("contact.lambda")) places.back() = i;
  EXPECT_EQ(places.size(), 5u);
  Motion motion{
      result.status, result.reason, {}, result.position_drift_max, result.velocity_drift_max};
  for (const auto& row : result.trajectory.rows) {
    VectorXd numbers(static_cast<Eigen::Index>(places.size()));
    for (std::size_t i = 0; i < places.size(); ++i)
      numbers[static_cast<Eigen::Index>(i)] = row[places[i]];
    motion.rows.push_back(numbers);
  }
  return motion;
}

void expect_same(const Motion& x, const Motion& y, bool fixed_steps) {
  ASSERT_EQ(x.status, "done") << x.reason;
  ASSERT_EQ(y.status, "done") << y.reason;
  ASSERT_EQ(x.rows.size(), y.rows.size());
  for (std::size_t i = 0; i < x.rows.size(); ++i)
    for (Eigen::Index k = 0; k < x.rows[i].size(); ++k) {
      const double scale = k < 4 ? 1 : 10;  // λ of some ten newtons
      EXPECT_NEAR(x.rows[i][k], y.rows[i][k], scale * (fixed_steps ? 1e-9 : 1e-5)) << i << " " << k;
    }
  // Of adaptive steps drifts have an order of magnitude alone.
  const double share = fixed_steps ? 1.001 : 30, dust = fixed_steps ? 1e-11 : 1e-8;
  EXPECT_LE(x.position_drift, share * y.position_drift + dust);
  EXPECT_LE(y.position_drift, share * x.position_drift + dust);
  EXPECT_LE(x.velocity_drift, share * y.velocity_drift + 10 * dust);
  EXPECT_LE(y.velocity_drift, share * x.velocity_drift + 10 * dust);
}

const Vector3d gravity(0.4, -9.81, 0.7);
/// The plane's axes in space.
Eigen::Quaterniond tilt() {
  return Eigen::Quaterniond(Eigen::AngleAxisd(0.9, Vector3d(0.48, 0.6, 0.64)));
}

/// The base on a slide along `way` with q = rate²... prescribed, its axes turned by tilt().
Scene pushed(const Scene& plane, const Vector3d& acceleration) {
  JointSpec way = base_joint("way", JointKind::prismatic, "ground", "base",
                             tilt().conjugate() * acceleration.normalized());
  way.rotation = tilt();
  Scene scene = on_base(plane, {massless("base")}, {way});
  scene.gravity = gravity;
  scene.drives.push_back(equations::polynomial("way", {0, 0.3, 0.5 * acceleration.norm()}));
  return scene;
}

const std::vector<std::string> forms{"momentum",          "acceleration",        "projected",
                                     "baumgarte",         "maximal-coordinates", "momentum-index2",
                                     "stabilised-index2", "acceleration-index1"};

TEST(CamsInSpace, TurnedInSpaceByForce) {
  for (const Case& c : cases()) {
    Scene plane = c.scene, turned = c.scene;
    plane.gravity = tilt().conjugate() * gravity;
    turned.gravity = gravity;
    for (JointSpec& joint : turned.joints) {
      joint.rotation = tilt();
      joint.origin_parent = tilt() * joint.origin_parent;
    }
    for (ForceSpec& force : turned.forces) force.origin_parent = tilt() * force.origin_parent;
    for (const std::string& form : forms) {
      SCOPED_TRACE(c.name + " " + form);
      const bool fixed_steps = !is_dae_form(form);
      const Motion in_plane = run(plane, Algebra::planar, form);
      expect_same(run(turned, Algebra::spatial, form), in_plane, fixed_steps);
      expect_same(run(plane, Algebra::spatial, form), in_plane, fixed_steps);
    }
  }
}

TEST(CamsInSpace, OnAPushedBaseThePlaneFeelsTheGravityThatIsLeft) {
  const Vector3d acceleration(2.0, -1.0, 5.0);
  for (const Case& c : cases()) {
    Scene plane = c.scene;
    plane.gravity = tilt().conjugate() * (gravity - acceleration);
    for (const std::string& form : forms) {
      SCOPED_TRACE(c.name + " " + form);
      const bool fixed_steps = !is_dae_form(form);
      expect_same(run(pushed(c.scene, acceleration), Algebra::spatial, form),
                  run(plane, Algebra::planar, form), fixed_steps);
    }
  }
}

TEST(CamsInSpace, OnASpinningBase) {
  for (const Case& c : cases()) {
    // Spin about z; in space beside it to and fro along z, on a slide before.
    const JointSpec spin = base_joint("spin", JointKind::revolute, "ground", "base", {0, 0, 1});
    JointSpec on_way = spin;
    on_way.parent = "way";
    DriveSpec turns, goes;
    turns.joint = "spin";
    turns.kind = "polynomial";
    turns.coefficients = {0.2, 1.5, 0.8};
    goes.joint = "way";
    goes.kind = "harmonic";
    goes.amplitude = 0.3;
    goes.frequency = 9;
    Scene plane = on_base(c.scene, {massless("base")}, {spin});
    plane.drives = {turns};
    JointSpec way = base_joint("way", JointKind::prismatic, "ground", "way", {0, 0, 1});
    way.rotation = tilt();
    Scene space = on_base(c.scene, {massless("way"), massless("base")}, {way, on_way});
    space.drives = {turns, goes};
    for (const std::string& form : forms) {
      SCOPED_TRACE(c.name + " " + form);
      const bool fixed_steps = !is_dae_form(form);
      expect_same(run(space, Algebra::spatial, form), run(plane, Algebra::planar, form),
                  fixed_steps);
    }
  }
}

/// On a free body that tumbles, without gravity.
Scene tumbling(const Scene& plane) {
  BodySpec base = massless("base");
  base.mass = 3;
  base.com = {0.1, -0.05, 0.07};
  base.inertia.diagonal() << 0.1, 0.2, 0.15;
  JointSpec joint = base_joint("base", JointKind::free, "ground", "base", {0, 0, 1});
  joint.position = {0.1, 0.2, 0.3, 0.5, 0.5, -0.5, 0.5};
  joint.velocity = {0.3, -0.2, 0.1, 2.0, 1.5, -1.0};
  Scene scene = on_base(plane, {base}, {joint});
  for (ForceSpec& force : scene.forces) force.damping = 0;
  return scene;
}

TEST(CamsInSpace, OnATumblingBaseMomentaAndEnergyStay) {
  for (const Case& c : cases()) {
    const Scene scene = tumbling(c.scene);
    const Mechanism mechanism(scene);
    ASSERT_FALSE(mechanism.plan().planar);
    for (const std::string& form : form_names()) {
      SCOPED_TRACE(c.name + " " + form);
      if (form.find("index3") != std::string::npos) continue;  // integrated to lower accuracy
      RunRequest request;
      request.settings.form = form;
      if (is_dae_form(form)) request.settings.integrator = "radau5";
      request.settings.rtol = request.settings.atol = is_dae_form(form) ? 1e-9 : 1e-11;
      request.settings.end_time = 0.5;
      request.settings.samples = 10;
      request.keep_trajectory = true;
      const Start start = assemble(mechanism).start;
      const RunResult result = run_form(mechanism, start, request);
      ASSERT_EQ(result.status, "done") << result.reason;
      EXPECT_LT(result.energy_error_max, 1e-5);
      EXPECT_LT(result.position_drift_max, 1e-6);
      const auto at_row = [&](std::size_t i) {
        const auto& row = result.trajectory.rows[i];
        const VectorXd q = Eigen::Map<const VectorXd>(row.data() + 1, mechanism.nq()),
                       u = Eigen::Map<const VectorXd>(row.data() + 1 + mechanism.nq(),
                                                      mechanism.nv());
        return centroidal(mechanism.tree(), scene, 0, q, u);
      };
      const Centroidal first = at_row(0);
      for (std::size_t i = 1; i < result.trajectory.rows.size(); ++i) {
        const Centroidal now = at_row(i);
        EXPECT_LT((now.linear_momentum - first.linear_momentum).norm(), 2e-6);
        EXPECT_LT((now.angular_momentum - first.angular_momentum).norm(), 2e-6);
      }
    }
  }
}

TEST(CamsInSpace, TwoCirclesAreARodBetweenTheirCentres) {
  Scene cam = tumbling(pair_of(
      "kind = \"cam\"\nprofile = { parent = { kind = \"circle\", radius = 0.08 }, child = { "
      "kind = \"circle\", radius = 0.03 } }\norigin = { parent = [0.03, 0.02, 0], child = "
      "[0.01, 0, 0] }",
      true));
  Scene rod = cam;
  rod.loops[0].kind = LoopKind::distance;
  rod.loops[0].length = 0.11;
  rod.loops[0].curve = rod.loops[0].child_curve = {};
  for (const std::string& form : form_names()) {
    SCOPED_TRACE(form);
    const bool late = form.find("index3") != std::string::npos;
    const Motion x = run(cam, Algebra::spatial, form), y = run(rod, Algebra::spatial, form);
    ASSERT_EQ(x.status, "done") << x.reason;
    ASSERT_EQ(y.status, "done") << y.reason;
    for (std::size_t i = 0; i < x.rows.size(); ++i)
      EXPECT_LT((x.rows[i] - y.rows[i]).head(4).cwiseAbs().maxCoeff(), late ? 1e-2 : 2e-5) << i;
  }
}

}  // namespace
}  // namespace momenta::dae_cams_in_space
