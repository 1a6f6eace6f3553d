// One verdict on the rank of the loop equations, whoever asks and however the mechanism is written;
// and loops that no pose closes because a file has rounded their numbers.

#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/parts.h"
#include "equations/random_loops.h"
#include "equations/random_tree.h"
#include "equations/recut.h"

#include <gtest/gtest.h>
#include <momenta/dae/analysis/linear/spectrum.h>
#include <momenta/dae/kkt/loop_units.h>
#include <momenta/dae/run/measure/rank.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/run/state_values.h>
#include <momenta/dae/study/extremes.h>
#include <momenta/dae/study/index_study.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace momenta::dae_loop_rank {
namespace {

using namespace equations;
using Eigen::Vector3d;

Scene three_cranks() {
  return equations::example("extremes/three_cranks.toml");
}

/// The numbers of joints and loops, off by up to `relative` of themselves and of one length.
Scene off_by(Scene scene, double relative, unsigned seed) {
  RandomTree random(seed);
  const auto move = [&](Vector3d& x, bool in_plane) {
    for (int i = 0; i < (in_plane ? 2 : 3); ++i) x[i] += relative * random.uniform(-1, 1);
  };
  const bool in_plane = scene.name == three_cranks().name;
  for (JointSpec& j : scene.joints) move(j.origin_parent, in_plane);
  for (LoopSpec& l : scene.loops) move(l.origin_parent, in_plane), move(l.origin_child, in_plane);
  return scene;
}

Scene in_reverse(Scene scene) {
  std::reverse(scene.loops.begin(), scene.loops.end());
  return scene;
}

struct Verdicts {
  std::string refused;
  std::vector<int> ranks;                      ///< of all that ask
  std::vector<std::vector<std::string>> rows;  ///< which they call redundant
};

Verdicts verdicts(const Scene& scene) {
  Verdicts v;
  const Mechanism mechanism(scene);
  Assembly a;
  try {
    a = assemble(mechanism);
  } catch (const SceneError& e) {
    v.refused = e.what();
    return v;
  }
  const auto named = [&](const std::vector<int>& rows) {
    std::vector<std::string> words;
    for (const int row : rows) words.push_back(row_in_words(mechanism, row));
    return words;
  };
  const auto add = [&](int rank, std::vector<std::string> rows) {
    v.ranks.push_back(rank);
    v.rows.push_back(std::move(rows));
  };
  add(a.rank, named(a.dependent_rows));
  const RankReport report = rank_report(mechanism, a.start);
  std::vector<int> dependent;
  for (const Dependency& d : report.dependencies) dependent.push_back(d.row);
  add(report.rank, named(dependent));
  GivenState given;
  given.q = a.start.q;
  given.v = a.start.u;
  given.p = given.tau = Eigen::VectorXd::Zero(mechanism.nv());
  const StateValues s = evaluate_state(mechanism, given);
  add(s.loops.rank, named(s.loops.dependent));
  RunRequest request;
  request.settings.end_time = 1e-3;
  request.settings.samples = 1;
  const RunResult run = run_form(mechanism, a.start, request);
  std::vector<std::string> rows;
  for (std::size_t i = 0; i < run.dependent_rows.size(); ++i) {
    EXPECT_EQ(run.dependent_rows[i].loop,
              mechanism.rows()[static_cast<std::size_t>(a.dependent_rows[i])].loop);
    EXPECT_EQ(run.dependent_rows[i].row,
              mechanism.rows()[static_cast<std::size_t>(a.dependent_rows[i])].what);
  }
  add(run.rank, v.rows[0]);
  EXPECT_EQ(run.dependent_rows.size(), a.dependent_rows.size());
  add(run_index_study(mechanism, a.start, {"momentum"}, {}).loops.rank, v.rows[0]);
  return v;
}

TEST(LoopRank, IsOneForAllWhoAsk) {
  int redundant = 0, independent = 0;
  for (const bool cranks : {true, false})
    for (double relative = 1e-4; relative > 0.5e-14; relative /= 10)
      for (unsigned seed = 0; seed < 4; ++seed) {
        SCOPED_TRACE(testing::Message()
                     << (cranks ? "cranks " : "bricard ") << relative << " " << seed);
        const Scene scene = off_by(cranks ? three_cranks() : bricard(), relative, seed);
        std::vector<Scene> written{scene};
        if (cranks) {
          const Mechanism mechanism(three_cranks());
          written.push_back(in_reverse(scene));
          written.push_back(recut(scene, mechanism.tree(), mechanism.tree().q0, "Q", "C"));
        }
        std::set<int> freedoms;
        for (const Scene& one : written) {
          const Verdicts v = verdicts(one);
          if (!v.refused.empty()) continue;
          for (const int rank : v.ranks) EXPECT_EQ(rank, v.ranks[0]);
          for (const auto& rows : v.rows) EXPECT_EQ(rows, v.rows[0]);
          const Mechanism mechanism(one);
          ++(v.ranks[0] < mechanism.m() ? redundant : independent);
          freedoms.insert(mechanism.nv() - v.ranks[0]);
          // Far from the border the cut does not matter either.
          if (relative < 2e-9 || relative > 2e-6) {
            EXPECT_EQ(freedoms.size(), 1U);
          }
          if (relative < 2e-9) {
            EXPECT_EQ(*freedoms.begin(), 1);
          }
        }
      }
  EXPECT_GT(redundant, 100);
  EXPECT_GT(independent, 10);
}

TEST(LoopRank, OfModesIsTheSame) {
  for (const double relative : {0.0, 1e-9, 1e-12}) {
    Scene scene = off_by(three_cranks(), relative, 3);
    const Mechanism mechanism(scene);
    const Assembly a = assemble(mechanism);
    Equilibrium at;
    at.q = a.start.q;
    at.lambda = Eigen::VectorXd::Zero(mechanism.m());
    const Spectrum s = spectrum(mechanism, at, 0, Route::automatic);
    EXPECT_EQ(s.rank, a.rank) << relative;
    EXPECT_EQ(s.dependent_rows, a.dependent_rows) << relative;
  }
}

/// Masses do not decide what is redundant, and units do not either.
TEST(LoopRank, IsAMatterOfGeometry) {
  for (const double factor : {1e-9, 1.0, 1e9}) {
    Scene scene = off_by(three_cranks(), 1e-9, 1);
    scene.bodies[1].mass *= factor;
    scene.bodies[1].inertia *= factor;
    const Mechanism mechanism(scene);
    const Assembly a = assemble(mechanism);
    EXPECT_EQ(a.rank, 3) << factor;
  }
  for (const double length : {1e-6, 1e6}) {
    const Scene scene =
        in_units(off_by(three_cranks(), 1e-9, 1), {.length = length, .time = 1, .mass = 1});
    EXPECT_EQ(assemble(Mechanism(scene)).rank, 3) << length;
  }
}

/// Of what contradicts itself the residue is the least there is: no step of any joint takes some of
/// it away, and what it says is what |Φ| is.
TEST(LoopRank, ContradictingNumbersAreClosedInTheLeastSquaresSense) {
  for (const bool cranks : {true, false})
    for (unsigned seed = 0; seed < 6; ++seed) {
      const Scene scene = off_by(cranks ? three_cranks() : bricard(), 2e-9, seed);
      const Mechanism mechanism(scene);
      const Assembly a = assemble(mechanism);
      const auto e = mechanism.evaluation<double>();
      e->place(0, a.start.q.data());
      Eigen::VectorXd phi(mechanism.m());
      e->positions(phi.data());
      ASSERT_EQ(a.start.residue.size(), phi.size()) << seed;
      EXPECT_LT((phi - a.start.residue).norm(), 1e-15);
      EXPECT_GT(phi.norm(), 1e-12);
      EXPECT_LT(phi.cwiseAbs().maxCoeff(), left_by_files * length_of(scene));
      const ScaledJacobian scaled = scaled_jacobian(mechanism, *e);
      const RankAndIdle rank = rank_and_idle(scaled.a);
      const Eigen::VectorXd open = scaled.row_factor.asDiagonal() * phi;
      EXPECT_LT((open - rank.left * rank.left.transpose() * open).norm(), 1e-11);
      EXPECT_NE(a.residue.find("closed in the least-squares sense"), std::string::npos);
      EXPECT_LT(a.moved, 1e-6) << seed;
      if (cranks) {
        EXPECT_EQ(a.residue.rfind("loop '", 0), 0U) << a.residue;
        EXPECT_NE(a.residue.find("' stays open by "), std::string::npos) << a.residue;
        EXPECT_NE(a.residue.find(" m: its equations and those of '"), std::string::npos)
            << a.residue;
      }
    }
  EXPECT_EQ(assemble(Mechanism(three_cranks())).residue, "");
  EXPECT_EQ(assemble(Mechanism(three_cranks())).start.residue.size(), 0);
}

/// Numbers off by more than what counts as dependent: the scene is refused, or closed where it can
/// be, elsewhere; what stays open there is no more than a file leaves, and told.
TEST(LoopRank, BeyondWhatFilesLeaveNothingStaysOpen) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    const Scene scene = off_by(three_cranks(), 3e-7, seed);
    try {
      const Assembly a = assemble(Mechanism(scene));
      EXPECT_LT(a.position_residual,
                a.residue.empty() ? 1e-11 : left_by_files * length_of(three_cranks()));
    } catch (const SceneError& e) {
      EXPECT_NE(std::string(e.what()).find("stays open by"), std::string::npos) << e.what();
    }
  }
}

