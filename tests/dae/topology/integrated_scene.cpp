// A run that cuts other joints than the scene reports the scene as it is written: every column, in
// every form, as the run that cuts what the scene cuts.

#include "equations/examples.h"
#include "equations/large_scenes.h"
#include "equations/linkages.h"
#include "equations/random_tree.h"
#include "equations/recut.h"

#include <gtest/gtest.h>
#include <momenta/dae/analysis/chain/closed_chain.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/topology/assembly/assembly.h>
#include <momenta/dae/topology/cut/integrated_scene.h>
#include <momenta/dae/topology/cut/interchange.h>
#include <momenta/dae/topology/cut/original_scene_motion.h>

#include <cmath>
#include <numbers>

namespace momenta::dae_integrated_scene {
namespace {

using namespace equations;
using Eigen::VectorXd;
using equations::example;

/// A scene of hinges, with other joints cut: {made a loop, made a joint}, one after the other.
Scene written_otherwise(Scene scene,
                        const std::vector<std::pair<std::string, std::string>>& exchanged) {
  for (const auto& [cut, joined] : exchanged) {
    const Mechanism mechanism(scene);
    scene = equations::recut(scene, mechanism.tree(), assemble(mechanism).start.q, cut, joined);
  }
  return scene;
}

/// A row of four-bars as one chain of rods with loops to the ground.
Scene chained_row(int n) {
  std::vector<std::pair<std::string, std::string>> exchanged;
  for (int i = 1; i <= n; ++i)
    exchanged.push_back({"O" + std::to_string(i), "C" + std::to_string(i - 1)});
  return written_otherwise(row_of_four_bars(n, 1.1), exchanged);
}

/// Crossed bars, cut at the pins in their middle.
Scene bars_cut_in_the_middle(int n) {
  std::vector<std::pair<std::string, std::string>> exchanged;
  for (int i = 1; i < n; ++i)
    exchanged.push_back({"B" + std::to_string(i), "C" + std::to_string(i)});
  return written_otherwise(crossed_bars(n), exchanged);
}

/// A wheel on `carrier` that turns by `ratio` times the angle of a joint, which starts at `angle`.
void add_rotor(Scene& s, const std::string& carrier, const std::string& joint, double ratio,
               double angle) {
  BodySpec rotor;
  rotor.name = "rotor of " + joint;
  rotor.mass = 0.2;
  rotor.inertia.diagonal() << 0.005, 0.005, 0.01;
  s.bodies.push_back(rotor);
  s.joints.push_back(hinge("shaft of " + joint, carrier, rotor.name, {0.3, 0, 0}, ratio * angle));
  LoopSpec gear;
  gear.name = "gear of " + joint;
  gear.kind = LoopKind::coupler;
  gear.joints = {"shaft of " + joint, joint};
  gear.ratios = {1, -ratio};
  s.loops.push_back(gear);
}

/// A driven crank with a rotor on the ground, a pendulum with one on the moving coupler.
Scene shaken_pendulum_with_rotors() {
  Scene s = example("driven");
  add_rotor(s, "ground", "O", 5, s.drives.front().offset);
  add_rotor(s, "coupler", "M", -6, -0.5108);
  return s;
}

RunResult run_of(const Mechanism& mechanism, const Start& start, const std::string& form,
                 double end, double rtol) {
  RunRequest request;
  request.settings = default_settings({}, form, "", rtol);
  request.settings.atol = rtol;
  request.settings.end_time = end;
  request.settings.samples = 25;
  request.keep_trajectory = true;
  return run_form(mechanism, start, request);
}

/// Columns of two runs agree within `bound` of the column's size, drifts within `drift`.
void expect_same(const RunResult& a, const RunResult& b, double bound, double drift,
                 const std::string& what) {
  ASSERT_EQ(a.status, "done") << what << ": " << a.reason;
  ASSERT_EQ(b.status, "done") << what << ": " << b.reason;
  ASSERT_EQ(a.trajectory.columns, b.trajectory.columns) << what;
  ASSERT_EQ(a.trajectory.rows.size(), b.trajectory.rows.size()) << what;
  for (std::size_t c = 0; c < a.trajectory.columns.size(); ++c) {
    const std::string& name = a.trajectory.columns[c];
    const bool drifts = name.find("drift") != std::string::npos;
    // drives leave energy undefined, in both
    if (name == "energy [J]" && std::isnan(a.trajectory.rows[0][c]) &&
        std::isnan(b.trajectory.rows[0][c]))
      continue;
    double size = 1;
    for (const auto& row : b.trajectory.rows) size = std::max(size, std::abs(row[c]));
    for (std::size_t i = 0; i < a.trajectory.rows.size(); ++i)
      ASSERT_NEAR(a.trajectory.rows[i][c], b.trajectory.rows[i][c], drifts ? drift : bound * size)
          << what << ": " << name << " in row " << i;
  }
}

/// The trees on the ground in a random order, some loops seen from their other body.
Scene shuffled(Scene scene, unsigned seed) {
  RandomTree random(seed);
  for (std::size_t i = scene.joints.size(); i-- > 1;)
    std::swap(scene.joints[i],
              scene.joints[static_cast<std::size_t>(random.below(static_cast<int>(i) + 1))]);
  for (LoopSpec& loop : scene.loops)
    if (random.chance(0.5)) loop = reversed(loop);
  return scene;
}

Scene turning(Scene scene, double rate) {
  scene.joints.front().velocity = {rate};
  return scene;
}

struct Case {
  Scene scene;
  double end;
};
std::vector<Case> cases() {
  return {{arch(20), 1},
          {chained_row(5), 1},
          {bars_cut_in_the_middle(4), 0.5},
          {turning(equations::geared(example("four_bar"), {0.5, 0.2, 0}, 0), 3), 5},
          {shaken_pendulum_with_rotors(), 3},
          {written_otherwise(example("andrews"), {{"F", "E2"}}), 0.02}};
}

TEST(IntegratedScene, RunsReportTheSceneAsWritten) {
  int anew = 0;
  for (const auto& [scene, end] : cases()) {
    const Mechanism chosen(scene), kept(scene, {.cut = CutChoice::scene});
    const Start start = assemble(chosen).start;
    anew += IntegratedScene(chosen, start).anew();
    EXPECT_FALSE(IntegratedScene(kept, start).anew());
    for (const std::string form : {"momentum", "projected", "stabilised-index2"})
      expect_same(run_of(chosen, start, form, end, 1e-10), run_of(kept, start, form, end, 1e-10),
                  form == "stabilised-index2" ? 1e-4 : 1e-6, 1e-7, scene.name + " " + form);
  }
  EXPECT_EQ(anew, 4);  // of the arch sweeps gain nothing, of Andrews' too little
}

/// Loops between trees on the ground are open over all that stand between.
TEST(IntegratedScene, TheOrderOfTreesDoesNotMatter) {
  int carried_anew = 0;
  for (unsigned seed = 0; seed < 5; ++seed)
    for (const Scene& scene : {row_of_four_bars(25, 1.1), platform(6)}) {
      const Mechanism written(shuffled(scene, seed));
      const Start start = assemble(written).start;
      const IntegratedScene integrated(written, start);
      const Mechanism good(scene);
      EXPECT_EQ(integrated.mechanism().solver().kkt(), KktChoice::sweeps)
          << scene.name << " " << seed;
      EXPECT_LE(cut_cost(integrated.mechanism()).work, cut_cost(good).work)
          << scene.name << " " << seed;
      carried_anew += written.solver().kkt() != KktChoice::sweeps;
      const Mechanism kept(written.scene(), {.cut = CutChoice::scene});
      expect_same(run_of(written, start, "momentum", 0.1, 1e-10),
                  run_of(kept, start, "momentum", 0.1, 1e-10), 1e-6, 1e-7, scene.name);
    }
  EXPECT_GE(carried_anew, 5);
}

/// A band cut across has as many loops open as it is long; along it, two.
TEST(IntegratedScene, ALadderCutAcrossIsCarriedBySweeps) {
  const Mechanism written(bars_cut_in_the_middle(60));
  EXPECT_NE(written.solver().kkt(), KktChoice::sweeps);
  const Start start = assemble(written).start;
  const IntegratedScene integrated(written, start);
  EXPECT_EQ(integrated.mechanism().solver().kkt(), KktChoice::sweeps);
  EXPECT_LE(cut_cost(integrated.mechanism()).work, cut_cost(Mechanism(crossed_bars(60))).work);
}

TEST(IntegratedScene, BranchesOfOneShapeGoSideBySideHoweverTheirLoopsAreWritten) {
  const auto how = [](const Mechanism& mechanism) {
    for (const auto& [what, words] : plan_lines(mechanism))
      if (what == "solving (7)") return words;
    return std::string();
  };
  const Mechanism good(platform(6));
  ASSERT_NE(how(good), "");
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Mechanism written(shuffled(platform(6), seed));
    const Start start = assemble(written).start;
    EXPECT_EQ(how(IntegratedScene(written, start).mechanism()), how(good)) << seed;
  }
}

/// For programs with integrators of their own: the accelerations of joints that are in both.
TEST(IntegratedScene, OfAProgramHasTheSameAccelerations) {
  int compared = 0;
  for (const auto& [scene, end] : cases()) {
    ClosedChain written(scene), integrated(integrated_scene(scene));
    const Start a = written.assemble().start, b = integrated.assemble().start;
    VectorXd a_udot(written.nv()), a_lambda(written.m()), b_udot(integrated.nv()),
        b_lambda(integrated.m());
    ASSERT_TRUE(written.accelerations(0, a.q, a.u, a_udot, a_lambda)) << written.failure();
    ASSERT_TRUE(integrated.accelerations(0, b.q, b.u, b_udot, b_lambda)) << integrated.failure();
    const double size = a_udot.lpNorm<Eigen::Infinity>();
    for (const Tree::Body& body : written.mechanism().tree().bodies)
      for (const Tree::Body& other : integrated.mechanism().tree().bodies)
        if (body.joint == other.joint && body.nv == other.nv)
          for (int i = 0; i < body.nv; ++i, ++compared) {
            EXPECT_NEAR(a.u[body.u + i], b.u[other.u + i], 1e-8) << scene.name << body.joint;
            EXPECT_NEAR(a_udot[body.u + i], b_udot[other.u + i], 1e-8 * size)
                << scene.name << " " << body.joint;
          }
  }
  EXPECT_GE(compared, 40);
}

/// Other coordinates for a gain of less than a tenth are nobody's wish.
TEST(IntegratedScene, SmallGainsAreLeft) {
  const Mechanism written(example("four_bar"));
  const Start start = assemble(written).start;
  const Recut found = momenta::recut(written, start);
  ASSERT_TRUE(found.gains());
  EXPECT_FALSE(IntegratedScene(written, start).anew());
  EXPECT_FALSE(IntegratedScene(written, start, &found).anew());
}

/// An angle is counted in whole turns, as an integrated one is.
TEST(IntegratedScene, AnglesOfCutJointsCountTurns) {
  Scene spinning = example("four_bar");
  spinning.gravity.setZero();
  spinning.joints[0].velocity = {9};
  Scene other = written_otherwise(spinning, {{"A", "B"}});
  for (JointSpec& joint : other.joints)
    if (joint.name == "O") joint.velocity = {9};
  other.held = {"O"};
  // the pin of the crank, which turns with it, is a joint of the one and a loop of the other
  const Mechanism swept(other), written(spinning);
  const Start start = assemble(written).start;
  const Assembly a = assemble(swept);
  OriginalSceneMotion motion(written, start, {written.scene(), {}, {}}, swept);
  RunRequest request;
  request.settings = default_settings({}, "projected", "", 1e-10);
  request.settings.end_time = 10;
  request.settings.samples = 40;
  request.keep_trajectory = true;
  const RunResult by_itself = run_form(written, start, request),
                  by_other = run_form(swept, a.start, request);
  ASSERT_EQ(by_itself.status, "done");
  ASSERT_EQ(by_other.status, "done");
  VectorXd q, u;
  double turns = 0;
  for (std::size_t i = 0; i < by_other.trajectory.rows.size(); ++i) {
    const auto& row = by_other.trajectory.rows[i];
    const VectorXd swept_q = Eigen::Map<const VectorXd>(row.data() + 1, swept.nq()),
                   swept_u = Eigen::Map<const VectorXd>(row.data() + 1 + swept.nq(), swept.nv());
    motion.read(row[0], swept_q, swept_u, q, u);
    const auto& expected = by_itself.trajectory.rows[i];
    for (int k = 0; k < written.nq(); ++k) {
      ASSERT_NEAR(q[k], expected[static_cast<std::size_t>(1 + k)], 1e-4) << i << " " << k;
      turns = std::max(turns, std::abs(q[k]) / (2 * std::numbers::pi));
    }
    for (int k = 0; k < written.nv(); ++k)
      ASSERT_NEAR(u[k], expected[static_cast<std::size_t>(1 + written.nq() + k)], 1e-3);
  }
  EXPECT_GT(turns, 2);
}

TEST(IntegratedScene, TheStartIsTheSceneS) {
  for (const auto& [scene, end] : cases()) {
    const Mechanism written(scene);
    const Start start = assemble(written).start;
    const IntegratedScene integrated(written, start);
    if (!integrated.anew()) continue;
    OriginalSceneMotion motion(written, start, integrated.folded(), integrated.mechanism());
    VectorXd q, u;
    motion.read(start.t, integrated.start().q, integrated.start().u, q, u);
    EXPECT_LT((q - start.q).lpNorm<Eigen::Infinity>(), 1e-9) << scene.name;
    EXPECT_LT((u - start.u).lpNorm<Eigen::Infinity>(), 1e-8 * (1 + start.u.norm())) << scene.name;
  }
}

}  // namespace
}  // namespace momenta::dae_integrated_scene
