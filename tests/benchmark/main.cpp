#include <benchmark/benchmark.h>

namespace momenta {
void register_open_chains();
void register_closed_loops();
void register_robots();
void register_descriptions();
void register_planning();
#ifdef MOMENTA_WITH_MUJOCO
void register_mujoco();
#endif
#ifdef MOMENTA_WITH_SIMBODY
void register_simbody();
#endif
void register_threads();
}  // namespace momenta

int main(int argc, char** argv) {
  momenta::register_open_chains();
  momenta::register_closed_loops();
  momenta::register_robots();
#ifdef MOMENTA_WITH_MUJOCO
  momenta::register_mujoco();
#endif
#ifdef MOMENTA_WITH_SIMBODY
  momenta::register_simbody();
#endif
  momenta::register_descriptions();
  momenta::register_planning();
  momenta::register_threads();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