/// Every form runs from there as from where the numbers agree, and drifts no more. The cranks hang
/// and swing clear of the poses where they lie in one line.
TEST(LoopRank, RunsGoOnWithWhatStaysOpen) {
  for (const std::string& form : form_names()) {
    SCOPED_TRACE(form);
    RunRequest request;
    request.settings = default_settings({}, form, "", 1e-8);
    request.settings.end_time = 2;
    request.settings.samples = 20;
    request.settings.gauge = takes_gauge(form) ? "leak:3" : "none";
    request.keep_trajectory = true;
    const auto ran = [&](double relative, bool project) {
      Scene scene = off_by(three_cranks(), relative, 5);
      for (JointSpec& j : scene.joints) j.position[0] = -j.position[0];
      const Mechanism mechanism(scene);
      request.settings.project = project;
      return run_form(mechanism, assemble(mechanism).start, request);
    };
    for (const bool project : {false, true}) {
      if (project && (is_dae_form(form) || form == "projected" || needs_one_step_method(form)))
        continue;
      const RunResult exact = ran(0, project), open = ran(2e-9, project);
      ASSERT_EQ(exact.status, "done") << exact.reason;
      ASSERT_EQ(open.status, "done") << open.reason;
      EXPECT_LT(open.counters.evaluations, 3 * exact.counters.evaluations);
      EXPECT_EQ(exact.residue, "");
      EXPECT_NE(open.residue, "");
      EXPECT_LT(open.position_drift_max, 2 * exact.position_drift_max + 4e-8);
      EXPECT_LT(open.energy_error_max, 2 * exact.energy_error_max + 1e-5);
      const auto& a = exact.trajectory.rows.back();
      const auto& b = open.trajectory.rows.back();
      for (int i = 1; i <= 4; ++i)
        EXPECT_NEAR(a[static_cast<std::size_t>(i)], b[static_cast<std::size_t>(i)], 1e-4) << i;
    }
  }
}

