// The other two classical algorithms: inverse dynamics τ(q, u, u̇, t), and u̇ by the mass matrix
// itself, from composite bodies. Against d'Alembert's principle in its dense form and against the
// recursions; what they cost.

#include "equations/decompositions.h"
#include "equations/dense_lagrangian.h"
#include "equations/random_tree.h"
#include "equations/recursions.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/kernel/composite_sweeps.h>
#include <momenta/core/kernel/mass_matrix.h>
#include <momenta/core/scalar/counted.h>

#include <cstdlib>
#include <new>

#if !defined(__SANITIZE_ADDRESS__)

namespace {
long allocations = 0;

void* counted(std::size_t size) {
  ++allocations;
  void* p = std::malloc(size > 0 ? size : 1);
  if (p == nullptr) throw std::bad_alloc();
  return p;
}
}  // namespace

__attribute__((weak)) void* operator new(std::size_t size) {
  return counted(size);
}
__attribute__((weak)) void* operator new[](std::size_t size) {
  return counted(size);
}
__attribute__((weak)) void operator delete(void* p) noexcept {
  std::free(p);
}
__attribute__((weak)) void operator delete[](void* p) noexcept {
  std::free(p);
}
__attribute__((weak)) void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
__attribute__((weak)) void operator delete[](void* p, std::size_t) noexcept {
  std::free(p);
}

#endif

