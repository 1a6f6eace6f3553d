// One kernel for every scalar: long double, dual numbers, dual numbers of long double; joints
// without inertia; what a call may allocate.

#include "equations/decompositions.h"
#include "equations/dense_lagrangian.h"
#include "equations/random_tree.h"
#include "equations/recursions.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/kernel/accelerations.h>
#include <momenta/core/kernel/momentum_recursion.h>
#include <momenta/core/open_chain/open_chain.h>

#include <cstdlib>

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
#define MOMENTA_COUNTS_MALLOC
namespace {
long allocations = 0;
}
extern "C" void* __libc_malloc(std::size_t);  // NOLINT: glibc's own
/// Takes the place of the library's for the whole program; operator new and Eigen end here.
extern "C" void* malloc(std::size_t size) noexcept {
  ++allocations;
  return __libc_malloc(size);
}
extern "C" void* __libc_memalign(std::size_t, std::size_t);  // NOLINT
extern "C" void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  ++allocations;
  return __libc_memalign(alignment, size);
}
#endif

namespace momenta::core_kernel_scalars {
namespace {

using namespace equations;

template <class S>
std::vector<S> lifted(const Eigen::VectorXd& x) {
  std::vector<S> r;
  for (const double value : x) r.push_back(S(value));
  return r;
}

/// q̇ and ṗ of scalar S, as plain numbers.
template <class Space, class S>
Eigen::VectorXd rates_with(const Model<Space>& model, const TreeState& s,
                           const Eigen::VectorXd& p) {
  Workspace<Space, S> w(model);
  const auto q = lifted<S>(s.q), momenta = lifted<S>(p);
  std::vector<S> u(momenta.size()), pdot(momenta.size());
  EXPECT_TRUE(
      equations::momentum_recursion(w, S(s.t), q.data(), momenta.data(), u.data(), pdot.data()));
  Eigen::VectorXd all(2 * p.size());
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    all[i] = value_of(u[static_cast<std::size_t>(i)]);
    all[p.size() + i] = value_of(pdot[static_cast<std::size_t>(i)]);
  }
  return all;
}

template <class Space>
void compare_scalars(const Model<Space>& model, const TreeState& s) {
  Workspace<Space, double> w(model);
  Eigen::VectorXd p(s.u.size());
  momenta_from_rates(w, s.t, s.q.data(), s.u.data(), p.data());
  const Eigen::VectorXd plain = rates_with<Space, double>(model, s, p);
  // the value of a dual number goes through the same operations up to the order of a division
  EXPECT_LT(relative_error(rates_with<Space, Dual8>(model, s, p), plain), 100 * algebra_tol(5));
  const Eigen::VectorXd longer = rates_with<Space, long double>(model, s, p);
  EXPECT_LT(relative_error(longer, plain), 100 * algebra_tol(5));
  const Eigen::VectorXd dual = rates_with<Space, Dual<long double, 1>>(model, s, p);
  EXPECT_LT(relative_error(dual, longer), algebra_tol(1));
}

TEST(KernelScalars, AgreeInSpaceAndPlane) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    RandomTree random(seed);
    const Scene scene = random.scene({.bodies = 5});
    const Tree tree = build_tree(scene);
    compare_scalars(build_spatial_model(tree, scene), random.state(tree));
    const Scene flat = random.planar_scene({.bodies = 5});
    const Tree flat_tree = build_tree(flat);
    compare_scalars(build_planar_model(flat_tree, flat, *find_plane(flat_tree, flat).basis),
                    random.state(flat_tree));
  }
}

