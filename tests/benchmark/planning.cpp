// Rows planning/<what>/<family>/<bodies>: what a mechanism costs before its first evaluation.
//
//   mechanism   a scene to a Mechanism: its tree, its loops, its plan
//   assemble    a consistent start
//   recut       where to cut its loops
//
// Families are those of `momenta make`.

#include <benchmark/benchmark.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/topology/assembly/assembly.h>
#include <momenta/dae/topology/cut/recut.h>

#include <memory>

#include "made_scenes.h"

namespace momenta {
namespace {

/// The mechanism that was asked for last: rows of one size follow one another.
class Planned {
 public:
  static const Planned& of(const benchmark_models::Family& family, int bodies) {
    static std::unique_ptr<Planned> last;
    if (!last || last->family_ != family.name || last->bodies_ != bodies) {
      last.reset();
      last.reset(new Planned(family, bodies));
    }
    return *last;
  }
  const Scene& scene() const { return mechanism_.scene(); }
  const Mechanism& mechanism() const { return mechanism_; }
  const Start& start() const {
    if (!start_) start_ = std::make_unique<Start>(assemble(mechanism_).start);
    return *start_;
  }

 private:
  Planned(const benchmark_models::Family& family, int bodies)
      : family_(family.name),
        bodies_(bodies),
        mechanism_(parse_scene(benchmark_models::made_scene(family.name, family.size(bodies)))) {}
  std::string family_;
  int bodies_;
  Mechanism mechanism_;
  mutable std::unique_ptr<Start> start_;
};

}  // namespace

void register_planning() {
  for (const benchmark_models::Family& family : benchmark_models::families)
    for (const int bodies : {10, 100, 1000, 10000, 100000}) {
      const auto add = [&](const char* what, const auto& work) {
        const std::string name = std::string("planning/") + what + "/" + family.name + "/";
        benchmark::RegisterBenchmark((name + std::to_string(bodies)).c_str(),
                                     [=, &family](benchmark::State& state) {
                                       const Planned& planned = Planned::of(family, bodies);
                                       work(state, planned);
                                       state.counters["bodies"] =
                                           static_cast<double>(planned.scene().bodies.size());
                                     })
            ->Unit(benchmark::kMillisecond);
      };
      add("mechanism", [](benchmark::State& state, const Planned& planned) {
        for (auto _ : state) {
          state.PauseTiming();
          auto scene = std::make_unique<Scene>(planned.scene());
          std::unique_ptr<Mechanism> mechanism;
          state.ResumeTiming();
          mechanism = std::make_unique<Mechanism>(std::move(*scene));
          state.PauseTiming();
          mechanism.reset();
          state.ResumeTiming();
        }
      });
      add("assemble", [](benchmark::State& state, const Planned& planned) {
        for (auto _ : state) benchmark::DoNotOptimize(assemble(planned.mechanism()).moved);
      });
      add("recut", [](benchmark::State& state, const Planned& planned) {
        std::size_t cut = 0;
        for (auto _ : state) cut = recut(planned.mechanism(), planned.start()).cut.size();
        state.counters["cut_anew"] = static_cast<double>(cut);
      });
    }
}

}  // namespace momenta
