// Folded branches swept side by side: against the same branches one after the other, and against
// the assembled matrix; which branches are of one shape.

#include "equations/linkages.h"
#include "equations/quad_loops.h"
#include "equations/random_loops.h"
#include "equations/sweeps_against_matrix.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/kernel/levels/open_sweeps.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/kkt/sweeps/branches/looped_branches.h>
#include <momenta/dae/kkt/sweeps/levels/loop_sweeps.h>

#include <Eigen/Dense>

namespace momenta::dae_looped_branches {
namespace {

using namespace equations;
using Eigen::VectorXd;

/// What one leg is made of, from the ground, and how it ends on the platform.
struct LegRecipe {
  std::string joints;  ///< r: revolute, p: prismatic
  LoopKind loop;
  int count;
  bool turned = false;  ///< the platform is the loop's child
};

/// A flying platform on legs at random, and a pendulum beside it that has nothing to do with them.
/// `forces`: springs and dampers on some joints.
Scene legged(RandomTree& random, const std::vector<LegRecipe>& recipes, bool forces) {
  Scene s;
  s.name = "platform";
  s.gravity = random.vector(9);
  const auto body = [&](const std::string& name) {
    BodySpec b;
    b.name = name;
    b.mass = random.uniform(0.5, 3);
    b.com = random.vector(0.3);
    b.inertia = random.inertia(b.mass);
    s.bodies.push_back(b);
  };
  const auto joint = [&](JointKind kind, const std::string& parent, const std::string& child) {
    JointSpec j;
    j.name = "to " + child;
    j.kind = kind;
    j.parent = parent;
    j.child = child;
    j.origin_parent = random.vector(1);
    j.origin_child = random.vector(0.5);
    j.rotation = random.turn();
    j.axis = random.direction();
    if (forces && kind != JointKind::free && random.chance(0.4)) {
      j.stiffness = random.uniform(0, 5);
      j.damping = random.uniform(0, 2);
      j.rest = random.uniform(-1, 1);
    }
    s.joints.push_back(j);
  };
  body("platform");
  joint(JointKind::free, "ground", "platform");
  body("pendulum");
  joint(JointKind::revolute, "ground", "pendulum");
  for (std::size_t r = 0; r < recipes.size(); ++r)
    for (int i = 0; i < recipes[r].count; ++i) {
      const std::string leg = std::to_string(r) + "." + std::to_string(i);
      std::string above = "ground";
      for (std::size_t k = 0; k < recipes[r].joints.size(); ++k) {
        const std::string name = leg + "." + std::to_string(k);
        body(name);
        joint(recipes[r].joints[k] == 'r' ? JointKind::revolute : JointKind::prismatic, above,
              name);
        above = name;
      }
      LoopSpec l;
      l.name = "tie " + leg;
      l.kind = recipes[r].loop;
      l.parent = recipes[r].turned ? above : "platform";
      l.child = recipes[r].turned ? "platform" : above;
      l.origin_parent = random.vector(1);
      l.origin_child = random.vector(1);
      l.rotation = random.turn();
      l.axis = random.direction();
      if (l.kind == LoopKind::distance) l.length = random.uniform(0.5, 2);
      s.loops.push_back(l);
    }
  return s;
}

/// Friction, rotors and stops on some joints of the legs.
void add_effects(RandomTree random, Scene& scene) {
  for (JointSpec& j : scene.joints) {
    if (j.kind == JointKind::free) continue;
    if (random.chance(0.2)) j.friction = random.uniform(0, 2);
    if (random.chance(0.3)) j.rotor_inertia = {random.uniform(0.1, 2)};
    if (!random.chance(0.1)) continue;
    j.limits = {-0.2, 0.3};
    j.stop_stiffness = random.uniform(5, 50);
    j.stop_damping = random.uniform(0, 3);
  }
}

const std::vector<std::vector<LegRecipe>> recipes{
    {{"rrp", LoopKind::spherical, 6}},
    {{"rrr", LoopKind::point, 9, true}},
    {{"rprr", LoopKind::universal, 5}},
    {{"p", LoopKind::distance, 19}},
    {{"rr", LoopKind::distance, 4}, {"prr", LoopKind::spherical, 5, true}},
    {{"rrr", LoopKind::spherical, 3},
     {"rrrr", LoopKind::spherical, 1},
     {"rpr", LoopKind::point, 4}},
};

std::string said_of_solving(const Mechanism& mechanism) {
  for (const auto& [what, how] : plan_lines(mechanism))
    if (what == "solving (7)") return how;
  return "";
}

/// One state by sweeps with legs side by side or not.
struct Solution {
  VectorXd u, sigma, pdot, udot, lambda;
  double weakest = 0;
};
Solution solution(LoopedSweeps& sweeps, const Mechanism& m, const TreeState& s, const VectorXd& p,
                  const VectorXd& centre, const VectorXd& compliance) {
  Solution r{VectorXd(m.nv()), VectorXd(m.m()), VectorXd(m.nv()), VectorXd(m.nv()),
             VectorXd(m.m())};
  RightSide<double> right;
  right.centre = centre.data();
  right.fade = fade_evaluation;
  right.rates = true;
  right.leak = 0.7;
  right.positions = 0.3;
  right.alpha = 2;
  right.beta = 3;
  if (compliance.size() > 0) right.compliance = compliance.data();
  EXPECT_TRUE(
      sweeps.momentum(s.t, s.q.data(), p.data(), right, r.u.data(), r.sigma.data(), r.pdot.data()));
  r.weakest = sweeps.pivots(true).weakest;
  EXPECT_TRUE(sweeps.acceleration(s.t, s.q.data(), s.u.data(), p.data(), right, r.udot.data(),
                                  r.lambda.data()));
  return r;
}

/// Errors of u, ṗ and u̇ against quad precision, the largest: what a pose costs in digits, whatever
/// the order of elimination.
double error_of(LoopedSweeps& sweeps, const Mechanism& m, const TreeState& s, const VectorXd& p,
                const LoopedRates& exact, double leak) {
  VectorXd u(m.nv()), pdot(m.nv()), udot(m.nv()), sigma(m.m());
  const VectorXd no_force = VectorXd::Zero(m.nv());
  RightSide<double> right;
  right.fade = fade_evaluation;
  right.leak = leak;
  right.rates = true;
  const bool ok =
      sweeps.momentum(s.t, s.q.data(), p.data(), right, u.data(), sigma.data(), pdot.data()) &&
      sweeps.acceleration(s.t, s.q.data(), s.u.data(), no_force.data(), right, udot.data(),
                          sigma.data());
  EXPECT_TRUE(ok || sweeps.weak_looped_branch());
  if (!ok) return 1;
  return std::max({relative_error(u, exact.u), relative_error(pdot, exact.pdot),
                   relative_error(udot, exact.udot)});
}

TEST(LoopedBranches, SideBySideAreWhatTheyAreOneByOne) {
  constexpr double leak = 0.7;
  struct Level {
    int number, compared = 0;
    double logs = 0;
  };
  std::vector<Level> levels;
  for (const int level : {1, 3, 4})
    if (level_at_most(level) == level) levels.push_back({level});
  for (unsigned seed = 0; seed < 120; ++seed) {
    RandomTree random(seed);
    const Scene scene = legged(random, recipes[seed % recipes.size()], false);
    const Mechanism mechanism(scene, {.kkt = KktChoice::sweeps});
    VectorXd p(mechanism.nv()), centre(mechanism.m()), compliance;
    VectorXd u(mechanism.nv()), pdot(mechanism.nv()), sigma(mechanism.m());
    if (seed % 4 == 0) compliance = VectorXd::Constant(mechanism.m(), 0.01);
    for (int pose = 0; pose < 3; ++pose) {
      const TreeState s = random.state(mechanism.tree());
      for (double& x : p) x = random.uniform(-2, 2);
      for (double& x : centre) x = random.uniform(-2, 2);
      const LoopedRates exact = quad_rates(mechanism, s.q, p, s.u, leak, fade_evaluation);
      for (Level& level : levels) {
        const auto beside = mechanism.solver().sweeps(level.number),
                   apart = mechanism.solver().sweeps(level.number, false);
        const double one_by_one = error_of(*apart, mechanism, s, p, exact, leak),
                     together = error_of(*beside, mechanism, s, p, exact, leak);
        if (apart->weak_looped_branch()) {
          // Both say so, and the solver takes the assembled matrix.
          EXPECT_TRUE(beside->weak_looped_branch()) << seed;
          const auto e = mechanism.evaluation<double>();
          EXPECT_TRUE(make_sweep_solver(mechanism, *e)
                          ->momentum(s.t, s.q.data(), p.data(), centre.data(), fade_evaluation,
                                     leak, u.data(), sigma.data(), pdot.data()))
              << seed;
        }
        if (apart->weak_looped_branch() || !(one_by_one < 1e-6)) continue;
        ++level.compared;
        EXPECT_LT(together, 30 * one_by_one + 1e-13) << seed;
        level.logs += std::log((together + 1e-16) / (one_by_one + 1e-16));
        // With all that may be asked of them.
        const Solution a = solution(*beside, mechanism, s, p, centre, compliance),
                       b = solution(*apart, mechanism, s, p, centre, compliance);
        const double limit = 1e3 * one_by_one + 1e-12;
        EXPECT_LT(relative_error(a.u, b.u), limit) << seed;
        EXPECT_LT(relative_error(a.sigma, b.sigma), limit * (1 + b.sigma.norm())) << seed;
        EXPECT_LT(relative_error(a.pdot, b.pdot), limit) << seed;
        EXPECT_LT(relative_error(a.udot, b.udot), limit) << seed;
        EXPECT_LT(relative_error(a.lambda, b.lambda), limit * (1 + b.lambda.norm())) << seed;
        // Legs of several rows are closed in one order, and their pivots are others then.
        if (seed % recipes.size() == 3) {
          EXPECT_NEAR(a.weakest / b.weakest, 1, 1e-6) << seed;
        }
      }
    }
  }
  for (const Level& level : levels) {
    EXPECT_GT(level.compared, 250) << level.number;
    // In the mean they are as exact.
    EXPECT_LT(level.logs / level.compared, std::log(1.5)) << level.number;
  }
}

TEST(LoopedBranches, AgreeWithTheAssembledMatrix) {
  Worst worst;
  for (unsigned seed = 0; seed < 300; ++seed) {
    RandomTree random(seed + 1000);
    Scene scene = legged(random, recipes[seed % recipes.size()], true);
    if (seed % 2 > 0) add_effects(RandomTree(seed), scene);
    compare(scene, random, {.algebra = Algebra::spatial}, worst);
  }
  EXPECT_GT(worst.tried, 30);
  expect_rounding(worst, 20);
}

TEST(LoopedBranches, AreToldOfOneShape) {
  const auto lanes = std::to_string(looped_branch_lanes_at(best_level()));
  EXPECT_NE(said_of_solving(Mechanism(platform(6)))
                .find(" branches of 3 bodies side by side in " + lanes),
            std::string::npos);
  // A chain of loops has none, nor has a platform whose equations fit.
  EXPECT_EQ(said_of_solving(Mechanism(row_of_four_bars(3, 1.1))).find("side by side"),
            std::string::npos);
  EXPECT_EQ(said_of_solving(Mechanism(platform(4))).find("side by side"), std::string::npos);
  // One leg with another joint, or a drive, is swept by itself.
  Scene scene = platform(9);
  for (JointSpec& j : scene.joints)
    if (j.name == "S4") j.kind = JointKind::revolute;
  const Mechanism other(scene);
  const auto* words = "8 branches of 3 bodies";
  if (best_level() >= 4) {
    EXPECT_NE(said_of_solving(other).find(words), std::string::npos) << said_of_solving(other);
    EXPECT_EQ(said_of_solving(Mechanism(platform(9))).find("9 branches"), std::string::npos);
  }
}

/// A joint without inertia in one leg is told by its name, not by that of a leg beside it.
TEST(LoopedBranches, SingularJointIsTheOneThatIs) {
  Scene scene = platform(6);
  for (BodySpec& b : scene.bodies)
    if (b.name == "upper3") {
      b.mass = 0;
      b.inertia.setZero();
    }
  const Mechanism mechanism(scene);
  EXPECT_EQ(mechanism.solver().kkt(), KktChoice::sparse);
  std::string said;
  for (const auto& [what, how] : plan_lines(mechanism)) said += how + "\n";
  EXPECT_NE(said.find("'S3' has no inertia before its loops close"), std::string::npos) << said;
}

}  // namespace
}  // namespace momenta::dae_looped_branches
