// Whole motions: (q, p) by the momentum recursion and (q, u) by the acceleration recursion are two
// different systems of equations with one solution. Integrated by classical Runge-Kutta with step
// h, both err by O(h⁴), so their difference falls by 16 when h is halved; so does the energy error.

#include "equations/parts.h"
#include "equations/random_tree.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/open_chain/open_chain.h>

namespace momenta::core_trajectories {
namespace {

using namespace equations;

/// One classical step of y' = f(t, y).
template <class F>
Eigen::VectorXd step(const F& f, double t, const Eigen::VectorXd& y, double h) {
  const Eigen::VectorXd a = f(t, y), b = f(t + h / 2, y + h / 2 * a),
                        c = f(t + h / 2, y + h / 2 * b), d = f(t + h, y + h * c);
  return y + h / 6 * (a + 2 * b + 2 * c + d);
}

/// (q, u) after `steps` steps to `end`, the state being (q, p) on the way.
Eigen::VectorXd by_momenta(OpenChain& chain, const TreeState& s, double end, int steps) {
  const int nq = chain.nq(), nv = chain.nv();
  Eigen::VectorXd y(nq + nv), p(nv), u(nv);
  chain.momenta(s.t, s.q, s.u, p);
  y << s.q, p;
  const auto f = [&](double t, const Eigen::VectorXd& x) {
    Eigen::VectorXd rate(nq + nv);
    EXPECT_TRUE(chain.rates(t, x.head(nq), x.tail(nv), rate.head(nq), rate.tail(nv)));
    return rate;
  };
  const double h = end / steps;
  for (int i = 0; i < steps; ++i) y = step(f, s.t + i * h, y, h);
  EXPECT_TRUE(chain.velocities(s.t + end, y.head(nq), y.tail(nv), u));
  y.tail(nv) = u;
  return y;
}

/// The same, the state being (q, u).
Eigen::VectorXd by_rates(OpenChain& chain, const TreeState& s, double end, int steps) {
  const int nq = chain.nq(), nv = chain.nv();
  Eigen::VectorXd y(nq + nv);
  y << s.q, s.u;
  const auto f = [&](double t, const Eigen::VectorXd& x) {
    Eigen::VectorXd rate(nq + nv);
    chain.coordinate_rates(x.head(nq), x.tail(nv), rate.head(nq));
    EXPECT_TRUE(chain.accelerations(t, x.head(nq), x.tail(nv), rate.tail(nv)));
    return rate;
  };
  const double h = end / steps;
  for (int i = 0; i < steps; ++i) y = step(f, s.t + i * h, y, h);
  return y;
}

/// log2 of the fall of an error when h is halved twice, per halving.
double order(double coarse, double fine) {
  return std::log2(coarse / fine) / 2;
}

void same_motion(const TreeRecipe& recipe, bool flat, int steps, unsigned first, int trees) {
  const double end = 0.25;
  double least = 10, worst = 0;
  for (int i = 0; i < trees; ++i) {
    RandomTree random(first + static_cast<unsigned>(i));
    Scene scene = flat ? random.planar_scene(recipe) : random.scene(recipe);
    for (DriveSpec& drive : scene.drives)
      if (drive.kind == "table") {  // f‴ jumps at its points: no fourth order across them
        drive.kind = "polynomial";
        drive.coefficients = drive.values;
      }
    OpenChain chain(scene);
    if (chain.nv() == 0) continue;
    const TreeState s = random.state(chain.tree());
    const auto difference = [&](int n) {
      return relative_error(by_momenta(chain, s, end, n), by_rates(chain, s, end, n));
    };
    const double coarse = difference(steps), fine = difference(4 * steps);
    // below the rounding of some hundred steps there is no order left to see
    if (fine > 1e-12) least = std::min(least, order(coarse, fine));
    worst = equations::larger(worst, fine);
  }
  EXPECT_GT(least, 3.5);
  EXPECT_LT(worst, promise_tol(end / (4 * steps), 4, 1e6));  // constant: the wildest tree
  testing::Test::RecordProperty("order", std::to_string(least));
  testing::Test::RecordProperty("difference", std::to_string(worst * 1e12) + "e-12");
}

TEST(Trajectories, MixedTrees) {
  same_motion({.bodies = 4}, false, 128, 100, 20);
}
TEST(Trajectories, Drives) {
  same_motion({.bodies = 4, .kinds = {JointKind::revolute, JointKind::prismatic}}, false, 128, 200,
              20);
}
TEST(Trajectories, SphericalChains) {
  same_motion({.bodies = 3, .branching = Branching::serial, .kinds = {JointKind::spherical}}, false,
              128, 300, 10);
}
TEST(Trajectories, PlanarTrees) {
  same_motion({.bodies = 5}, true, 16, 400, 30);
}

/// Nothing driven, nothing damped, no forces that follow bodies: H = T + V stays. Its error falls
/// with the fourth power of h or faster.
TEST(Trajectories, EnergyStays) {
  double least = 10, worst = 0;
  for (unsigned seed = 500; seed < 530; ++seed) {
    RandomTree random(seed);
    Scene scene = random.scene({.bodies = 4, .drives = false});
    for (JointSpec& joint : scene.joints) joint.damping = 0;
    for (ForceSpec& force : scene.forces) {
      force.damping = 0;
      force.in_body_axes = false;
      force.torque.setZero();
    }
    OpenChain chain(scene);
    if (chain.nv() == 0) continue;
    const TreeState s = random.state(chain.tree());
    const Energies start = chain.energies(s.t, s.q, s.u);
    const double size = std::abs(start.kinetic) + std::abs(start.potential);
    const auto error = [&](int steps) {
      const Eigen::VectorXd y = by_momenta(chain, s, 0.25, steps);
      const Energies end = chain.energies(s.t + 0.25, y.head(chain.nq()), y.tail(chain.nv()));
      EXPECT_NEAR(end.hamiltonian, end.kinetic + end.potential, algebra_tol(40) * size);
      return std::abs(end.hamiltonian - start.hamiltonian) / size;
    };
    const double coarse = error(256), fine = error(1024);
    if (fine > 1e-12) least = std::min(least, order(coarse, fine));
    worst = equations::larger(worst, fine);
  }
  EXPECT_GT(least, 3.5);
  EXPECT_LT(worst, promise_tol(0.25 / 1024, 4, 1e6));  // constant: the wildest tree
  RecordProperty("order", std::to_string(least));
  RecordProperty("error", std::to_string(worst * 1e12) + "e-12");
}

/// A pendulum released from the horizontal, com at distance c: θ̈ = −m g c / J_O at first, and
/// energy gives |θ̇| = √(2 m g c / J_O) at the bottom.
TEST(Trajectories, PendulumByHand) {
  Scene scene;
  scene.gravity = {0, -9.81, 0};
  BodySpec body = equations::make_body("pendulum", 2, {0.05, 0.1, 0.1}, {0.4, 0, 0});
  scene.bodies.push_back(body);
  JointSpec joint;
  joint.name = "pin";
  joint.child = "pendulum";
  scene.joints.push_back(joint);
  for (const Algebra algebra : {Algebra::planar, Algebra::spatial}) {
    OpenChain chain(scene, algebra);
    const double inertia = 0.1 + 2 * 0.4 * 0.4, quarter = std::acos(0.0);
    Eigen::VectorXd q(1), u(1), p(1), qdot(1), pdot(1), udot(1);
    q << 0;
    u << 0;
    ASSERT_TRUE(chain.accelerations(0, q, u, udot));
    EXPECT_NEAR(udot[0], -2 * 9.81 * 0.4 / inertia, algebra_tol(4));
    // at the bottom
    q << -quarter;
    u << -std::sqrt(2 * 2 * 9.81 * 0.4 / inertia);
    chain.momenta(0, q, u, p);
    EXPECT_NEAR(p[0], inertia * u[0], algebra_tol(4));
    ASSERT_TRUE(chain.rates(0, q, p, qdot, pdot));
    EXPECT_NEAR(qdot[0], u[0], algebra_tol(4));
    EXPECT_NEAR(pdot[0], 0, algebra_tol(4));
    const Energies e = chain.energies(0, q, u);
    EXPECT_NEAR(e.hamiltonian, 0, algebra_tol(8));
    // the pin holds weight and centripetal force, along the body's x axis, which points down
    const Reaction r = chain.reactions(0, q, u).front();
    EXPECT_NEAR(r.force.x(), -(2 * 9.81 + 2 * 0.4 * u[0] * u[0]), algebra_tol(20));
    EXPECT_NEAR(r.force.y(), 0, algebra_tol(20));
  }
}

}  // namespace
}  // namespace momenta::core_trajectories