/// A body without mass in the middle is fine as long as what it carries has inertia along every
/// joint: every pair of kinds on both sides of one. Two joints with more than six degrees of
/// freedom between them leave it loose; so do two spherical joints, which turn about the line
/// between them, two planar joints, which slide along the line common to their planes, and one of
/// each. The inner joint is named.
TEST(Kernel, MasslessBodiesBetweenAllKinds) {
  const JointKind kinds[] = {JointKind::revolute,    JointKind::prismatic, JointKind::helical,
                             JointKind::cylindrical, JointKind::universal, JointKind::spherical,
                             JointKind::planar,      JointKind::free,      JointKind::weld};
  double worst = 0;
  unsigned seed = 0;
  for (const JointKind inner : kinds)
    for (const JointKind outer : kinds) {
      RandomTree random(++seed);
      Scene scene = random.scene({.bodies = 3,
                                  .branching = Branching::serial,
                                  .kinds = {JointKind::revolute},
                                  .drives = false,
                                  .joint_forces = false,
                                  .rotors = false});
      scene.bodies[1].mass = 0;
      scene.bodies[1].inertia.setZero();
      for (const auto& [joint, kind] : {std::pair{1, inner}, std::pair{2, outer}}) {
        scene.joints[static_cast<std::size_t>(joint)].kind = kind;
        if (kind == JointKind::helical) scene.joints[static_cast<std::size_t>(joint)].pitch = 0.3;
      }
      const auto of_three = [](JointKind kind) { return rates_of(kind) == 3; };
      const bool loose =
          rates_of(inner) + rates_of(outer) > 6 || (of_three(inner) && of_three(outer));
      OpenChain chain(scene, Algebra::spatial);
      const DenseLagrangian twin(scene, chain.tree());
      const TreeState s = random.state(chain.tree());
      Eigen::VectorXd qdot(chain.nq()), pdot(chain.nv()), udot(chain.nv());
      const Eigen::VectorXd p = twin.momenta_at(s.t, s.q, s.u).cast<double>();
      if (loose) {
        EXPECT_FALSE(chain.rates(s.t, s.q, p, qdot, pdot))
            << static_cast<int>(inner) << " " << static_cast<int>(outer);
        EXPECT_NE(chain.failure().find("'joint1'"), std::string::npos) << chain.failure();
        continue;
      }
      ASSERT_TRUE(chain.rates(s.t, s.q, p, qdot, pdot))
          << static_cast<int>(inner) << " " << static_cast<int>(outer) << chain.failure();
      ASSERT_TRUE(chain.accelerations(s.t, s.q, s.u, udot)) << chain.failure();
      const RealMatrix m = twin.mass_matrix(s.t, s.q);
      const double growth = condition(m);
      const auto note = [&](const Eigen::VectorXd& found, const RealVector& expected) {
        worst =
            std::max(worst, over_growth(relative_error(found, expected.cast<double>()), growth));
      };
      note(qdot, twin.coordinate_rates_at(s.q, s.u));
      note(pdot, twin.momentum_rates(s.t, s.q, s.u));
      note(udot, twin.accelerations(s.t, s.q, s.u));
    }
  EXPECT_LT(worst, algebra_tol(6));
  RecordProperty("worst", std::to_string(worst * 1e16) + "e-16");
}

/// Four bodies in a row, the middle two without mass; and a driven free joint on a body without
/// mass, which is a moving base.
TEST(Kernel, MasslessChainOnAMovingBase) {
  double worst = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    RandomTree random(seed);
    Scene scene =
        random.scene({.bodies = 5,
                      .branching = Branching::serial,
                      .kinds = {JointKind::revolute, JointKind::helical, JointKind::prismatic},
                      .drives = false,
                      .rotors = false});
    JointSpec& base = scene.joints.front();
    base.kind = JointKind::free;
    base.pitch = base.stiffness = base.rest = base.damping = 0;
    std::erase_if(scene.forces, [](const ForceSpec& f) { return f.joint == "joint0"; });
    for (int i = 0; i < 6; ++i) {
      DriveSpec drive;
      drive.joint = base.name;
      drive.coordinate = i;
      drive.kind = "harmonic";
      drive.amplitude = random.uniform(-1, 1);
      drive.frequency = random.uniform(1, 3);
      drive.phase = random.uniform(-3, 3);
      scene.drives.push_back(drive);
    }
    for (const std::size_t k : {0, 2, 3}) {
      scene.bodies[k].mass = 0;
      scene.bodies[k].inertia.setZero();
    }
    OpenChain chain(scene, Algebra::spatial);
    ASSERT_EQ(chain.nv(), 4);
    const DenseLagrangian twin(scene, chain.tree());
    const TreeState s = random.state(chain.tree());
    Eigen::VectorXd qdot(4), pdot(4), udot(4);
    ASSERT_TRUE(chain.rates(s.t, s.q, twin.momenta_at(s.t, s.q, s.u).cast<double>(), qdot, pdot));
    ASSERT_TRUE(chain.accelerations(s.t, s.q, s.u, udot));
    const RealMatrix m = twin.mass_matrix(s.t, s.q);
    const double growth = condition(m);
    const auto note = [&](const Eigen::VectorXd& found, const RealVector& expected) {
      worst =
          std::max(worst, over_growth(relative_error(found, expected.cast<double>()), growth, 1e7));
    };
    note(qdot, s.u.cast<Real>());
    note(pdot, twin.momentum_rates(s.t, s.q, s.u));
    note(udot, twin.accelerations(s.t, s.q, s.u));
  }
  EXPECT_LT(worst, algebra_tol(10));
  RecordProperty("worst", std::to_string(worst * 1e16) + "e-16");
}

TEST(Kernel, JointWithoutInertiaIsNamed) {
  for (const JointKind kind :
       {JointKind::revolute, JointKind::prismatic, JointKind::helical, JointKind::cylindrical,
        JointKind::universal, JointKind::spherical, JointKind::planar, JointKind::free}) {
    RandomTree random(6);
    Scene scene = random.scene({.bodies = 2,
                                .branching = Branching::serial,
                                .kinds = {kind},
                                .drives = false,
                                .joint_forces = false,
                                .body_forces = false,
                                .rotors = false});
    scene.bodies[1].mass = 0;
    scene.bodies[1].inertia.setZero();
    OpenChain chain(scene, Algebra::spatial);
    const TreeState s = random.state(chain.tree());
    Eigen::VectorXd qdot(chain.nq()), pdot(chain.nv());
    EXPECT_FALSE(chain.rates(s.t, s.q, s.u, qdot, pdot));
    EXPECT_NE(chain.failure().find("'joint1'"), std::string::npos) << chain.failure();
    EXPECT_FALSE(chain.accelerations(s.t, s.q, s.u, pdot));
    EXPECT_TRUE(chain.reactions(s.t, s.q, s.u).empty());
  }
}

