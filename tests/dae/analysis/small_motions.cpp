// Laws of small motions: they are what a run does, whoever solves for them, wherever loops are cut
// and however the room is turned.

#include "equations/differenced_motions.h"
#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/recut.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/dae/analysis/linear/linearisation.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/extremes.h>
#include <momenta/dae/study/modes_study.h>

#include <filesystem>
#include <numbers>
#include <sstream>

namespace momenta::dae_small_motions {
namespace {

using namespace equations;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using equations::example;

ModesResult modes_of(const Scene& scene, ModesRequest request = {},
                     Algebra algebra = Algebra::automatic) {
  const Mechanism mechanism(scene, {.algebra = algebra});
  return find_modes(mechanism, equations::start_of(mechanism), request);
}

/// A chain of n rods of 1 kg, `sag` times as long as the way between the two points it hangs on.
Scene hanging_loop(int n, double sag, double damping = 0) {
  Scene scene;
  scene.gravity = {0, -9.81, 0};
  double direction = 0;
  for (int i = 0; i < n; ++i) {
    const double along = -0.8 + 1.6 * (i + 0.5) / n;
    scene.bodies.push_back(rod("b" + std::to_string(i)));
    scene.joints.push_back(
        hinge("j" + std::to_string(i), i == 0 ? "ground" : "b" + std::to_string(i - 1),
              "b" + std::to_string(i), {i == 0 ? 0.0 : 1.0, 0, 0}, along - direction));
    scene.joints.back().damping = damping;
    direction = along;
  }
  LoopSpec end;
  end.name = "end";
  end.kind = LoopKind::revolute;
  end.child = "b" + std::to_string(n - 1);
  end.origin_parent = {n / sag, 0, 0};
  end.origin_child = {1, 0, 0};
  scene.loops.push_back(end);
  return scene;
}

/// The four-bar with a spring and a damper between crank and rocker.
Scene sprung_four_bar(double damping) {
  Scene scene = example("four_bar/scene.toml");
  scene.joints[0].stiffness = 3;
  scene.joints[0].rest = 1.2;
  scene.joints[1].damping = damping;
  return scene;
}

Scene humming_platform() {
  Scene scene = platform(6);
  for (JointSpec& j : scene.joints)
    if (j.kind == JointKind::prismatic) {
      j.stiffness = 4000;
      j.rest = j.position.empty() ? 1 : j.position[0];
      j.damping = 3;
    }
  return scene;
}

struct Named {
  std::string name;
  Scene scene;
};
std::vector<Named> mechanisms() {
  std::vector<Named> all{{"four-bar", example("four_bar/scene.toml")},
                         {"sprung four-bar", sprung_four_bar(0.2)},
                         {"squeezer", held_at_start(example("andrews/scene.toml"))},
                         {"hanging loop", hanging_loop(7, 1.4)},
                         {"damped hanging loop", hanging_loop(5, 1.2, 0.7)},
                         {"platform", humming_platform()}};
  for (const char* robot : {"ur5/ur5_robot.urdf", "panda_urdf/panda.urdf",
                            "mujoco_small/connect.xml", "urdfplus/four_bar.urdf"}) {
    const auto file = std::filesystem::path(MOMENTA_SOURCE_DIR) / "examples" / "models" / robot;
    if (std::filesystem::exists(file)) all.push_back({robot, read_scene(file)});
  }
  return all;
}

double distance(std::complex<double> s, const std::vector<std::complex<double>>& among) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& other : among) least = std::min(least, std::abs(s - other));
  return least;
}

TEST(SmallMotions, AreThoseOfDifferencedAccelerations) {
  for (const auto& [name, scene] : mechanisms()) {
    const Mechanism mechanism(scene);
    const ModesResult r = find_modes(mechanism, equations::start_of(mechanism), {});
    const auto twin = differenced_spectrum(mechanism, r.equilibrium);
    double largest = 0;
    for (const auto& s : twin) largest = equations::larger(largest, std::abs(s));
    int number = 0;
    std::size_t counted = 0;
    for (const Mode& mode : r.spectrum.modes) {
      ++number;
      counted += r.spectrum.conservative || mode.s.imag() != 0 ? 2 : 1;
      if (mode.kind() == Mode::Kind::rigid) continue;
      // Differences are good to 1e-7 of A: a slow mode's s² feels that of the fastest.
      EXPECT_LT(distance(mode.s, twin), 3e-6 * largest * largest / std::abs(mode.s))
          << name << ", mode " << number << ": " << mode.s;
    }
    EXPECT_EQ(counted, twin.size()) << name;
    EXPECT_GT(r.spectrum.modes.size(), 0u) << name;
  }
}

