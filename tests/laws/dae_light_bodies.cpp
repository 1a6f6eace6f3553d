// Bodies 10⁻¹² to 10¹² times as heavy as their neighbours, at every place of a loop: wherever the
// plan leaves a mechanism to the sweeps, they agree with themselves in quadruple precision.

#include "equations/linkages.h"
#include "equations/quad_loops.h"

#include <gtest/gtest.h>
#include <momenta/dae/factor/faded_pivot.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/leaves_first.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>

namespace momenta::dae_light_bodies {
namespace {

using Eigen::VectorXd;

// ω is a backward error: of the rates it is off by as much times their condition.
constexpr double condition = 100;

/// Of u for three momenta of random motions, relative to the largest rate.
double error_of(const Mechanism& mechanism) {
  const auto e = mechanism.evaluation<double>();
  const auto solver = make_loop_solver(mechanism, *e);
  const VectorXd& q = mechanism.tree().q0;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  VectorXd v(mechanism.nv()), p(mechanism.nv()), u(mechanism.nv()), sigma(mechanism.m());
  double worst = 0;
  for (int motion = 0; motion < 3; ++motion) {
    for (double& x : v) x = any(random);
    e->place(0, q.data());
    e->move(v.data());
    e->momenta(nullptr, p.data());
    EXPECT_TRUE(solver->momentum(0, q.data(), p.data(), nullptr, fade_evaluation, 0, u.data(),
                                 sigma.data(), nullptr));
    const VectorXd exact = quad_rates(mechanism, q, p, v, 0, 1e-22).u;
    worst = std::max(worst, (u - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff());
  }
  return worst;
}

/// Each body in turn, by each power of ten. Returns how many of these the sweeps carry.
int swept_of(const Scene& scene) {
  int swept = 0;
  for (std::size_t body = 0; body < scene.bodies.size(); ++body)
    for (int power = -12; power <= 12; power += 3) {
      Scene other = scene;
      other.bodies[body].mass *= std::pow(10, power);
      other.bodies[body].inertia *= std::pow(10, power);
      const Mechanism mechanism(other);
      if (mechanism.kkt() != KktChoice::sweeps) {
        EXPECT_NE(power, 0);
        continue;
      }
      ++swept;
      EXPECT_LT(error_of(mechanism), condition * most_leaves_first_error)
          << scene.name << ", " << scene.bodies[body].name << " 10^" << power;
    }
  return swept;
}

TEST(LightBodies, SweepsAgreeWithQuadruplePrecision) {
  EXPECT_GT(swept_of(equations::row_of_four_bars(2, 1.2)), 30);
  EXPECT_GT(swept_of(equations::bricard()), 30);
  EXPECT_GT(swept_of(equations::platform(5)), 50);  // six legs are folded, which have no quad
}

/// Pairs of crossed bars, one on another, held at one end of the first; the other end on a slide.
Scene ladder_on_a_slide(int pairs, double foot) {
  using std::numbers::pi;
  Scene s;
  s.gravity = {0, -9.81, 0};
  const double tilt = 0.6, cross = pi - 2 * tilt;
  const auto bar = [&](const std::string& name, double centre) {
    BodySpec b = equations::rod(name);
    b.com = {centre, 0, 0};
    b.inertia = Eigen::Vector3d(0, 4.0 / 12, 4.0 / 12).asDiagonal();
    s.bodies.push_back(b);
  };
  for (int i = 0; i < pairs; ++i) {
    const std::string n = std::to_string(i), below = std::to_string(i - 1);
    bar("a" + n, 1);
    bar("b" + n, 0);
    s.joints.push_back(i == 0 ? equations::hinge("A0", "ground", "a0", {0, 0, 0}, tilt)
                              : equations::hinge("A" + n, "b" + below, "a" + n, {1, 0, 0}, -cross));
    s.joints.push_back(equations::hinge("B" + n, "a" + n, "b" + n, {1, 0, 0}, cross));
    if (i == 0) continue;
    LoopSpec c;
    c.name = "C" + n;
    c.kind = LoopKind::revolute;
    c.parent = "a" + below;
    c.child = "b" + n;
    c.origin_parent = {2, 0, 0};
    c.origin_child = {-1, 0, 0};
    s.loops.push_back(c);
  }
  BodySpec slide;
  slide.name = "foot";
  slide.mass = foot;
  s.bodies.push_back(slide);
  JointSpec along;
  along.name = "S";
  along.kind = JointKind::prismatic;
  along.parent = "ground";
  along.child = "foot";
  along.axis = {1, 0, 0};
  along.position = {2 * std::cos(tilt)};
  s.joints.push_back(along);
  LoopSpec end;
  end.name = "F";
  end.kind = LoopKind::revolute;
  end.parent = "foot";
  end.child = "b0";
  end.origin_child = {-1, 0, 0};
  s.loops.push_back(end);
  return s;
}

TEST(LightBodies, ALightSlideUnderALadderIsSwept) {
  for (const double foot : {0.2, 2e5}) {
    const Mechanism mechanism(ladder_on_a_slide(200, foot));
    ASSERT_EQ(mechanism.kkt(), KktChoice::sweeps) << foot;
    EXPECT_LT(error_of(mechanism), condition * most_leaves_first_error) << foot;
  }
}

}  // namespace
}  // namespace momenta::dae_light_bodies
