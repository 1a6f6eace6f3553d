// How a mechanism is written must not matter: other frames, orders, axes, cuts, parts and gears
// (equations/descriptions.h, other_trees.h) leave every body where it is, as fast, and accelerated
// alike; and runs end with it in the same place.
//
// Compared are three points of every body, their places, velocities and accelerations at the start:
// u̇ by (3), u by (7) from p = M u, both by whatever solves them. Descriptions differ by rounding
// times what the condition of M and of the loops in its metric make of it,
//
//   √κ(M) κ(M^(−1/2) Φ_qᵀ)²,
//
// as in sweeps_against_matrix.h; what is wrong differs by 10⁻³ or more. Each mechanism is written
// in every way alone, then in several ways one after the other. MOMENTA_DESCRIPTIONS=n in the
// environment takes n mechanisms.

#include "equations/decompositions.h"
#include "equations/kkt_blocks.h"
#include "equations/other_trees.h"
#include "equations/point_motions.h"
#include "equations/random_mechanisms.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/run/measure/rank.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

namespace momenta::dae_descriptions {
namespace {

using namespace equations;
using Eigen::Matrix3Xd;
using Eigen::VectorXd;

constexpr int descriptions_each = 20;

/// Mechanisms asked for; 0: none are.
int asked_for() {
  const char* asked = std::getenv("MOMENTA_DESCRIPTIONS");  // NOLINT: tests have one thread
  return asked ? std::atoi(asked) : 0;
}

Scene any_mechanism(unsigned seed) {
  RandomTree random(seed);
  MechanismRecipe recipe;
  recipe.bodies = 3 + random.below(6);
  recipe.loops = 1 + random.below(3);
  recipe.planar = random.chance(0.5);
  recipe.drives = random.chance(0.2);
  recipe.forces = random.chance(0.3);
  Scene scene = random_mechanism(random, recipe);
  mark_bodies(scene);
  return scene;
}

/// A mechanism at its start.
struct Written {
  Scene scene;
  double growth = 1;  ///< of rounding
};

double growth_of_rounding(const Mechanism& mechanism, const Start& start) {
  const auto e = mechanism.evaluation<double>();
  e->place(start.t, start.q.data());
  const auto [M, J] = KktBlocks(mechanism, *e);
  const VectorXd masses = eigenvalues_of(M), loops = singular_values_in_mass(M, J);
  const double of_loops = loops.maxCoeff() / loops.minCoeff();
  return std::sqrt(masses.maxCoeff() / masses.minCoeff()) * of_loops * of_loops;
}

/// Where the mechanism of this seed can move, all its equations are independent, none weakly so.
std::optional<Written> regular(unsigned seed) {
  try {
    Written w{at_start(any_mechanism(seed)), 1};
    const Mechanism mechanism(w.scene);
    if (mechanism.m() == 0 || mechanism.nv() <= mechanism.m()) return std::nullopt;
    const Start start = assemble(mechanism).start;
    const RankReport rank = rank_report(mechanism, start);
    if (rank.rank < mechanism.m() || rank.rank_nearby < mechanism.m()) return std::nullopt;
    w.growth = growth_of_rounding(mechanism, start);
    if (!(w.growth < 1e6)) return std::nullopt;
    return w;
  } catch (const SceneError&) {  // loops that do not close
    return std::nullopt;
  }
}

/// The first ways one by one, then several.
Description described(const Scene& scene, unsigned seed, int i) {
  const unsigned own = 1000 * seed + static_cast<unsigned>(i);
  return i < ways_of_writing() ? description(scene, i, own) : description(scene, own);
}

struct AtStart {
  PointMotion by_velocities;
  Matrix3Xd velocity_by_momenta;
  double moved = 0;  ///< by assembly
  bool planar = false;
};

/// Back in the room that was turned.
void turn_back(Matrix3Xd& x, const Description& d) {
  x = (d.room.conjugate().toRotationMatrix() * x).eval();
}

AtStart at_its_start(const Description& d) {
  const Mechanism mechanism(d.scene);
  const Assembly assembly = assemble(mechanism, Assembled::rates);
  const Start& s = assembly.start;
  const auto e = mechanism.evaluation<double>();
  VectorXd udot(mechanism.nv()), p = udot, u = s.u, multipliers(mechanism.m());
  const auto solver = make_loop_solver(mechanism, *e);
  EXPECT_TRUE(solver->acceleration(s.t, s.q.data(), s.u.data(), nullptr, 0, 0, udot.data(),
                                   multipliers.data()));
  e->place(s.t, s.q.data());
  e->move(s.u.data());
  e->momenta(nullptr, p.data());
  EXPECT_TRUE(solver->momentum(s.t, s.q.data(), p.data(), nullptr, fade_evaluation, 0, u.data(),
                               multipliers.data(), nullptr));
  PointMotions points(mechanism);
  AtStart found{points(s.t, s.q, s.u, &udot), points(s.t, s.q, u, nullptr).velocity, assembly.moved,
                mechanism.plan().planar};
  for (Matrix3Xd* x : {&found.by_velocities.place, &found.by_velocities.velocity,
                       &found.by_velocities.acceleration, &found.velocity_by_momenta})
    turn_back(*x, d);
  return found;
}

TEST(Descriptions, HaveTheSameMotionAtTheStart) {
  const int wanted = asked_for() > 0 ? asked_for() : 200;
  int mechanisms = 0, descriptions = 0;
  double worst = 0;
  for (unsigned seed = 0; mechanisms < wanted && seed < 20U * static_cast<unsigned>(wanted);
       ++seed) {
    const auto w = regular(seed);
    if (!w) continue;
    ++mechanisms;
    const AtStart expected = at_its_start({w->scene, Eigen::Quaterniond::Identity(), ""});
    for (int i = 0; i < descriptions_each; ++i) {
      const Description d = described(w->scene, seed, i);
      SCOPED_TRACE(std::to_string(seed) + " " + std::to_string(i) + ": " + d.how);
      const AtStart found = at_its_start(d);
      ++descriptions;
      const double tolerance =
          16 * algebra_tol(static_cast<int>(d.scene.bodies.size())) * w->growth;
      const auto compare = [&](const Matrix3Xd& a, const Matrix3Xd& b, const char* what) {
        const double error = relative_error(a, b);
        EXPECT_LT(error, tolerance) << what;
        worst = equations::larger(worst, error / tolerance);
      };
      const PointMotion &own = found.by_velocities, &other = expected.by_velocities;
      EXPECT_LT(found.moved, tolerance) << "it was assembled already";
      compare(own.place, other.place, "places");
      compare(own.velocity, other.velocity, "velocities");
      compare(found.velocity_by_momenta, other.velocity, "velocities from momenta");
      compare(own.acceleration, other.acceleration, "accelerations");
      EXPECT_EQ(found.planar, expected.planar);
    }
  }
  EXPECT_EQ(mechanisms, wanted);
  RecordProperty("descriptions", descriptions);
  if (asked_for() > 0)
    std::printf("%d mechanisms, %d descriptions; at most %.2g of the tolerance\n", mechanisms,
                descriptions, worst);
}

constexpr double run_tolerance = 1e-10;

/// The markers' places at the end of a short run, if it is done and comes near no singular pose.
std::optional<Matrix3Xd> at_the_end(const Description& d, std::string& status) {
  const Mechanism mechanism(d.scene);
  const RunResult run = run_form(
      mechanism, assemble(mechanism).start,
      equations::kept(equations::adaptive("momentum", "dop853", "none", run_tolerance, 0.1, 2)));
  status = run.status + " " + run.reason;
  if (run.status != "done" || !run.singular_crossings.empty()) return std::nullopt;
  const auto& labels = run.trajectory.columns;
  Matrix3Xd place(3, static_cast<Eigen::Index>(d.scene.markers.size()));
  for (Eigen::Index i = 0; i < place.cols(); ++i)
    for (int k = 0; k < 3; ++k) {
      const std::string column = d.scene.markers[static_cast<std::size_t>(i)].name + "." +
                                 std::string(1, "xyz"[k]) + " [m]";
      const auto at = std::find(labels.begin(), labels.end(), column) - labels.begin();
      place(k, i) = run.trajectory.rows.back().at(static_cast<std::size_t>(at));
    }
  turn_back(place, d);
  return place;
}

TEST(Descriptions, EndRunsInTheSamePlace) {
  const int wanted = asked_for() > 0 ? asked_for() : 40;
  int mechanisms = 0, descriptions = 0, left_out = 0;
  double worst = 0;
  for (unsigned seed = 1000;
       mechanisms < wanted && seed < 1000 + 20U * static_cast<unsigned>(wanted); ++seed) {
    const auto w = regular(seed);
    if (!w) continue;
    std::string status;
    const auto expected = at_the_end({w->scene, Eigen::Quaterniond::Identity(), ""}, status);
    if (!expected) continue;
    ++mechanisms;
    for (int i = 0; i < descriptions_each; ++i) {
      const Description d = described(w->scene, seed, i);
      SCOPED_TRACE(std::to_string(seed) + ": " + d.how);
      const auto found = at_the_end(d, status);
      ++descriptions;
      if (!found) ++left_out;
      EXPECT_TRUE(found || status == "done ") << status;
      if (!found) continue;
      const double error = relative_error(*found, *expected), tolerance = run_tolerance * w->growth;
      EXPECT_LT(error, tolerance);
      worst = equations::larger(worst, error / tolerance);
    }
  }
  EXPECT_EQ(mechanisms, wanted);
  EXPECT_LT(left_out, std::max(1, descriptions / 10));
  if (asked_for() > 0)
    std::printf("%d mechanisms, %d runs, %d near singular poses; at most %.2g of the tolerance\n",
                mechanisms, descriptions, left_out, worst);
}

}  // namespace
}  // namespace momenta::dae_descriptions
