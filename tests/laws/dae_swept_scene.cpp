// A run that cuts other joints than the scene reports the scene as it is written: every column, in
// every form, as the run that cuts what the scene cuts.

#include "equations/large_scenes.h"
#include "equations/recut.h"

#include <gtest/gtest.h>
#include <momenta/core/scene/files/read_scene.h>
#include <momenta/dae/assembly/assembly.h>
#include <momenta/dae/cut/swept_scene.h>
#include <momenta/dae/cut/written_motion.h>
#include <momenta/dae/study/run_form.h>

#include <cmath>
#include <numbers>

namespace momenta::dae_swept_scene {
namespace {

using namespace equations;
using Eigen::VectorXd;

Scene example(const std::string& name) {
  return read_scene(std::filesystem::path(MOMENTA_SOURCE_DIR) / "examples" / name / "scene.toml");
}

/// An example of hinges, written with another joint cut.
Scene badly_cut(const std::string& name, const std::string& cut, const std::string& joined) {
  const Mechanism mechanism(example(name));
  return equations::recut(mechanism.scene(), mechanism.tree(), assemble(mechanism).start.q, cut,
                          joined);
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
    double size = 1;
    for (const auto& row : b.trajectory.rows) size = std::max(size, std::abs(row[c]));
    for (std::size_t i = 0; i < a.trajectory.rows.size(); ++i)
      ASSERT_NEAR(a.trajectory.rows[i][c], b.trajectory.rows[i][c], drifts ? drift : bound * size)
          << what << ": " << name << " in row " << i;
  }
}

struct Case {
  Scene scene;
  double end;
};
std::vector<Case> cases() {
  return {{arch(20), 1},
          {badly_cut("andrews", "F", "E2"), 0.02},
          {badly_cut("andrews", "A5", "E4"), 0.02},
          {badly_cut("andrews", "H", "E6"), 0.02}};
}

TEST(SweptScene, RunsReportTheSceneAsWritten) {
  int anew = 0;
  for (const auto& [scene, end] : cases()) {
    const Mechanism chosen(scene), kept(scene, {.cut = CutChoice::scene});
    const Start start = assemble(chosen).start;
    anew += SweptScene(chosen, start).anew();
    EXPECT_FALSE(SweptScene(kept, start).anew());
    for (const std::string form : {"momentum", "projected", "stabilised-index2"})
      expect_same(run_of(chosen, start, form, end, 1e-10), run_of(kept, start, form, end, 1e-10),
                  form == "stabilised-index2" ? 1e-4 : 1e-6, 1e-7, scene.name + " " + form);
  }
  EXPECT_GE(anew, 2);
}

/// An angle is counted in whole turns, as an integrated one is.
TEST(SweptScene, AnglesOfCutJointsCountTurns) {
  const Mechanism written(badly_cut("four_bar", "A", "B")), swept(example("four_bar"));
  const Start start = assemble(written).start;
  const Assembly a = assemble(swept);
  WrittenMotion motion(written, start, swept);
  RunRequest request;
  request.settings = default_settings({}, "projected", "", 1e-10);
  request.settings.end_time = 30;
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

TEST(SweptScene, TheStartIsTheSceneS) {
  for (const auto& [scene, end] : cases()) {
    const Mechanism written(scene);
    const Start start = assemble(written).start;
    const SweptScene swept(written, start);
    if (!swept.anew()) continue;
    WrittenMotion motion(written, start, swept.mechanism());
    VectorXd q, u;
    motion.read(start.t, swept.start().q, swept.start().u, q, u);
    EXPECT_LT((q - start.q).lpNorm<Eigen::Infinity>(), 1e-9) << scene.name;
    EXPECT_LT((u - start.u).lpNorm<Eigen::Infinity>(), 1e-8 * (1 + start.u.norm())) << scene.name;
  }
}

}  // namespace
}  // namespace momenta::dae_swept_scene
