// Rows of loops around planar cycles that no joint moves are left out of the sweeps in space: the
// rows that stay are those of the plane, multipliers of the others are the centre's, and the motion
// is that of the whole matrix. Cycles that leave a plane keep all rows.

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/parts.h"
#include "equations/random_loops.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/kkt/solver_choice.h>

namespace momenta::dae_carried_rows {
namespace {

using namespace equations;
using Eigen::VectorXd;

/// u and σ of (7) from momenta of the given rates, and the rows that faded.
struct Solved {
  VectorXd u, sigma, pdot;
  std::vector<int> faded;
};
Solved solve(const Mechanism& mechanism, const VectorXd& q, const VectorXd& p,
             const VectorXd& centre) {
  const auto e = mechanism.evaluation<double>();
  const auto solver = make_loop_solver(mechanism, *e);
  Solved s{VectorXd(mechanism.nv()), VectorXd(mechanism.m()), VectorXd(mechanism.nv()), {}};
  EXPECT_TRUE(solver->momentum(0, q.data(), p.data(), centre.data(), fade_evaluation, 0, s.u.data(),
                               s.sigma.data(), s.pdot.data()));
  s.faded = solver->faded_rows();
  std::sort(s.faded.begin(), s.faded.end());
  return s;
}

TEST(CarriedRows, OfAPlanarCycleInSpaceAreTwo) {
  const Mechanism swept(equations::example("four_bar"),
                        {.algebra = Algebra::spatial, .kkt = KktChoice::sweeps}),
      dense(equations::example("four_bar"), {.algebra = Algebra::spatial, .kkt = KktChoice::dense});
  ASSERT_EQ(swept.m(), 5);
  EXPECT_LE(swept.solver().sweeps()->slots(), 4);
  const VectorXd q = start_of(swept).q;
  VectorXd p(3), centre(5);
  p << 0.3, -0.2, 0.1;
  centre << 0.5, -0.25, 2, 3, 5;
  const Solved a = solve(swept, q, p, centre), b = solve(dense, q, p, centre);
  EXPECT_LT(relative_error(a.u, b.u), 1e-12);
  EXPECT_LT(relative_error(a.pdot, b.pdot), 1e-10);
  EXPECT_LT(relative_error(a.sigma.head(2), b.sigma.head(2)), 1e-10);
  EXPECT_EQ(a.sigma.tail(3), centre.tail(3));
  EXPECT_EQ(a.faded, (std::vector<int>{2, 3, 4}));
}

/// Three rows along any axes: two of them say what there is to say. The third direction is the
/// plane's normal, along which the impulse is the centre's.
TEST(CarriedRows, OfABallAreTwoInAnyAxes) {
  for (const Eigen::Vector3d& turn :
       {Eigen::Vector3d(0, 0, 0.4), Eigen::Vector3d(0.7, -0.3, 0.2), Eigen::Vector3d(-2, 1, 1.5)}) {
    Scene scene = equations::example("four_bar");
    scene.loops[0].kind = LoopKind::spherical;
    scene.loops[0].axis.setZero();
    scene.loops[0].rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized());
    const Mechanism swept(scene, {.algebra = Algebra::spatial, .kkt = KktChoice::sweeps}),
        dense(scene, {.algebra = Algebra::spatial, .kkt = KktChoice::dense});
    ASSERT_EQ(swept.m(), 3);
    const VectorXd q = start_of(swept).q;
    VectorXd p(3), centre(3);
    p << 0.3, -0.2, 0.1;
    centre << 0.5, -0.25, 2;
    const Solved a = solve(swept, q, p, centre), b = solve(dense, q, p, centre);
    EXPECT_LT(relative_error(a.u, b.u), 1e-12);
    EXPECT_LT(relative_error(a.pdot, b.pdot), 1e-10);
    EXPECT_EQ(a.faded.size(), 1u);
    const Eigen::Vector3d n = scene.loops[0].rotation.inverse() * Eigen::Vector3d::UnitZ();
    EXPECT_NEAR(a.sigma.dot(n), centre.dot(n), 1e-14);
    const auto across = [&](const VectorXd& sigma) -> VectorXd { return sigma - n * n.dot(sigma); };
    EXPECT_LT(relative_error(across(a.sigma), across(b.sigma)), 1e-10);
  }
}

/// On a body that flies, its crank free or driven: the cycle's first body need not be the ground.
TEST(CarriedRows, OfALinkageThatFliesAreTwo) {
  for (const bool driven : {false, true}) {
    Scene scene = equations::example("four_bar");
    BodySpec base;
    base.name = "base";
    base.mass = 5;
    base.inertia = Eigen::Vector3d(1, 2, 1.5).asDiagonal();
    scene.bodies.push_back(base);
    for (JointSpec& joint : scene.joints)
      if (joint.parent == "ground") joint.parent = "base";
    JointSpec flight = equations::make_joint(JointKind::free, "F", "ground", "base", {0, 0, 0},
                                             {0, 0, 1}, {0.1, 0.2, 0.3, 0.5, 0.5, -0.5, 0.5});
    flight.velocity = {0.3, -0.2, 0.5, 0.7, -0.4, 0.6};
    scene.joints.push_back(flight);
    if (driven) {
      scene.joints[0].position.clear();
      scene.drives.push_back(equations::polynomial("O", {1.5707963267948966, 0.4, 0.3}));
    }
    const Mechanism swept(scene, {.kkt = KktChoice::sweeps}),
        dense(scene, {.kkt = KktChoice::dense});
    EXPECT_LE(swept.solver().sweeps()->slots(), 4);
    const Start start = start_of(swept);
    const VectorXd p = VectorXd::LinSpaced(swept.nv(), -1, 1), none = VectorXd::Zero(5);
    const Solved a = solve(swept, start.q, p, none), b = solve(dense, start.q, p, none);
    EXPECT_LT(relative_error(a.u, b.u), 1e-11) << driven;
    EXPECT_LT(relative_error(a.pdot, b.pdot), 1e-10) << driven;
    EXPECT_EQ(a.faded, b.faded) << driven;
  }
}

TEST(CarriedRows, OfACycleOutOfThePlaneAreAll) {
  const Mechanism bricard_loop(bricard(), {.kkt = KktChoice::sweeps});
  EXPECT_GT(bricard_loop.solver().sweeps()->slots(), 4);
}

}  // namespace
}  // namespace momenta::dae_carried_rows