namespace momenta::core_comparators {
namespace {

using namespace equations;

struct Worst {
  double accelerations = 0, forces = 0, round_trip = 0, masses = 0;
};

/// How much rounding in forces of size |M| |u̇| may move u̇, up to |M⁻¹| |M| |u̇| ε.
template <class Matrix, class Vector>
double growth_of(const Matrix& m, const Vector& udot) {
  const LongVector moved =
      spread_by_inverse(m.template cast<long double>(),
                        (m.cwiseAbs() * udot.cwiseAbs()).template cast<long double>());
  return std::max(1.0, static_cast<double>(moved.maxCoeff()) /
                           std::max(1.0, static_cast<double>(udot.cwiseAbs().maxCoeff())));
}

template <class Entries>
Eigen::MatrixXd symmetric(int n, Entries&& entries) {
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(n, n);
  entries([&](int row, int column, double value) { m(row, column) = m(column, row) = value; });
  return m;
}

void compare(const Scene& scene, RandomTree& random, Worst& worst) {
  const Tree tree = build_tree(scene);
  if (tree.nv == 0) return;
  const TreeState s = random.state(tree);
  const Model<Spatial> model = build_spatial_model(tree, scene);
  const LinkTree links = build_links(model);
  Workspace<Spatial, double> w(model);
  const double *q = s.q.data(), *u = s.u.data();
  const auto note = [](double& most, double error) { most = equations::larger(most, error); };

  // u̇ by M and by the articulated recursion.
  applied_forces(w, s.t, q, u);
  const Eigen::VectorXd tau = Eigen::Map<Eigen::VectorXd>(w.generalised.data(), tree.nv);
  Eigen::VectorXd udot(tree.nv), articulated(tree.nv), back(tree.nv);
  CompositeSweeps<Spatial, double> composite(links);
  AccelerationSweeps<Spatial, double> acceleration(links);
  InverseDynamicsSweeps<Spatial, double> inverse(links);
  ASSERT_TRUE(composite(s.t, q, u, tau.data(), udot.data()));
  ASSERT_TRUE(acceleration(s.t, q, u, tau.data(), articulated.data()));
  const DenseLagrangian twin(scene, tree);
  const RealVector expected = twin.accelerations(s.t, s.q, s.u);
  const RealMatrix m = twin.mass_matrix(s.t, s.q);
  const double growth = growth_of(m, expected);
  note(worst.accelerations, over_growth(relative_error(udot, expected.cast<double>()), growth));
  note(worst.accelerations, over_growth(relative_error(udot, articulated), growth));

  // τ(u̇(τ)) = τ, and τ of any u̇: M u̇ + bias, the bias known from the motion that τ causes.
  const auto size = [&](const RealVector& rates) {
    return std::max(1.0, static_cast<double>((m.cwiseAbs() * rates.cwiseAbs()).maxCoeff()));
  };
  const double forces = size(expected);
  inverse(s.t, q, u, udot.data(), back.data());
  note(worst.round_trip, relative_error(back, tau, forces));
  Eigen::VectorXd any(tree.nv);
  for (int i = 0; i < tree.nv; ++i) any[i] = random.uniform(-5, 5);
  inverse(s.t, q, u, any.data(), back.data());
  const RealVector change = any.cast<Real>() - expected;
  const RealVector known = m * change + tau.cast<Real>();
  note(worst.forces, relative_error(back, known.cast<double>(), std::max(forces, size(change))));

  // M, all of it.
  const Eigen::MatrixXd dense = m.cast<double>(), own = symmetric(tree.nv, [&](auto&&entry) {
                                                    composite.mass_matrix(s.t, q, entry);
                                                  });
  poses_outward(w, s.t, q, false);
  const Eigen::MatrixXd again =
      symmetric(tree.nv, [&](auto&& entry) { mass_matrix_inward(w, entry); });
  note(worst.masses, relative_error(own, dense));
  note(worst.masses, relative_error(own, again));
}

void sweep(const TreeRecipe& recipe, int trees, unsigned seed) {
  Worst worst;
  for (int i = 0; i < trees; ++i) {
    RandomTree random(seed + static_cast<unsigned>(i));
    const Scene scene = random.scene(recipe);
    compare(scene, random, worst);
    if (testing::Test::HasFatalFailure()) return;
  }
  const double tolerance = algebra_tol(2 * recipe.bodies);
  for (const auto& [name, value] :
       {std::pair{"accelerations", worst.accelerations}, std::pair{"forces", worst.forces},
        std::pair{"round_trip", worst.round_trip}, std::pair{"masses", worst.masses}}) {
    EXPECT_LT(value, tolerance) << name;
    testing::Test::RecordProperty(name, std::to_string(value * 1e16) + "e-16");
  }
}

TEST(Comparators, Revolute) {
  sweep({.kinds = {JointKind::revolute}, .drives = false, .body_forces = false}, 40, 100);
}
TEST(Comparators, RevoluteAtRightAngles) {
  sweep({.placing = Placing::right_angles, .kinds = {JointKind::revolute}, .drives = false}, 40,
        150);
}
TEST(Comparators, Prismatic) {
  sweep({.kinds = {JointKind::revolute, JointKind::prismatic}, .drives = false}, 40, 200);
}
TEST(Comparators, Helical) {
  sweep({.kinds = {JointKind::helical}, .drives = false}, 30, 250);
}
TEST(Comparators, Spherical) {
  sweep({.kinds = {JointKind::spherical, JointKind::revolute}, .drives = false}, 30, 300);
}
TEST(Comparators, Free) {
  sweep({.bodies = 4, .kinds = {JointKind::free, JointKind::revolute}, .drives = false}, 30, 350);
}
TEST(Comparators, ChainsForJoints) {
  sweep({.kinds = {JointKind::cylindrical, JointKind::universal, JointKind::planar}}, 40, 400);
}
TEST(Comparators, Drives) {
  sweep({.kinds = {JointKind::revolute, JointKind::prismatic, JointKind::helical}}, 60, 500);
}
TEST(Comparators, DrivenSphericalAndFreeJoints) {
  sweep({.kinds = {JointKind::revolute, JointKind::spherical, JointKind::free}}, 40, 5600);
}
TEST(Comparators, MixedTrees) {
  sweep({}, 100, 600);
}
TEST(Comparators, MixedTreesAtRightAngles) {
  sweep({.placing = Placing::right_angles, .body_forces = false}, 60, 700);
}
TEST(Comparators, MixedChains) {
  sweep({.branching = Branching::serial}, 40, 800);
}
TEST(Comparators, MixedStars) {
  sweep({.bodies = 8, .branching = Branching::star}, 20, 900);
}
TEST(Comparators, NearlyParallelAxes) {
  sweep({.placing = Placing::degenerate}, 40, 1000);
}

/// Revolute joints in series and some in parallel, bodies of one size.
Scene revolutes(unsigned seed, int n, Branching branching, Placing placing = Placing::general) {
  return RandomTree(seed).scene({.bodies = n,
                                 .branching = branching,
                                 .placing = placing,
                                 .kinds = {JointKind::revolute},
                                 .drives = false,
                                 .joint_forces = false,
                                 .body_forces = false});
}

// Far beyond where anyone would form M: both routes to u̇ agree as well as M allows, and the
// entries of M are those of the staged sweep.
TEST(Comparators, ChainsOf200Bodies) {
  double most = 0, masses = 0;
  for (const Placing placing : {Placing::general, Placing::right_angles}) {
    const Scene scene = revolutes(7, 200, Branching::serial, placing);
    RandomTree random(8);
    const Tree tree = build_tree(scene);
    const TreeState s = random.state(tree);
    const Model<Spatial> model = build_spatial_model(tree, scene);
    const LinkTree links = build_links(model);
    CompositeSweeps<Spatial, double> composite(links);
    AccelerationSweeps<Spatial, double> acceleration(links);
    InverseDynamicsSweeps<Spatial, double> inverse(links);
    EXPECT_EQ(composite.entries(), 200u * 201u / 2);
    Eigen::VectorXd tau(tree.nv), udot(tree.nv), articulated(tree.nv), back(tree.nv);
    for (int i = 0; i < tree.nv; ++i) tau[i] = random.uniform(-10, 10);
    const double *q = s.q.data(), *u = s.u.data();
    ASSERT_TRUE(composite(s.t, q, u, tau.data(), udot.data()));
    ASSERT_TRUE(acceleration(s.t, q, u, tau.data(), articulated.data()));
    Workspace<Spatial, double> w(model);
    poses_outward(w, s.t, q, false);
    const Eigen::MatrixXd m =
        symmetric(tree.nv, [&](auto&& entry) { mass_matrix_inward(w, entry); });
    const Eigen::MatrixXd own =
        symmetric(tree.nv, [&](auto&& entry) { composite.mass_matrix(s.t, q, entry); });
    masses = equations::larger(masses, relative_error(own, m));
    most = equations::larger(
        most, over_growth(relative_error(udot, articulated), growth_of(m, articulated), 1e6));
    const double forces = (m.cwiseAbs() * articulated.cwiseAbs()).maxCoeff();
    inverse(s.t, q, u, articulated.data(), back.data());
    most = equations::larger(most, relative_error(back, tau, forces));
  }
  EXPECT_LT(most, algebra_tol(200));
  EXPECT_LT(masses, algebra_tol(200));
  RecordProperty("most", std::to_string(most * 1e16) + "e-16");
  RecordProperty("masses", std::to_string(masses * 1e16) + "e-16");
}

TEST(Comparators, RoomForEntriesOnOneWayToTheRootOnly) {
  // A star of one body and seven on it: 1 + 7 · 2.
  const Scene scene = revolutes(3, 8, Branching::star);
  const Model<Spatial> model = build_spatial_model(build_tree(scene), scene);
  EXPECT_EQ((CompositeSweeps<Spatial, double>(build_links(model)).entries()), 15u);
}

TEST(Comparators, NameTheJointWithoutInertia) {
  const double at_rest[4] = {1, 0, 0, 0}, none[3] = {0, 0, 0}, *q = at_rest, *zero = none;
  double udot[3];
  Scene scene = revolutes(3, 1, Branching::serial);
  for (JointSpec& j : scene.joints) j.rotor_inertia.clear();
  BodySpec& body = scene.bodies[0];
  JointSpec& joint = scene.joints[0];
  joint.kind = JointKind::spherical;
  joint.origin_child.setZero();
  joint.rotation = Eigen::Quaterniond(0.9, 0.1, 0.3, -0.2).normalized();
  const auto moves = [&] {
    const Model<Spatial> model = build_spatial_model(build_tree(scene), scene);
    const LinkTree links = build_links(model);
    CompositeSweeps<Spatial, double> composite(links);
    const bool ok = composite(0.0, q, zero, zero, udot);
    EXPECT_EQ(composite.singular_joint(), ok ? -1 : 0);
    return ok;
  };
  EXPECT_TRUE(moves());
  const Eigen::Vector3d along = Eigen::Vector3d(0.3, -0.5, 0.7).normalized();
  body.com = 0.5 * along;  // a rod without thickness, however it lies
  body.inertia = Eigen::Matrix3d::Identity() - along * along.transpose();
  EXPECT_FALSE(moves());
  joint.kind = JointKind::revolute;
  joint.axis = along;
  body.com.setZero();
  body.inertia.setZero();
  EXPECT_FALSE(moves());
}

TEST(Comparators, TakeNoMemory) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the heap is the sanitizer's";
#else
  const long before = allocations;
  ::operator delete(::operator new(8));  // a call, which no compiler may leave out
  if (allocations == before) GTEST_SKIP() << "another operator new is linked in";
  RandomTree random(21);
  const Scene scene = random.scene({.bodies = 20});
  const Tree tree = build_tree(scene);
  const TreeState s = random.state(tree);
  const Model<Spatial> model = build_spatial_model(tree, scene);
  const LinkTree links = build_links(model);
  CompositeSweeps<Spatial, double> composite(links);
  InverseDynamicsSweeps<Spatial, double> inverse(links);
  Eigen::VectorXd tau = Eigen::VectorXd::Ones(tree.nv), udot(tree.nv);
  const long at = allocations;
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(composite(s.t, s.q.data(), s.u.data(), tau.data(), udot.data()));
    inverse(s.t, s.q.data(), s.u.data(), udot.data(), tau.data());
  }
  EXPECT_EQ(allocations, at);
#endif
}

