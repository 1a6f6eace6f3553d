// Loops by sweeps against Φ of positions alone, off the manifold, at random states of random trees.

#include "equations/dense_loops.h"
#include "equations/parts.h"
#include "equations/random_loops.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/kernel/model.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/dae/form/form.h>

namespace momenta::dae_loop_rows {
namespace {

using namespace equations;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Worst {
  std::map<std::string, double> error;
  void note(const std::string& what, double e) { error[what] = std::max(error[what], e); }
  void expect_below(double tolerance) const {
    for (const auto& [what, e] : error) {
      EXPECT_LT(e, tolerance) << what;
      testing::Test::RecordProperty(what, std::to_string(e * 1e16) + "e-16");
    }
  }
};

/// Everything an evaluation says of loops, at one random state.
void compare(const Mechanism& mechanism, RandomTree& random, Worst& worst) {
  const DenseLagrangian motion(mechanism.scene(), mechanism.tree());
  const DenseLoops twin(
      mechanism.scene(), motion,
      mechanism.plan().planar ? std::optional(mechanism.plan().basis) : std::nullopt);
  const TreeState s = random.state(mechanism.tree());
  const int nv = mechanism.nv(), m = mechanism.m();
  ASSERT_EQ(m, twin.rows());
  VectorXd sigma(m), udot(nv);
  for (double& x : sigma) x = random.uniform(-2, 2);
  for (double& x : udot) x = random.uniform(-2, 2);
  const double leak = random.uniform(0, 3);
  const auto [jacobian, jacobian_rate] = twin.jacobian_at(s.t, s.q, s.u);
  const RealVector load = jacobian.transpose() * sigma.cast<Real>();

  const auto e = mechanism.evaluation<double>();
  VectorXd phi(m), rate(m), bias(m), acceleration(m), unloaded(nv), p(nv), pdot(nv), tau(nv),
      force(nv);
  e->place(s.t, s.q.data());
  e->positions(phi.data());
  // Φ is the difference of places: as exact as these.
  double extent = 1;
  for (const Eigen::Isometry3d& pose : motion.poses(s.t, s.q))
    extent = std::max(extent, pose.translation().norm());
  worst.note("positions", relative_error(phi, twin.positions_at(s.t, s.q).cast<double>(), extent));

  MatrixXd entries = MatrixXd::Zero(m, nv);
  const auto& pattern = mechanism.kkt_pattern().constraint;
  std::vector<double> values(pattern.size());
  e->constraint_entries(values.data());
  for (std::size_t i = 0; i < values.size(); ++i)
    entries(pattern[i].row, pattern[i].column) += values[i];
  worst.note("constraint entries", relative_error(entries, jacobian.cast<double>()));

  MatrixXd mass = MatrixXd::Zero(nv, nv);
  const auto& mass_pattern = mechanism.kkt_pattern().mass;
  values.resize(mass_pattern.size());
  e->mass_entries(values.data());
  for (std::size_t i = 0; i < values.size(); ++i) {
    ASSERT_LE(mass_pattern[i].row, mass_pattern[i].column);
    mass(mass_pattern[i].row, mass_pattern[i].column) = values[i];
    mass(mass_pattern[i].column, mass_pattern[i].row) = values[i];
  }
  const RealMatrix mass_twin = motion.mass_matrix(s.t, s.q);
  worst.note("mass entries", relative_error(mass, mass_twin.cast<double>()));

  e->constraint_forces(sigma.data(), force.data());
  worst.note("constraint forces", relative_error(force, load.cast<double>()));

  e->move(s.u.data());
  e->velocities(rate.data());
  worst.note("velocities", relative_error(rate, twin.velocities_at(s.t, s.q, s.u).cast<double>()));

  e->momenta(nullptr, unloaded.data());
  e->momenta(sigma.data(), p.data());
  const RealVector p_twin = motion.momenta_at(s.t, s.q, s.u);
  worst.note("momenta", relative_error(unloaded, p_twin.cast<double>()));
  worst.note("loaded momenta", relative_error(p, RealVector(p_twin + load).cast<double>()));

  // ṗ with σ: d/dt of p at fixed σ under λ = κσ
  e->momentum_rates(s.q.data(), s.u.data(), sigma.data(), leak, pdot.data());
  const RealVector free_rates = motion.momentum_rates(s.t, s.q, s.u);
  const RealVector pdot_twin =
      free_rates + jacobian_rate.transpose() * sigma.cast<Real>() - Real(leak) * load;
  worst.note("momentum rates", relative_error(pdot, pdot_twin.cast<double>()));
  if (mechanism.nq() == nv) {  // and as ∂L*/∂q + Q
    const RealVector gradient = motion.lagrange_rates(s.t, s.q, s.u) +
                                twin.impulse_gradient(s.t, s.q, s.u, sigma) - Real(leak) * load;
    worst.note("gradient of L*", relative_error(pdot, gradient.cast<double>()));
  }

  e->joint_forces(s.q.data(), s.u.data(), nullptr, nullptr, tau.data());
  e->accelerations(bias.data());
  const VectorXd still = VectorXd::Zero(nv);
  worst.note("acceleration bias",
             relative_error(bias, twin.accelerations_at(s.t, s.q, s.u, still).cast<double>()));
  e->joint_forces(s.q.data(), s.u.data(), udot.data(), sigma.data(), tau.data());
  e->accelerations(acceleration.data());
  worst.note(
      "accelerations",
      relative_error(acceleration, twin.accelerations_at(s.t, s.q, s.u, udot).cast<double>()));
  const RealVector free_udot = motion.accelerations(s.t, s.q, s.u);
  const RealVector tau_twin = mass_twin * (udot.cast<Real>() - free_udot) + load;
  worst.note("joint forces", relative_error(tau, tau_twin.cast<double>(),
                                            std::max(1.0, mass.norm() * udot.norm())));
}

void sweep(const TreeRecipe& recipe, LoopKind kind, int trees, unsigned seed) {
  Worst worst;
  for (int i = 0; i < trees; ++i) {
    RandomTree random(seed + static_cast<unsigned>(i));
    Scene scene = random.scene(recipe);
    scene.loops.push_back(random_loop(random, scene, kind));
    scene.loops.push_back(
        random_loop(random, scene, loop_kinds[static_cast<std::size_t>(i) % loop_kinds.size()]));
    const Mechanism mechanism(scene, {.algebra = Algebra::spatial});
    compare(mechanism, random, worst);
    if (testing::Test::HasFatalFailure()) return;
  }
  worst.expect_below(algebra_tol(4 * recipe.bodies));
}

/// Every choice of driven coordinates, origins driven or not, among other loops.
void driven_sweep(LoopKind kind, int trees, unsigned seed) {
  Worst worst;
  const int choices = 1 << driven_coordinates_of(kind);
  for (int i = 0; i < trees; ++i) {
    RandomTree random(seed + static_cast<unsigned>(i));
    Scene scene = random.scene({.bodies = 5});
    scene.loops.push_back(
        random_loop(random, scene, loop_kinds[static_cast<std::size_t>(i) % loop_kinds.size()]));
    scene.loops.push_back(random_loop(random, scene, kind));
    const int origins = i % 3 == 0 ? 0 : random.below(8);
    drive_loop(random, scene, scene.loops.back(), i % choices, origins);
    const Mechanism mechanism(scene, {.algebra = Algebra::spatial});
    EXPECT_EQ(mechanism.rows().size(), static_cast<std::size_t>(mechanism.m()));
    compare(mechanism, random, worst);
    if (testing::Test::HasFatalFailure()) return;
  }
  worst.expect_below(algebra_tol(4 * 5));
}

class LoopRows : public testing::TestWithParam<LoopKind> {};
TEST_P(LoopRows, TreesOfAllJoints) {
  sweep({}, GetParam(), 25, 100);
}
TEST_P(LoopRows, Chains) {
  sweep({.branching = Branching::serial}, GetParam(), 15, 200);
}
TEST_P(LoopRows, RevolutesAndPrismatics2) {
  sweep({.kinds = {JointKind::revolute, JointKind::prismatic}}, GetParam(), 25, 300);
}
TEST_P(LoopRows, RightAngles) {
  sweep({.placing = Placing::right_angles}, GetParam(), 15, 400);
}
TEST_P(LoopRows, Driven) {
  driven_sweep(GetParam(), 32, 600);
}
TEST_P(LoopRows, NearlyParallelAxes) {
  sweep({.placing = Placing::degenerate}, GetParam(), 15, 500);
}

class PlanarLoopRows : public testing::TestWithParam<LoopKind> {};
TEST_P(PlanarLoopRows, AnyPlane) {
  Worst worst;
  for (unsigned i = 0; i < 40; ++i) {
    RandomTree random(700 + i);
    const TreeRecipe recipe{.drives = i % 2 == 0};
    Scene scene = random.planar_scene(recipe);
    const Tree tree = build_tree(scene);
    const auto found = find_plane(tree, scene);
    if (!found.basis) continue;  // a tree of welds moves in no plane
    const Eigen::Vector3d normal = found.basis->col(2);
    LoopSpec l = into_plane(random, scene, random_loop(random, scene, GetParam()), normal);
    if (l.kind != LoopKind::distance || i % 3 == 0)
      level(l, scene, tree, normal);
    else
      l.length = 3;
    scene.loops.push_back(l);
    const Mechanism mechanism(scene);
    EXPECT_TRUE(mechanism.plan().planar) << mechanism.plan().planar_reason;
    compare(mechanism, random, worst);
    if (HasFatalFailure()) return;
  }
  worst.expect_below(algebra_tol(24));
}

TEST_P(PlanarLoopRows, Driven) {
  Worst worst;
  int planar = 0;
  for (unsigned i = 0; i < 60; ++i) {
    RandomTree random(1700 + i);
    Scene scene = random.planar_scene({.bodies = 5, .drives = i % 2 == 0});
    const Tree tree = build_tree(scene);
    const auto found = find_plane(tree, scene);
    if (!found.basis) continue;
    const Eigen::Vector3d normal = found.basis->col(2);
    LoopSpec l = into_plane(random, scene, random_loop(random, scene, GetParam()), normal);
    int origins = 0;  // those axes of the parent that lie in the plane
    const auto axes = axes_at_zero(scene).at(l.parent);
    for (int k = 0; k < 3; ++k)
      if (std::abs((axes * Eigen::Vector3d::Unit(k)).dot(normal)) < 1e-12) origins |= 1 << k;
    level(l, scene, tree, normal);
    scene.loops.push_back(l);
    const bool turns = l.kind == LoopKind::spherical;  // in space
    drive_loop(random, scene, l, turns ? 0 : static_cast<int>(i) % 2, origins);
    const Mechanism mechanism(scene);
    planar += mechanism.plan().planar;
    compare(mechanism, random, worst);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(planar, 30);
  worst.expect_below(algebra_tol(24));
}

/// Moves a loop's point on the child to where that on the parent is.
void close_at(LoopSpec& l, const Scene& scene, const TreeState& s, const Tree& tree) {
  const DenseLagrangian motion(scene, tree);
  const auto poses = motion.poses(s.t, s.q);
  const auto pose = [&](const std::string& name) {
    for (std::size_t k = 0; k < scene.bodies.size(); ++k)
      if (scene.bodies[k].name == name) return poses[k];
    return Eigen::Isometry3d(Eigen::Isometry3d::Identity());
  };
  l.origin_child = pose(l.child).inverse() * (pose(l.parent) * l.origin_parent);
}

/// u of the momentum form on closed loops, the planar kernel against the spatial one with its
/// redundant rows; ṗ too, but for the impulses of loops: the gauges of the two differ.
TEST_P(PlanarLoopRows, AgreeWithSpace) {
  double worst = 0;
  int compared = 0;
  for (unsigned i = 0; i < 80; ++i) {
    RandomTree random(900 + i);
    Scene scene = random.planar_scene({.bodies = 7, .drives = i % 2 == 0});
    const Tree tree = build_tree(scene);
    const auto found = find_plane(tree, scene);
    if (!found.basis || tree.nv < 4) continue;
    LoopSpec l = random_loop(random, scene, GetParam());
    l = into_plane(random, scene, l, found.basis->col(2));
    level(l, scene, tree, found.basis->col(2));
    const TreeState s = random.state(tree);
    if (l.kind != LoopKind::distance) close_at(l, scene, s, tree);
    scene.loops.push_back(l);
    std::vector<double> p(s.u.data(), s.u.data() + s.u.size());
    std::vector<VectorXd> rates;
    double condition = 1;
    MatrixXd free;  // motions that keep the loop closed
    for (const Algebra algebra : {Algebra::planar, Algebra::spatial}) {
      const Mechanism mechanism(scene, {.algebra = algebra});
      const auto e = mechanism.evaluation<double>();
      e->place(s.t, s.q.data());
      MatrixXd j = MatrixXd::Zero(mechanism.m(), mechanism.nv());
      const auto& pattern = mechanism.kkt_pattern().constraint;
      std::vector<double> values(pattern.size());
      e->constraint_entries(values.data());
      for (std::size_t k = 0; k < values.size(); ++k)
        j(pattern[k].row, pattern[k].column) = values[k];
      const Eigen::JacobiSVD<MatrixXd> svd(j, Eigen::ComputeFullV);
      const VectorXd sv = svd.singularValues();
      if (algebra == Algebra::planar) {
        condition = sv[0] / sv[sv.size() - 1];
        free = svd.matrixV().rightCols(mechanism.nv() - mechanism.m());
      }
      const Start start{s.t, s.q, s.u, VectorXd::Zero(mechanism.nv()), VectorXd::Zero(j.rows()),
                        {}};
      FormOptions options;
      options.gauge = {Gauge::Kind::leak, 1.3};
      const auto form = make_form("momentum", mechanism, options, start);
      std::vector<double> y(s.q.data(), s.q.data() + s.q.size());
      y.insert(y.end(), p.begin(), p.end());
      VectorXd ydot(static_cast<Eigen::Index>(y.size()));
      ASSERT_TRUE(form->ode()->rhs(s.t, y.data(), ydot.data()));
      VectorXd told(mechanism.nq() + free.cols());
      told << ydot.head(mechanism.nq()), free.transpose() * ydot.tail(mechanism.nv());
      rates.push_back(told);
    }
    if (!(condition < 30)) continue;  // the loop hardly moves what it closes
    ++compared;
    worst = equations::larger(worst, relative_error(rates[1], rates[0]) / (condition * condition));
  }
  EXPECT_GT(compared, 8);
  EXPECT_LT(worst, algebra_tol(28));
  RecordProperty("planar against spatial", std::to_string(worst * 1e16) + "e-16");
}

/// Every row by name, what is driven said so; and why a driven loop is no loop of a plane.
TEST(DrivenLoopRows, AreNamed) {
  RandomTree random(5);
  Scene scene = random.scene({.bodies = 3, .drives = false});
  const auto names = [&](LoopKind kind, int coordinates) {
    scene.loops = {random_loop(random, scene, kind)};
    scene.drives.clear();
    drive_loop(random, scene, scene.loops[0], coordinates, 0);
    std::string all;
    const Mechanism mechanism(scene, {.algebra = Algebra::spatial});
    for (const RowName& row : mechanism.rows()) all += (all.empty() ? "" : ", ") + row.what;
    return all;
  };
  const std::string point = "point along axis 1, point along axis 2, ",
                    hinge = "axis 3 against axis 1, axis 3 against axis 2";
  EXPECT_EQ(names(LoopKind::cylindrical, 0), point + hinge);
  EXPECT_EQ(names(LoopKind::cylindrical, 3),
            point + "point along axis 3, driven, " + hinge + ", axis 1 against axis 2, driven");
  EXPECT_EQ(names(LoopKind::planar, 2), "point along axis 3, point along axis 2, driven, " + hinge);
  EXPECT_EQ(names(LoopKind::distance, 1), "distance, driven");
}

TEST(DrivenLoopRows, LeaveThePlane) {
  Scene scene;
  scene.bodies.resize(2);
  for (int i = 0; i < 2; ++i) {
    BodySpec& b = scene.bodies[static_cast<std::size_t>(i)];
    b.name = std::string(1, static_cast<char>('a' + i));
    b.mass = 1;
    b.inertia.setIdentity();
    scene.joints.push_back(
        equations::make_joint(JointKind::revolute, "J" + b.name, i == 0 ? "ground" : "a", b.name));
  }
  LoopSpec l = equations::make_loop(LoopKind::distance, "C", "ground", "b");
  l.length = 1;
  scene.loops = {l};
  EXPECT_TRUE(Mechanism(scene).plan().planar);
  DriveSpec d;
  d.loop = "C";
  d.kind = "polynomial";
  d.coefficients = {0.1, 1};
  for (const char* axis : {"x", "z"}) {
    d.origin = axis;
    scene.drives = {d};
    EXPECT_EQ(Mechanism(scene).plan().planar, d.origin == "x");
  }
  try {
    const Mechanism mechanism(scene, {.algebra = Algebra::planar});
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_STREQ(
        error.what(),
        "scene: the planar kernel was asked for, but the origin of loop 'C' is driven out "
        "of the plane of the joints, expected a mechanism in a plane, or the spatial kernel");
  }
}

TEST(Couplers, TreesOfAllJoints) {
  Worst worst;
  int coupled = 0;
  for (unsigned i = 0; i < 60; ++i) {
    RandomTree random(2100 + i);
    const bool planar = i % 3 == 2;
    Scene scene = planar ? random.planar_scene({}) : random.scene({});
    if (!planar)
      scene.loops.push_back(random_loop(random, scene, loop_kinds[i % loop_kinds.size()]));
    for (int k = 0; k < 2; ++k)
      if (const auto coupler = random_coupler(random, scene)) {
        scene.loops.push_back(*coupler);
        if (random.chance(0.5)) drive_loop(random, scene, *coupler, 1, 0);
        ++coupled;
      }
    if (scene.loops.empty()) continue;
    compare(Mechanism(scene), random, worst);
    if (testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(coupled, 80);
  worst.expect_below(algebra_tol(24));
}

std::string kind_name(const testing::TestParamInfo<LoopKind>& info) {
  return std::string(reading::name_of(info.param));
}
INSTANTIATE_TEST_SUITE_P(Kinds, LoopRows, testing::ValuesIn(loop_kinds), kind_name);
INSTANTIATE_TEST_SUITE_P(Kinds, PlanarLoopRows, testing::ValuesIn(planar_loop_kinds), kind_name);

}  // namespace
}  // namespace momenta::dae_loop_rows
