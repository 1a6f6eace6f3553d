// Momentum of the whole: L = d/dt of the first moment of mass, by dual numbers along the motion and
// by the slow twin; L and H of a free tree stay, and with gravity they grow as those of one body;
// in a plane as in space.

#include "equations/dense_lagrangian.h"
#include "equations/random_tree.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/open_chain/centroidal_sums.h>
#include <momenta/core/open_chain/open_chain.h>

namespace momenta::core_centroidal {
namespace {

using namespace equations;
using Eigen::Vector3d;

struct Sample {
  OpenChain chain;
  TreeState s;
  Eigen::VectorXd p;
  Sample(const Scene& scene, Algebra algebra, RandomTree& random)
      : chain(scene, algebra), s(random.state(chain.tree())), p(chain.nv()) {
    chain.momenta(s.t, s.q, s.u, p);
  }
  Centroidal centroidal() {
    Centroidal all;
    EXPECT_TRUE(chain.centroidal(s.t, s.q, p, all)) << chain.failure();
    return all;
  }
  double growth() {
    if (chain.nv() == 0) return 1;
    const Eigen::VectorXd m = chain.mass_matrix(s.t, s.q).jacobiSvd().singularValues();
    return m[0] / m[m.size() - 1];
  }
};

double difference(const Vector3d& a, const Vector3d& b) {
  return (a - b).norm() / std::max(1.0, b.norm());
}

/// Trees of every joint with drives, so that what is prescribed counts.
TEST(Centroidal, LinearMomentumIsTheRateOfTheFirstMoment) {
  double worst = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    RandomTree random(seed);
    const Scene scene = random.scene({});
    Sample x(scene, Algebra::spatial, random);
    const Centroidal all = x.centroidal();
    using D = Dual<double, 1>;
    const Model<Spatial> model = build_spatial_model(x.chain.tree(), scene);
    Workspace<Spatial, D> w(model);
    Eigen::VectorXd qdot(x.chain.nq());
    x.chain.coordinate_rates(x.s.q, x.s.u, qdot);
    std::vector<D> q(x.s.q.begin(), x.s.q.end()), u(x.s.u.begin(), x.s.u.end());
    for (std::size_t i = 0; i < q.size(); ++i) q[i].b[0] = qdot[static_cast<Eigen::Index>(i)];
    const auto sums = centroidal_sums(w, D::variable(x.s.t, 0), q.data(), u.data());
    Vector3d rate;
    for (int i = 0; i < 3; ++i) rate[i] = sums.moment[i].b[0];
    worst = equations::larger(worst, difference(all.linear_momentum, rate) / x.growth());
  }
  EXPECT_LT(worst, algebra_tol(12));
}

TEST(Centroidal, IsThatOfTheSlowTwin) {
  double worst = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    RandomTree random(seed);
    const bool flat = seed % 3 == 0;
    const Scene scene = flat ? random.planar_scene({}) : random.scene({});
    Sample x(scene, flat ? Algebra::planar : Algebra::spatial, random);
    const Centroidal all = x.centroidal();
    const DenseLagrangian twin(scene, x.chain.tree());
    const std::vector<Real> q(x.s.q.begin(), x.s.q.end()), u(x.s.u.begin(), x.s.u.end());
    const auto momenta = twin.body_momenta<Real>(twin.moving<Real>(x.s.t, q, u, true));
    const auto poses = twin.poses(x.s.t, x.s.q);
    Vector3d linear = Vector3d::Zero(), angular = linear, moment = linear;
    double mass = 0;
    for (std::size_t k = 0; k < momenta.size(); ++k) {
      const BodySpec& body = scene.bodies[k];
      mass += body.mass;
      moment += body.mass * (poses[k] * body.com);
      for (std::size_t i = 0; i < 3; ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        linear[row] += static_cast<double>(momenta[k].f[i]);
        angular[row] += static_cast<double>(momenta[k].n[i]);
      }
    }
    EXPECT_NEAR(all.mass, mass, algebra_tol(3) * mass);
    worst = std::max({worst, difference(all.centre, moment / mass),
                      difference(all.linear_momentum, linear) / x.growth(),
                      difference(all.angular_momentum, angular) / x.growth()});
  }
  EXPECT_LT(worst, algebra_tol(12));
}