TEST(Comparators, StatesSideBySide) {
  using Two = Pack<2, 1>;
  for (unsigned seed = 0; seed < 20; ++seed) {
    RandomTree random(seed);
    const Scene scene = random.scene({});
    const Tree tree = build_tree(scene);
    const Model<Spatial> model = build_spatial_model(tree, scene);
    const LinkTree links = build_links(model);
    CompositeSweeps<Spatial, double> one(links);
    CompositeSweeps<Spatial, Two> two(links);
    InverseDynamicsSweeps<Spatial, Two> inverse(links);
    const auto n = static_cast<std::size_t>(tree.nv);
    std::vector<Two> q(static_cast<std::size_t>(tree.nq)), u(n), tau(n, Two(0.3)), udot(n), back(n);
    std::vector<double> expected(n);
    TreeState s = random.state(tree);
    for (int lane = 0; lane < 2; ++lane) {
      const double t = s.t;
      s = random.state(tree);
      s.t = t;
      for (std::size_t i = 0; i < q.size(); ++i)
        q[i].set_lane(lane, s.q[static_cast<Eigen::Index>(i)]);
      for (std::size_t i = 0; i < n; ++i) u[i].set_lane(lane, s.u[static_cast<Eigen::Index>(i)]);
    }
    ASSERT_TRUE(two(Two(s.t), q.data(), u.data(), tau.data(), udot.data()));
    inverse(Two(s.t), q.data(), u.data(), udot.data(), back.data());
    const std::vector<double> pull(n, 0.3);
    ASSERT_TRUE(one(s.t, s.q.data(), s.u.data(), pull.data(), expected.data()));
    double size = 1;
    for (const double x : expected) size = std::max(size, std::abs(x));
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_NEAR(udot[i].lane(1), expected[i], 1e-11 * size) << seed;
      EXPECT_NEAR(back[i].lane(0), 0.3, 1e-11 * size) << seed;
      EXPECT_NEAR(back[i].lane(1), 0.3, 1e-11 * size) << seed;
    }
  }
}

