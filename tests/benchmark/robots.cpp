// Rows robots/<form>/<file>: one right-hand side of each robot of examples/models, and of the
// folder that MOMENTA_MODELS names, counter ns_per_evaluation; the label says how many rates and
// equations there are and what solves them. Trees take OpenChain's calls, (q, p) → (q̇, ṗ) and (q,
// u) → u̇; loops what runs integrate (dae/topology/cut/integrated_scene.h), (7)-(8) and (3).

#include <benchmark/benchmark.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/open_chain/open_chain.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/topology/assembly/assembly.h>
#include <momenta/dae/topology/cut/integrated_scene.h>

#include "nanoseconds.h"
#include "robot_files.h"

namespace momenta {
namespace {

namespace fs = std::filesystem;

void finish(benchmark::State& state, const std::string& label) {
  state.SetLabel(label);
  benchmark_models::count_nanoseconds(state, "ns_per_evaluation", 1);
}

void time_tree(benchmark::State& state, const Scene& scene, bool momentum) {
  OpenChain chain(scene);
  const Eigen::VectorXd q = chain.tree().q0;
  Eigen::VectorXd p(chain.nv()), u(chain.nv()), qdot(chain.nq()), rate(chain.nv());
  for (int i = 0; i < u.size(); ++i) u[i] = std::sin(i + 1);
  chain.momenta(0, q, u, p);
  bool ok = true;
  for (auto _ : state) {
    ok &= momentum ? chain.rates(0, q, p, qdot, rate) : chain.accelerations(0, q, u, rate);
    benchmark::DoNotOptimize(rate.data());
  }
  if (!ok) return state.SkipWithError(chain.failure().c_str());
  finish(state, std::to_string(chain.nv()) + " rates, tree");
}

void time_loops(benchmark::State& state, const Scene& scene, bool momentum) {
  const Mechanism written(scene);
  const Start written_start = assemble(written).start;
  const IntegratedScene integrated(written, written_start);
  const Mechanism& mechanism = integrated.mechanism();
  if (mechanism.m() == 0) return time_tree(state, mechanism.scene(), momentum);
  const Start& start = integrated.start();
  const auto e = mechanism.evaluation<double>();
  const auto solver = make_loop_solver(mechanism, *e);
  const Eigen::VectorXd centre = Eigen::VectorXd::Zero(mechanism.m());
  Eigen::VectorXd p(mechanism.nv()), u = p, rate = p, sigma = centre;
  e->place(0, start.q.data());
  e->move(start.u.data());
  e->momenta(nullptr, p.data());
  bool ok = true;
  for (auto _ : state) {
    ok &= momentum ? solver->momentum(0, start.q.data(), p.data(), centre.data(), fade_evaluation,
                                      3, u.data(), sigma.data(), rate.data())
                   : solver->acceleration(0, start.q.data(), start.u.data(), centre.data(), 0, 0,
                                          rate.data(), sigma.data());
    benchmark::DoNotOptimize(rate.data());
  }
  if (!ok) return state.SkipWithError("no solution");
  const char* by = mechanism.solver().kkt() == KktChoice::sweeps  ? "sweeps"
                   : mechanism.solver().kkt() == KktChoice::dense ? "dense"
                                                                  : "sparse";
  finish(state, std::to_string(mechanism.nv()) + " rates, " + std::to_string(mechanism.m()) +
                    " equations, " + by);
}

}  // namespace

void register_robots() {
  for (const fs::path& file : robot_files())
    for (const bool momentum : {true, false}) {
      const std::string name =
          std::string("robots/") + (momentum ? "momentum/" : "acceleration/") + short_name(file);
      benchmark::RegisterBenchmark(name.c_str(), [file, momentum](benchmark::State& state) {
        try {
          const Scene scene = read_scene(file);
          if (scene.loops.empty())
            time_tree(state, scene, momentum);
          else
            time_loops(state, scene, momentum);
        } catch (const std::exception& e) {
          state.SkipWithError(e.what());
        }
      });
    }
}

}  // namespace momenta