/// A tree on a free body alone: four hundred Runge-Kutta steps of 0.1 ms, whose own error h⁴ is far
/// below rounding.
void follow(const Vector3d& gravity) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    RandomTree random(seed);
    Scene scene = random.scene({.bodies = 5, .drives = false, .body_forces = false});
    JointSpec& base = scene.joints.front();
    for (JointSpec& j : scene.joints)
      if (j.parent == "ground" && &j != &base) j.parent = base.child;
    ASSERT_EQ(base.parent, "ground");
    base.kind = JointKind::free;
    base.pitch = base.stiffness = base.rest = base.damping = 0;
    base.rotor_inertia.clear();
    base.axis2.setZero();
    base.direction.setZero();
    std::erase_if(scene.forces, [&](const ForceSpec& f) { return f.joint == base.name; });
    scene.gravity = gravity;
    Sample x(scene, Algebra::automatic, random);
    const Centroidal before = x.centroidal();
    const int nq = x.chain.nq(), nv = x.chain.nv();
    Eigen::VectorXd y(nq + nv), rate(nq + nv);
    y << x.s.q, x.p;
    const auto f = [&](const Eigen::VectorXd& at) -> const Eigen::VectorXd& {
      EXPECT_TRUE(x.chain.rates(0, at.head(nq), at.tail(nv), rate.head(nq), rate.tail(nv)));
      return rate;
    };
    constexpr int steps = 400;
    constexpr double h = 1e-4, end = steps * h;
    for (int i = 0; i < steps; ++i) {
      const Eigen::VectorXd a = f(y), b = f(y + h / 2 * a), c = f(y + h / 2 * b), d = f(y + h * c);
      y += h / 6 * (a + 2 * b + 2 * c + d);
    }
    x.s.q = y.head(nq);
    x.p = y.tail(nv);
    const Centroidal after = x.centroidal();
    // c moves along a parabola, and the weight acts there.
    const Vector3d weight = before.mass * gravity, L = before.linear_momentum,
                   c = before.centre + end / before.mass * L + end * end / 2 * gravity;
    const Vector3d arm = end * before.centre + end * end / (2 * before.mass) * L;  // ∫ c dt × g
    const double rounding = algebra_tol(10) * std::sqrt(steps) * x.growth();
    EXPECT_LT(difference(after.centre, c), rounding) << "seed " << seed;
    EXPECT_LT(difference(after.linear_momentum, L + end * weight), rounding) << "seed " << seed;
    EXPECT_LT(difference(after.angular_momentum, before.angular_momentum + arm.cross(weight)),
              rounding)
        << "seed " << seed;
  }
}
TEST(Centroidal, OfAFreeTreeStays) {
  follow(Vector3d::Zero());
}
TEST(Centroidal, OfAFreeTreeFallsAsOneBody) {
  follow({0.3, -9.81, 2});
}

TEST(Centroidal, OfAJointWithoutInertiaIsNone) {
  RandomTree random(3);
  Scene scene = random.scene(
      {.bodies = 1, .kinds = {JointKind::revolute}, .drives = false, .body_forces = false});
  scene.joints[0].rotor_inertia.clear();
  scene.bodies[0].mass = 0;
  scene.bodies[0].inertia.setZero();
  OpenChain chain(scene, Algebra::spatial);
  Centroidal all;
  EXPECT_FALSE(chain.centroidal(0, chain.tree().q0, Eigen::VectorXd::Ones(chain.nv()), all));
  EXPECT_FALSE(chain.failure().empty());
}

}  // namespace
}  // namespace momenta::core_centroidal