/// A body on two slides, tied to its own plane: no joint moves the loop, its matrix is rounding.
TEST(LoopRank, LoopsThatNothingMovesHaveNone) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    RandomTree random(seed);
    Scene scene;
    std::string parent = "ground";
    const Vector3d normal = random.direction();
    for (const char* name : {"first", "second"}) {
      BodySpec body = rod(name, 0.1);
      JointSpec slide = hinge(std::string("along ") + name, parent, name, random.vector(0.7), 0.4);
      slide.kind = JointKind::prismatic;
      slide.axis = normal.cross(random.direction()).normalized();
      scene.bodies.push_back(body);
      scene.joints.push_back(slide);
      parent = name;
    }
    LoopSpec loop = equations::make_loop(LoopKind::planar, "table", "ground", "second", {0, 0, 0},
                                         random.vector(0.5));
    loop.axis = normal;
    close(loop, scene, build_tree(scene));
    scene.loops.push_back(loop);
    const Mechanism mechanism(scene, {.algebra = Algebra::spatial});
    const Assembly a = assemble(mechanism);
    EXPECT_EQ(a.rank, 0) << seed;
    EXPECT_EQ(a.moved, 0) << seed;
    EXPECT_EQ(a.mobility, 2) << seed;
  }
}

// Where Φ_q has entries that are not finite, nothing follows from anything.
TEST(LoopRank, OfWhatIsNotFiniteNothingIsKnown) {
  const Mechanism mechanism(three_cranks());
  const auto e = mechanism.evaluation<double>();
  Eigen::VectorXd q = assemble(mechanism).start.q;
  q[0] = std::nan("");
  e->place(0, q.data());
  for (const Judged judged : {Judged::singular_values, Judged::dependence}) {
    const LoopRank rank = loop_rank(mechanism, *e, judged);
    EXPECT_EQ(rank.rank, 0);
    EXPECT_TRUE(rank.dependent.empty());
  }
}

/// Blocks of rank one and two beside each other, some of them zero: Eigen's divide and conquer errs
/// on one in 150 of these.
TEST(LoopRank, WhatIsIdleIsReachedByNoColumn) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1, 1);
  const auto below = [&](unsigned n) { return static_cast<Eigen::Index>(random() % n); };
  const auto filled = [&](Eigen::Index rows, Eigen::Index columns) {
    Eigen::MatrixXd m(rows, columns);
    for (double& x : m.reshaped()) x = number(random);
    return m;
  };
  for (int k = 0; k < 600; ++k) {
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(17 + below(8), 17 + below(8));
    for (Eigen::Index row = 0, column = 0; row < a.rows() && column < a.cols();) {
      const Eigen::Index h = std::min(1 + below(6), a.rows() - row),
                         w = std::min(1 + below(3), a.cols() - column), rank = 1 + below(2);
      if (below(3) > 0) a.block(row, column, h, w) = filled(h, rank) * filled(rank, w);
      row += h;
      column += w;
    }
    const RankAndIdle found = rank_and_idle(a);
    ASSERT_EQ(found.left.cols() + found.rank, a.rows());
    ASSERT_LE((found.left.transpose() * a).norm(), 1e-10 * a.norm()) << k;
    ASSERT_TRUE((found.left.transpose() * found.left).isIdentity(1e-10)) << k;
  }
}

}  // namespace
}  // namespace momenta::dae_loop_rank
