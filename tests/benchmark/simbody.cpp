// Rows simbody/<model>/<n>: Simbody on the scenes of the rows open/… and closed/… of the same run,
// from q and u to accelerations, all of it anew (realize to Stage::Acceleration), counter
// ns_per_evaluation. `difference` is the largest between its accelerations and momenta's, relative
// to the largest of them or to 1, at the scene's start with rates sin 1, sin 2, … of trees, and
// those of the assembled start of loops. The label says how many rates there are and how many
// equations Simbody makes of the loops. Rows simbody/robots/<file>: the robots of robots.cpp that
// are trees of revolute, prismatic and free joints without springs, dampers or friction.
//
// Debian's library has its assertions on and is compiled for plain x86-64; of a build for the
// machine, without them, up to 3.6 times less time was measured.

#include <benchmark/benchmark.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/open_chain/open_chain.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <algorithm>
#include <string>
#include <vector>

#include "equations/linkages.h"
#include "models.h"
#include "nanoseconds.h"
#include "robot_files.h"
#include "simbody_system.h"

namespace momenta {
namespace {

struct AtStart {
  Eigen::VectorXd q, u, accelerations;
  bool planar = false;
};

AtStart tree_at_start(const Scene& scene) {
  OpenChain chain(scene);
  AtStart at{chain.tree().q0, Eigen::VectorXd(chain.nv()), Eigen::VectorXd(chain.nv())};
  for (int i = 0; i < at.u.size(); ++i) at.u[i] = std::sin(i + 1);
  if (!chain.accelerations(0, at.q, at.u, at.accelerations))
    throw std::runtime_error(chain.failure());
  return at;
}

AtStart loops_at_start(const Scene& scene) {
  const Mechanism mechanism(scene);
  const Start start = assemble(mechanism).start;
  AtStart at{start.q, start.u, start.u, mechanism.plan().planar};
  for (const LoopSpec& loop : scene.loops)  // loops without an axis are across z
    if (loop.kind != LoopKind::revolute && std::abs(mechanism.plan().basis(2, 2)) < 1)
      at.planar = false;
  const auto e = mechanism.evaluation<double>();
  const auto solver = make_loop_solver(mechanism, *e);
  Eigen::VectorXd centre = Eigen::VectorXd::Zero(mechanism.m()), lambda = centre;
  if (!solver->acceleration(0, at.q.data(), at.u.data(), centre.data(), 0, 0,
                            at.accelerations.data(), lambda.data()))
    throw std::runtime_error("no solution");
  return at;
}

void time_scene(benchmark::State& state, const Scene& scene) {
  const AtStart at = scene.loops.empty() ? tree_at_start(scene) : loops_at_start(scene);
  benchmark_models::SimbodySystem system(scene, at.planar);
  system.set(at.q, at.u);
  for (auto _ : state) system.evaluate();
  state.counters["difference"] = (system.accelerations() - at.accelerations).cwiseAbs().maxCoeff() /
                                 std::max(1.0, at.accelerations.cwiseAbs().maxCoeff());
  state.SetLabel(std::to_string(system.rates()) + " rates, " + std::to_string(system.equations()) +
                 " equations");
  benchmark_models::count_nanoseconds(state, "ns_per_evaluation", 1);
}

template <class Make>
void add(const std::string& name, Make make) {
  benchmark::RegisterBenchmark(("simbody/" + name).c_str(), [make](benchmark::State& state) {
    try {
      time_scene(state, make());
    } catch (const std::exception& e) {
      std::string line = e.what();
      std::replace(line.begin(), line.end(), '\n', ' ');
      state.SkipWithError(line.c_str());
    }
  });
}

}  // namespace

void register_simbody() {
  const auto add_sizes = [](const std::string& name, Scene (*model)(int), std::vector<int> sizes) {
    for (const int n : sizes) add(name + "/" + std::to_string(n), [=] { return model(n); });
  };
  namespace models = benchmark_models;
  add_sizes("random_chain", models::random_chain, {1, 2, 7, 63, 1000});
  add_sizes("spherical_chain", models::spherical_chain, {1, 2, 4, 16, 63});
  add_sizes("binary_tree", models::binary_tree, {63});
  add_sizes("humanoid", models::humanoid, {31});
  add_sizes("n_four_bar", models::n_four_bar, {5, 40, 200});
  add_sizes("ladder", models::scissor_ladder, {10, 50});
  add_sizes("stewart", equations::platform, {6});
  add("four_bar/1", models::four_bar);
  add("bricard/1", equations::bricard);
  for (const std::filesystem::path& file : robot_files())
    add("robots/" + short_name(file), [file] { return read_scene(file); });
}

}  // namespace momenta
