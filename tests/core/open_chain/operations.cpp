// Operations are counted right, grow by the same number for every body, and stay at or below what
// the documentation promises.
#include <gtest/gtest.h>
#include <momenta/core/open_chain/operations.h>

#include <cmath>

#include "equations/parts.h"

namespace momenta::core_operations {
namespace {

TEST(Counted, FoldsConstants) {
  Counted::count = {};
  const Counted x = Counted::variable(2), two(2.0), zero(0.0), one(1.0);
  const Counted y = (x + zero) * one + two * two + zero * x;
  EXPECT_EQ(y.value(), 6);
  EXPECT_EQ(Counted::count.executed.adds, 3);
  EXPECT_EQ(Counted::count.executed.multiplications, 3);
  EXPECT_EQ(Counted::count.needed.adds, 1);  // x + 4
  EXPECT_EQ(Counted::count.needed.multiplications, 0);
  const Counted z = -x / x;
  EXPECT_EQ(z.value(), -1);
  EXPECT_EQ(Counted::count.needed.divisions, 1);
}

/// A chain of revolute joints whose axes lean by `lean` from one to the next.
Scene chain(int n, double lean, bool off_axis = true) {
  Scene s;
  s.gravity = {0.3, -9, 0.2};
  if (lean == 0) s.gravity = {0, -9.81, 0};
  for (int i = 0; i < n; ++i) {
    BodySpec b;
    b.name = "b" + std::to_string(i);
    b.mass = 1 + 0.01 * i;
    b.com = {0.4, 0.1, off_axis && lean != 0 ? 0.2 : 0};
    b.inertia << 0.3, 0.02, 0.01, 0.02, 0.4, 0.03, 0.01, 0.03, 0.5;
    s.bodies.push_back(b);
    JointSpec j = equations::make_joint(JointKind::revolute, "J" + std::to_string(i),
                                        i == 0 ? "ground" : "b" + std::to_string(i - 1), b.name,
                                        {0.5, 0.1, lean == 0 ? 0 : 0.2});
    if (i > 0) j.rotation = Eigen::AngleAxisd(lean, Eigen::Vector3d::UnitX());
    s.joints.push_back(j);
  }
  return s;
}

OperationCount count(const Scene& scene, Recursion recursion) {
  const Tree tree = build_tree(scene);
  return count_operations(tree, scene, make_plan(tree, scene), recursion);
}

struct Promise {
  double lean;
  Recursion recursion;
  long slope;  ///< executed operations a body adds, the constant angle of its frame among them
};

TEST(Operations, GrowByTheSameNumberAndNoMore) {
  const double right = std::acos(0.0);
  for (const Promise& promise :
       {Promise{0.8, Recursion::momentum, 334}, Promise{0.8, Recursion::acceleration, 410},
        Promise{right, Recursion::momentum, 253}, Promise{right, Recursion::acceleration, 329},
        Promise{0, Recursion::momentum, 69}, Promise{0, Recursion::acceleration, 72}}) {
    const auto at = [&](int n) {
      return count(chain(n, promise.lean), promise.recursion).executed.total();
    };
    const long slope = at(7) - at(6);
    EXPECT_EQ(at(12) - at(7), 5 * slope) << "lean " << promise.lean;
    EXPECT_LE(slope, promise.slope) << "lean " << promise.lean;
  }
}

TEST(Operations, MomentumTakesFewerThanAcceleration) {
  for (const int n : {3, 6, 12}) {
    const Scene scene = chain(n, 0.8);
    EXPECT_LT(count(scene, Recursion::momentum).executed.total(),
              count(scene, Recursion::acceleration).executed.total());
    EXPECT_LE(count(scene, Recursion::momentum).needed.total(),
              count(scene, Recursion::momentum).executed.total());
    EXPECT_LT(count(scene, Recursion::momentum).executed.total(), 363 * n - 300);  // the paper's
  }
}

}  // namespace
}  // namespace momenta::core_operations