/// Two coaxial revolute joints with nothing between them: the inner one has no inertia, and
/// rounding must not lend it any. The same with a point mass or a slender rod on a spherical joint:
/// no inertia about the line.
TEST(Kernel, RoundingIsNoInertia) {
  for (unsigned seed = 0; seed < 500; ++seed) {
    RandomTree random(seed);
    Scene scene = random.scene({.bodies = 2,
                                .branching = Branching::serial,
                                .kinds = {JointKind::revolute},
                                .drives = false,
                                .joint_forces = false,
                                .body_forces = false,
                                .rotors = false});
    scene.bodies[0].mass = 0;
    scene.bodies[0].inertia.setZero();
    scene.joints[1].rotation = Eigen::Quaterniond::Identity();
    scene.joints[1].axis = scene.joints[0].axis;
    scene.joints[1].origin_parent = scene.joints[0].origin_child;
    for (const Algebra algebra : {Algebra::planar, Algebra::spatial}) {
      OpenChain chain(scene, algebra);
      const TreeState s = random.state(chain.tree());
      Eigen::VectorXd qdot(2), pdot(2);
      EXPECT_FALSE(chain.rates(s.t, s.q, s.u, qdot, pdot)) << "seed " << seed;
      EXPECT_NE(chain.failure().find("'joint0'"), std::string::npos) << chain.failure();
    }
    Scene spherical = random.scene({.bodies = 1,
                                    .kinds = {JointKind::spherical},
                                    .drives = false,
                                    .joint_forces = false,
                                    .body_forces = false,
                                    .rotors = false});
    spherical.bodies[0].inertia.setZero();
    if (seed % 2 == 0) {  // a slender rod along com instead
      const Eigen::Vector3d n = spherical.bodies[0].com.normalized();
      spherical.bodies[0].inertia = 0.3 * (Eigen::Matrix3d::Identity() - n * n.transpose());
      spherical.joints[0].origin_child.setZero();
    }
    OpenChain chain(spherical);
    const TreeState s = random.state(chain.tree());
    Eigen::VectorXd qdot(4), pdot(3);
    EXPECT_FALSE(chain.rates(s.t, s.q, s.u, qdot, pdot)) << "seed " << seed;
  }
}

#ifdef MOMENTA_COUNTS_MALLOC
TEST(Kernel, NoCallAllocates) {
  for (const int run : {0, 1, 2}) {
    const bool flat = run == 1,
               batches = run == 2;  // with forces between bodies batches copy states
    RandomTree random(7);
    const TreeRecipe recipe{.bodies = 10, .body_forces = !batches};
    OpenChain chain(flat ? random.planar_scene(recipe) : random.scene(recipe));
    const TreeState s = random.state(chain.tree());
    Eigen::VectorXd qdot(chain.nq()), pdot(chain.nv()), p(chain.nv()), u(chain.nv());
    StateMatrix many_q(chain.nq(), 11), many_p(chain.nv(), 11), many_qdot(many_q),
        many_pdot(many_p);
    chain.momenta(s.t, s.q, s.u, p);
    many_q.colwise() = s.q;
    many_p.colwise() = p;
    const Eigen::VectorXd dq = s.q, dp = p;
    Eigen::MatrixXd jacobian(chain.nq() + chain.nv(), chain.nq() + chain.nv());
    Centroidal all;
    const auto lazy = [&] {  // workspaces of packs and of dual numbers are made by the first call
      if (batches) chain.rates_of_states(s.t, many_q, many_p, many_qdot, many_pdot);
      chain.jacobian_times(s.t, s.q, p, dq, dp, qdot, pdot);
      chain.jacobian(s.t, s.q, p, jacobian);
      chain.centroidal(s.t, s.q, p, all);
    };
    lazy();
    const long before = allocations;
    for (int i = 0; i < 1000; ++i) {
      lazy();
      chain.momenta(s.t, s.q, s.u, p);
      chain.inverse_mass_times(s.t, s.q, p, u);
      chain.rates(s.t, s.q, p, qdot, pdot);
      chain.velocities(s.t, s.q, p, u);
      chain.accelerations(s.t, s.q, s.u, u);
      chain.coordinate_rates(s.q, s.u, qdot);
      chain.energies(s.t, s.q, s.u);
    }
    EXPECT_EQ(allocations, before);
    const auto list = chain.poses(s.t, s.q);  // returns a list: the counter must see it
    EXPECT_GT(allocations, before);
  }
}
#endif

}  // namespace
}  // namespace momenta::core_kernel_scalars