struct Costs {
  long inverse = 0, composite = 0, articulated = 0;
};
/// Executed operations of a chain of n revolute joints whose axes lean by `lean` from one to the
/// next.
Costs operations(int n, double lean) {
  Scene scene = revolutes(5, n, Branching::serial);
  for (JointSpec& j : scene.joints) {
    j.axis = {0, 0, 1};
    j.origin_child.setZero();
    j.origin_parent = {0.5, 0.1, 0.2};
    j.rotation = Eigen::AngleAxisd(lean, Eigen::Vector3d::UnitX());
    j.rotor_inertia.clear();
  }
  const Tree tree = build_tree(scene);
  const Model<Spatial> model = build_spatial_model(tree, scene);
  const LinkTree links = build_links(model);
  const std::vector<Counted> q(static_cast<std::size_t>(n), Counted::variable(0.3)), u = q, tau = q;
  std::vector<Counted> result(q.size());
  const Counted t(0.0);
  const auto count = [&](auto&& run) {
    Counted::count = {};
    run();
    return Counted::count.executed.total();
  };
  InverseDynamicsSweeps<Spatial, Counted> inverse(links);
  CompositeSweeps<Spatial, Counted> composite(links);
  AccelerationSweeps<Spatial, Counted> articulated(links);
  return {count([&] { inverse(t, q.data(), u.data(), tau.data(), result.data()); }),
          count([&] { composite(t, q.data(), u.data(), tau.data(), result.data()); }),
          count([&] { articulated(t, q.data(), u.data(), tau.data(), result.data()); })};
}

// A body adds the same number to inverse dynamics, the constant angle of its frame among them. M
// and its elimination grow with the cube of the depth and no faster: fourth differences vanish.
TEST(Comparators, Operations) {
  const double right = std::acos(0.0);
  for (const auto& [name, lean, slope] :
       {std::tuple{"leaning", 0.8, 151L}, {"right", right, 121L}}) {
    std::vector<Costs> of;
    for (int n = 0; n <= 10; ++n) of.push_back(n < 6 ? Costs{} : operations(n, lean));
    EXPECT_LE(of[7].inverse - of[6].inverse, slope) << name;
    EXPECT_EQ(of[10].inverse - of[7].inverse, 3 * (of[7].inverse - of[6].inverse)) << name;
    EXPECT_EQ(of[10].composite + 6 * of[8].composite + of[6].composite,
              4 * (of[9].composite + of[7].composite))
        << name;
    EXPECT_LT(of[6].composite, of[6].articulated) << name;
    const Costs many = operations(40, lean);
    EXPECT_GT(many.composite, many.articulated) << name;
    for (const auto& [n, costs] : {std::pair{6, of[6]}, {10, of[10]}, {40, many}}) {
      const std::string at = std::string(name) + "_" + std::to_string(n) + "_";
      RecordProperty(at + "inverse", std::to_string(costs.inverse));
      RecordProperty(at + "composite", std::to_string(costs.composite));
      RecordProperty(at + "articulated", std::to_string(costs.articulated));
    }
  }
}

}  // namespace
}  // namespace momenta::core_comparators