TEST(SmallMotions, SolveTheirEquationsWithShapesOfUnitMass) {
  for (const auto& [name, scene] : mechanisms()) {
    const Mechanism mechanism(scene);
    const ModesResult r = find_modes(mechanism, equations::start_of(mechanism), {});
    const Equilibrium& at = r.equilibrium;
    const Linearisation l = linearise(mechanism, at.t, at.q, at.lambda,
                                      MatrixXd::Identity(mechanism.nv(), mechanism.nv()));
    MatrixXd N = MatrixXd::Identity(mechanism.nv(), mechanism.nv());
    if (mechanism.m() > 0) {
      Eigen::FullPivLU<MatrixXd> lu(l.loops);
      lu.setThreshold(1e-9);
      N = lu.kernel();
    }
    for (const Mode& mode : r.spectrum.modes) {
      const VectorXcd& phi = mode.shape;
      EXPECT_NEAR(std::abs(phi.dot(l.M * phi)), 1, 1e-10) << name;
      if (mechanism.m() > 0) {
        EXPECT_LT((l.loops * phi).norm(), 1e-9 * (1 + l.loops.norm()) * phi.norm()) << name;
      }
      const VectorXcd inertia = mode.s * mode.s * (l.M * phi),
                      rest = mode.s * (l.C * phi) + l.K * phi;
      const double dust = 1e-13 * (N.cwiseAbs().transpose() * (l.M * phi).cwiseAbs()).norm() *
                          std::norm(r.spectrum.modes.back().s);
      const double size = (N.transpose() * inertia).norm() +
                          (N.transpose().cwiseAbs() * (l.K * phi).cwiseAbs()).norm();
      EXPECT_LE((N.transpose() * (inertia + rest)).norm(), 1e-8 * size + dust)
          << name << " " << mode.s;
    }
    if (!r.spectrum.conservative) continue;
    EXPECT_LT((l.M - l.M.transpose()).norm(), 1e-12 * l.M.norm()) << name;
    for (const Mode& a : r.spectrum.modes)
      for (const Mode& b : r.spectrum.modes)
        if (&a != &b) {
          EXPECT_LT(std::abs(a.shape.dot(l.M * b.shape)), 1e-9) << name;
        }
  }
}

void expect_same(const ModesResult& found, const ModesResult& expected, double relative,
                 const std::string& what) {
  ASSERT_EQ(found.spectrum.modes.size(), expected.spectrum.modes.size()) << what;
  for (std::size_t i = 0; i < found.spectrum.modes.size(); ++i) {
    const auto a = found.spectrum.modes[i].s, b = expected.spectrum.modes[i].s;
    EXPECT_LE(std::abs(a - b), relative * std::abs(b)) << what << ", mode " << i + 1;
  }
}

TEST(SmallMotions, AreTheSameWhereverLoopsAreCut) {
  const auto at_cuts = [](const Scene& scene, const std::vector<std::string>& cuts,
                          const std::string& loop) {
    const Mechanism mechanism(scene);
    const ModesResult expected = find_modes(mechanism, equations::start_of(mechanism), {});
    for (const std::string& cut : cuts) {
      const Scene other = recut(scene, mechanism.tree(), assemble(mechanism).start.q, cut, loop);
      expect_same(modes_of(other), expected, 1e-9, cut);
      expect_same(modes_of(other, {}, Algebra::spatial), expected, 1e-9, cut + " in space");
    }
  };
  at_cuts(example("four_bar/scene.toml"), {"O", "A", "C"}, "B");
  at_cuts(hanging_loop(6, 1.4), {"j1", "j3", "j5"}, "end");
}

TEST(SmallMotions, AreTheSameInATurnedRoom) {
  for (const auto& [name, scene] : mechanisms()) {
    const ModesResult expected = modes_of(scene);
    for (const Eigen::Vector3d& axis : {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 2, -1)}) {
      const Eigen::Quaterniond r(Eigen::AngleAxisd(1.3, axis.normalized()));
      expect_same(modes_of(turned(scene, r)), expected, 1e-7, name);
    }
  }
}

TEST(SmallMotions, DenseAndSparseRoutesAgree) {
  for (const auto& [name, scene] : mechanisms())
    expect_same(modes_of(scene, {.route = Route::sparse}), modes_of(scene, {.route = Route::dense}),
                1e-7, name);
  // Bricard's loop has a redundant equation; nothing holds it.
  const ModesResult bricard = modes_of(equations::bricard(), {.route = Route::sparse});
  EXPECT_EQ(bricard.spectrum.rank, 4);
}

TEST(SmallMotions, LanczosAndArnoldiFindTheLowestOfAll) {
  constexpr int n = 160, count = 8;
  for (const double damping : {0.0, 30.0}) {
    const Scene scene = hanging_loop(n, 1.3, damping);
    const Mechanism mechanism(scene);
    const Start start = equations::start_of(mechanism);
    const ModesResult lowest =
        find_modes(mechanism, start, {.count = count, .route = Route::sparse});
    const Spectrum all = spectrum(mechanism, lowest.equilibrium, count, Route::dense);
    ASSERT_FALSE(lowest.spectrum.complete);
    ASSERT_EQ(lowest.spectrum.modes.size(), static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      const Mode &a = lowest.spectrum.modes[static_cast<std::size_t>(i)],
                 &b = all.modes[static_cast<std::size_t>(i)];
      EXPECT_LT(std::abs(a.s - b.s), 1e-7 * std::abs(b.s)) << damping << ", mode " << i + 1;
      EXPECT_LT((a.shape - b.shape).norm(), 1e-4 * b.shape.norm()) << damping << ", mode " << i + 1;
    }
  }
}

