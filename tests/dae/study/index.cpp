// The index of the forms as it is found from their own equations: it is the one their names and
// `momenta check` give, hidden constraints are as many as are listed, and none of it depends on
// units, on the algebra or on where along the motion one looks. Total derivatives of a form's
// equations against differences of its residual along a curve.

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/parts.h"
#include "equations/random_loops.h"
#include "equations/runs.h"

#include <gtest/gtest.h>
#include <momenta/dae/form/dae_form.h>
#include <momenta/dae/kkt/kkt.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/index_study.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <random>

namespace momenta::dae_index {
namespace {

using namespace equations;

Scene scene_of(const std::string& file) {
  return equations::example(file);
}

/// The index that a form's name promises.
int promised(const std::string& form) {
  const auto at = form.find("index");
  return at == std::string::npos ? 2 : form[at + 5] - '0';
}

/// Equations among the unknowns that the array of ν has by the list of words.
int listed(const FormIndex& f, int nu, int nv, int m) {
  int count = 0;
  for (const Constraint& c : f.words.constraints)
    if (c.origin != Constraint::Origin::invariant && c.differentiations <= nu)
      count += c.per_rate * nv + c.per_loop_row * m;
  return count;
}

void expect_promised(const Mechanism& mechanism, const Start& start, double least) {
  const IndexStudy study = run_index_study(mechanism, start, {});
  ASSERT_EQ(study.forms.size(), form_names().size());
  for (const FormIndex& f : study.forms) {
    SCOPED_TRACE(study.scene + ", " + f.form);
    EXPECT_FALSE(f.words.x.empty()) << "its entry has no words";
    if (!f.dae) {
      EXPECT_EQ(f.inner.rank, f.inner_size);
      EXPECT_GT(f.inner.gap(), least);
      continue;
    }
    EXPECT_EQ(f.found.index, promised(f.form)) << f.found.why;
    EXPECT_EQ(f.ida_holds, f.found.index <= 2) << f.ida;
    EXPECT_TRUE(f.semi_explicit);
    for (const ArrayLevel& level : f.found.levels) {
      EXPECT_GT(level.gap, least) << level.differentiations;
      EXPECT_LT(level.residual, 1e-9) << level.differentiations;
      EXPECT_EQ(level.constraints, listed(f, level.differentiations, mechanism.nv(), mechanism.m()))
          << level.differentiations;
    }
    // A multiplier is known by one differentiation more than it takes to find it: that is the
    // index. So no multiplier is error-tested.
    for (const UnknownBlock& b : f.blocks) {
      EXPECT_FALSE(b.algebraic && b.tested) << b.symbol;
      EXPECT_LE(b.determined_after, f.found.index) << b.symbol;
    }
  }
}

TEST(Index, IsTheOneInTheNames) {
  for (const char* file : {"pendulum/cartesian.toml", "four_bar/scene.toml", "andrews/scene.toml",
                           "slider_crank/scene.toml"}) {
    const Mechanism mechanism(scene_of(file));
    expect_promised(mechanism, equations::start_of(mechanism), least_gap);
  }
}

TEST(Index, IsTheSameInSpaceWithQuaternions) {
  const Mechanism mechanism(platform(3), {.algebra = Algebra::spatial});
  expect_promised(mechanism, equations::start_of(mechanism), least_gap);
}

TEST(Index, IsTheSameAlongTheMotion) {
  const Mechanism mechanism(scene_of("four_bar/scene.toml"));
  RunRequest request =
      equations::kept(equations::adaptive("momentum", "dop853", "reset", 1e-12, 0.9, 1));
  request.settings.project = true;
  const RunResult run = run_form(mechanism, equations::start_of(mechanism), request);
  ASSERT_EQ(run.status, "done");
  const auto& row = run.trajectory.rows.back();
  Scene later = mechanism.scene();
  for (std::size_t i = 0; i < later.joints.size(); ++i) {
    later.joints[i].position = {row[1 + i]};
    later.joints[i].velocity = {row[1 + later.joints.size() + i]};
  }
  const Mechanism moved(later);
  const Assembly assembled = assemble(moved);
  EXPECT_LT(assembled.moved, 1e-9);
  EXPECT_GT(assembled.start.u.norm(), 0.1);
  expect_promised(moved, assembled.start, least_gap);
}

/// Lengths in units of `length`, times in units of `time`, masses in units of `mass`.
Scene in_units(Scene s, double length, double time, double mass) {
  s.gravity *= length / (time * time);
  for (auto& b : s.bodies) {
    b.mass *= mass;
    b.com *= length;
    b.inertia *= mass * length * length;
  }
  for (auto& j : s.joints) {
    j.origin_parent *= length;
    j.origin_child *= length;
    for (double& v : j.velocity) v /= time;
  }
  for (auto& l : s.loops) {
    l.origin_parent *= length;
    l.origin_child *= length;
  }
  return s;
}

TEST(Index, DoesNotDependOnUnits) {
  for (const double unit : {1e-3, 1e3}) {
    for (const Scene& s : {in_units(row_of_four_bars(2, 1.1, 0.7), unit, 1, 1),
                           in_units(row_of_four_bars(2, 1.1, 0.7), 1, unit, 1),
                           in_units(row_of_four_bars(2, 1.1, 0.7), 1, 1, unit)}) {
      const Mechanism mechanism(s);
      expect_promised(mechanism, equations::start_of(mechanism), least_gap);
    }
  }
}

TEST(Index, DrivenMechanismsKeepTheirs) {
  // The first crank prescribed: Φ_t and its derivatives in time are in every level of the array.
  Scene s = row_of_four_bars(2, 1.1);
  s.bodies.push_back(rod("rider"));
  s.joints.push_back(hinge("R", "level0", "rider", {0.5, 0, 0}, 0.4));
  s.drives.push_back(equations::harmonic("O0", 1.1, 0.3, 2.0));
  const Mechanism mechanism(s);
  ASSERT_TRUE(mechanism.plan().drives);
  expect_promised(mechanism, equations::start_of(mechanism), least_gap);
}

TEST(Index, RedundantLoopsHaveNone) {
  // A planar four-bar closed by a hinge in space: three of five equations say nothing new, at every
  // pose. Their multipliers are free for ever, q and p are not.
  const Mechanism planar(scene_of("four_bar/scene.toml"), {.algebra = Algebra::spatial});
  const Mechanism bricards(bricard());
  for (const Mechanism* mechanism : {&planar, &bricards}) {
    const Assembly a = assemble(*mechanism);
    const int redundant = mechanism->m() - a.rank;
    ASSERT_GT(redundant, 0);
    const IndexStudy study = run_index_study(*mechanism, a.start, {});
    EXPECT_EQ(study.loops.rank, a.rank);
    for (const FormIndex& f : study.forms) {
      SCOPED_TRACE(study.scene + ", " + f.form);
      if (!f.dae) {
        EXPECT_EQ(f.inner.rank, f.inner_size - (f.words.penalised ? 0 : redundant));
        continue;
      }
      EXPECT_EQ(f.found.index, -1);
      EXPECT_TRUE(f.found.decided) << f.found.why;
      EXPECT_EQ(f.text(), "not defined");
      EXPECT_FALSE(f.ida_holds);
      ASSERT_EQ(f.found.levels.size(), static_cast<std::size_t>(most_differentiations) + 1);
      const bool both = f.form.find("stabilised") != std::string::npos;
      EXPECT_EQ(f.found.levels.back().undetermined, both ? 2 * redundant : redundant);
      EXPECT_GE(f.blocks[0].determined_after, 0) << "q";
      EXPECT_EQ(f.blocks.back().determined_after, -1);
    }
  }
}

TEST(Index, ASingularPoseOfIndependentLoopsHasNoneThere) {
  // The row of four-bars lying flat: Φ_q loses rank at this pose alone.
  const Mechanism upright(row_of_four_bars(2, 1.1)), flat(row_of_four_bars(2, 0));
  const IndexStudy regular =
                       run_index_study(upright, equations::start_of(upright), {"momentum-index2"}),
                   singular = run_index_study(flat, equations::start_of(flat), {"momentum-index2"});
  EXPECT_EQ(regular.loops.rank, upright.m());
  EXPECT_LT(singular.loops.rank, flat.m());
  EXPECT_EQ(regular.forms[0].found.index, 2);
  EXPECT_NE(singular.forms[0].found.index, 2);
}

/// A rod that grows, its pivot shaken.
Scene driven_pendulum() {
  Scene s = scene_of("pendulum/cartesian.toml");
  DriveSpec growing;
  growing.loop = "bar";
  growing.kind = "harmonic";
  growing.offset = 1;
  growing.amplitude = 0.2;
  growing.frequency = 1.3;
  growing.phase = 0.4;
  s.drives.push_back(growing);
  return s;
}

TEST(Index, DrivenLoopsKeepTheirs) {
  for (const Scene& scene :
       {driven_pendulum(), scene_of("driven/scene.toml"), scene_of("driven/swing.toml")}) {
    const Mechanism mechanism(scene);
    ASSERT_TRUE(mechanism.plan().drives);
    expect_promised(mechanism, equations::start_of(mechanism), least_gap);
  }
}

TEST(Index, WithoutLoopsTheFormsAreOdes) {
  const Mechanism mechanism(scene_of("chain/scene.toml"));
  const Start start = equations::start_of(mechanism);
  const IndexStudy study = run_index_study(mechanism, start, {});
  ASSERT_EQ(study.forms.size(), 2u);
  for (const auto& f : study.forms) EXPECT_EQ(f.inner.rank, mechanism.nv());
  const IndexStudy implicit = run_index_study(mechanism, start, {"acceleration-index3"});
  EXPECT_EQ(implicit.forms[0].found.index, 0);
}

// ---- the series of a form's equations -----------------------------------------------------------

/// F(t, y(t), y'(t)) at t0 + s along y = Σ c_k s^k.
std::vector<double> residual_at(DaeForm& form, double t0, double s, const Eigen::MatrixXd& c) {
  const auto n = static_cast<std::size_t>(form.size());
  std::vector<double> y(n, 0.0), ydot(n, 0.0), r(n);
  for (std::size_t i = 0; i < n; ++i)
    for (Eigen::Index k = c.cols(); k-- > 0;) {
      y[i] = y[i] * s + c(static_cast<Eigen::Index>(i), k);
      if (k > 0)
        ydot[i] = ydot[i] * s + static_cast<double>(k) * c(static_cast<Eigen::Index>(i), k);
    }
  EXPECT_TRUE(form.residual(t0 + s, y.data(), ydot.data(), r.data())) << form.failure();
  return r;
}

TEST(Index, SeriesOfTheEquationsAreTheirDerivativesInTime) {
  Scene driven = row_of_four_bars(1, 1.1);
  driven.bodies.push_back(rod("rider"));
  driven.joints.push_back(hinge("R", "level0", "rider", {0.5, 0, 0}, 0.4));
  driven.drives.push_back(equations::harmonic("R", 0.4, 0.3, 2.0));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-0.5, 0.5);
  // Loops of every kind driven in every way.
  std::vector<Scene> scenes{scene_of("andrews/scene.toml"), platform(3), driven, driven_pendulum()};
  for (unsigned seed = 0; seed < 36; ++seed) {
    RandomTree tree(seed);
    Scene scene = tree.scene({.bodies = 4});
    scene.loops.push_back(random_loop(tree, scene, loop_kinds[seed % loop_kinds.size()]));
    drive_loop(tree, scene, scene.loops.back(), 7, 7);
    if (const auto coupler = random_coupler(tree, scene)) {
      scene.loops.push_back(*coupler);
      drive_loop(tree, scene, *coupler, 1, 0);
    }
    scenes.push_back(scene);
  }
  int tried = 0;
  for (const Scene& scene : scenes) {
    const Mechanism mechanism(scene);
    Start start{0,
                mechanism.tree().q0,
                mechanism.tree().u0,
                Eigen::VectorXd::Zero(mechanism.nv()),
                Eigen::VectorXd::Zero(mechanism.m()),
                {}};
    // The residual of redundant loops is regularised, their series are not.
    const auto e = mechanism.evaluation<double>();
    const auto kkt = make_dense_kkt(mechanism);

    if (!kkt->factor(*e, start.t, start.q.data(), fade_evaluation) || kkt->faded() > 0) continue;
    ++tried;
    for (const auto& name : form_names()) {
      if (!is_dae_form(name)) continue;
      SCOPED_TRACE(scene.name + ", " + name);
      const auto form = make_form(name, mechanism, {}, start);
      auto& dae = dynamic_cast<DaeForm&>(*form);
      const auto n = static_cast<std::size_t>(dae.size());
      Eigen::MatrixXd c(dae.size(), jet_order + 1);
      for (double& x : c.reshaped()) x = any(random);
      c.col(0).head(mechanism.nq()) = start.q;
      std::vector<Jet> y(n), ydot(n), r(n);
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k <= jet_order; ++k) {
          const double value = c(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
          y[i].a.c[k] = value;
          if (k > 0) ydot[i].a.c[k - 1] = static_cast<double>(k) * value;
        }
      const double t0 = 0.25;  // not at the knot of a table
      dae.along(t0, y.data(), ydot.data(), r.data());
      // Five-point differences, error O(h⁴).
      const double h = 1e-3;
      std::vector<std::vector<double>> at;
      for (int k = -2; k <= 2; ++k) at.push_back(residual_at(dae, t0, k * h, c));
      for (std::size_t i = 0; i < n; ++i) {
        const double first = (at[0][i] - 8 * at[1][i] + 8 * at[3][i] - at[4][i]) / (12 * h),
                     second =
                         (-at[0][i] + 16 * at[1][i] - 30 * at[2][i] + 16 * at[3][i] - at[4][i]) /
                         (12 * h * h);
        const double size = 1 + std::abs(r[i].a.c[0]) + std::abs(r[i].a.c[1]) +
                            std::abs(r[i].a.c[2]) + std::abs(r[i].a.c[3]) + std::abs(r[i].a.c[4]);
        EXPECT_NEAR(r[i].a.c[0], at[2][i], 1e-12 * size) << i;
        EXPECT_NEAR(r[i].a.c[1], first, 1e-8 * size) << i;
        EXPECT_NEAR(2 * r[i].a.c[2], second, 1e-6 * size) << i;
      }
    }
  }
  EXPECT_GE(tried, 9);
}

}  // namespace
}  // namespace momenta::dae_index
