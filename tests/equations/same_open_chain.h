#pragma once
// Two scenes without loops are one mechanism in the same coordinates: p = M u and u̇ agree at random
// states, joint by joint.

#include <gtest/gtest.h>
#include <momenta/core/open_chain/open_chain.h>

#include <random>

namespace momenta::equations {

/// Largest relative difference of momenta and accelerations over a few states. Joints stand in the
/// same order in both.
inline double differs(const Scene& one, const Scene& two) {
  OpenChain a(one), b(two);
  EXPECT_EQ(a.nq(), b.nq());
  EXPECT_EQ(a.nv(), b.nv());
  if (a.nq() != b.nq() || a.nv() != b.nv()) return 1;
  std::mt19937 random(7);
  std::normal_distribution<double> any;
  double worst = 0;
  for (int state = 0; state < 4; ++state) {
    Eigen::VectorXd q = a.tree().q0, u(a.nv()), pa(a.nv()), pb(a.nv()), ua(a.nv()), ub(a.nv());
    for (const Tree::Body& body : a.tree().bodies)
      if (body.nq == body.nv)
        for (int i = 0; i < body.nq; ++i) q[body.q + i] = any(random);
    for (double& x : u) x = any(random);
    a.momenta(0, q, u, pa);
    b.momenta(0, q, u, pb);
    EXPECT_TRUE(a.accelerations(0, q, u, ua)) << a.failure();
    EXPECT_TRUE(b.accelerations(0, q, u, ub)) << b.failure();
    worst = std::max({worst, (pa - pb).norm() / pa.norm(), (ua - ub).norm() / ua.norm()});
  }
  return worst;
}

}  // namespace momenta::equations