TEST(SmallMotions, SettlingEndsInAMinimumBelowTheStart) {
  // Chains pass folded poses on their way down, saddles all of them.
  for (const char* name : {"chain/scene.toml", "extremes/five_rods.toml", "four_bar/scene.toml",
                           "models/panda_urdf/panda.urdf"}) {
    const Mechanism mechanism(example(name));
    const Start start = equations::start_of(mechanism);
    const ModesResult r = find_modes(mechanism, start, {});
    EXPECT_EQ(r.growing(), 0) << name;
    const auto e = mechanism.evaluation<double>();
    const VectorXd rest = VectorXd::Zero(mechanism.nv());
    e->place(0, start.q.data());
    e->move(rest.data());
    EXPECT_LT(r.equilibrium.potential, e->potential(start.q.data())) << name;
    if (mechanism.m() > 0) continue;
    // Without loops a minimum under weights alone is where every force along a joint vanishes.
    VectorXd left(mechanism.nv());
    e->place(0, r.equilibrium.q.data());
    e->move(rest.data());
    e->joint_forces(r.equilibrium.q.data(), rest.data(), nullptr, nullptr, left.data());
    EXPECT_LT(left.cwiseQuotient(force_scales(mechanism, *e)).cwiseAbs().maxCoeff(), 1e-12) << name;
  }
}

// A spring on one side alone touches at the pose: on either side the motion has a frequency, and no
// mode is rigid.
TEST(SmallMotions, AtACornerAreThoseOfOneSide) {
  const std::string slide =
      "[[body]]\nname = \"m\"\nmass = 1\ninertia = 1\n[[joint]]\nname = \"X\"\nkind = "
      "\"prismatic\"\nchild = \"m\"\naxis = \"x\"\nstiffness = 1\n[[force]]\nkind = "
      "\"torque\"\njoint = \"X\"\nlaw = \"-3*max(0, q)\"\n";
  const std::string typed = "[lagrangian]\ncoordinates = [\"x\", \"y\"]\n";
  const std::string both = typed +
                           "kinetic = \"(x.dot^2 + y.dot^2)/2\"\npotential = \"x^2/2 + y^2 + "
                           "1.5*max(0, x)^2\"\nposition = [0, 0]\n";
  for (const std::string& text : {slide, both}) {
    const ModesResult found = modes_of(parse_scene(text, "corner.toml"));
    EXPECT_EQ(found.rigid(), 0) << text;
    EXPECT_STREQ(found.nature(), "stable") << text;
    for (const Mode& mode : found.spectrum.modes) {
      const double omega = std::abs(mode.s.imag());
      EXPECT_LT(
          std::min({std::abs(omega - 1), std::abs(omega - 2), std::abs(omega - std::sqrt(2.0))}),
          1e-9)
          << omega;
    }
  }
}

TEST(SmallMotions, AreWhatARunDoes) {
  constexpr double epsilon = 1e-5;
  for (const double damping : {0.0, 0.05}) {
    const Scene scene = sprung_four_bar(damping);
    const Mechanism mechanism(scene);
    const ModesResult r = find_modes(mechanism, equations::start_of(mechanism), {});
    const Mode& mode = r.spectrum.modes.at(0);
    ASSERT_EQ(mode.kind(), Mode::Kind::oscillation);
    PoseMotion poses(mechanism);
    Start start;
    start.q = r.equilibrium.q;
    start.u = VectorXd::Zero(mechanism.nv());
    const double size = epsilon / mode.shape.cwiseAbs().maxCoeff();
    ASSERT_TRUE(poses.move(0, r.equilibrium.q, size * mode.shape.real(), start.q));
    // Of Re(φ e^{st}) the velocity at the start too.
    const VectorXcd rate = mode.s * mode.shape;
    start.u = size * rate.real();
    poses.evaluation().place(0, start.q.data());
    VectorXd udot, lambda;
    ASSERT_TRUE(poses.let_go(0, start.q, udot, lambda));
    start.udot = udot;
    start.lambda = lambda;
    const RunResult run = run_form(mechanism, start,
                                   equations::kept(equations::adaptive(
                                       "projected", "dop853", "none", 1e-12,
                                       3 * 2 * std::numbers::pi / mode.angular_frequency(), 24)));
    ASSERT_EQ(run.status, "done") << run.reason;
    ASSERT_EQ(run.trajectory.rows.size(), 25u);
    for (const auto& row : run.trajectory.rows) {
      const VectorXcd expected = size * std::exp(mode.s * row[0]) * mode.shape;
      for (int i = 0; i < mechanism.nv(); ++i)
        EXPECT_NEAR(row[static_cast<std::size_t>(i) + 1] - r.equilibrium.q[i], expected[i].real(),
                    1e-3 * epsilon)
            << "t = " << row[0];
    }
  }
}

}  // namespace
}  // namespace momenta::dae_small_motions
