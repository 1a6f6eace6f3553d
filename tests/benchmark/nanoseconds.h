#pragma once
// Counters of time.

#include <benchmark/benchmark.h>

namespace momenta::benchmark_models {

/// Nanoseconds of each of `per_iteration` things that an iteration does.
inline void count_nanoseconds(benchmark::State& state, const char* counter, double per_iteration) {
  state.counters[counter] =
      benchmark::Counter(static_cast<double>(state.iterations()) * per_iteration * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

}  // namespace momenta::benchmark_models
