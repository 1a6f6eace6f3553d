// Rows open/momentum/<model>/<n>/…/threads<T>, in real time, ns_per_body of a state:
//
//   states<N>   N states shared by T threads that start and end with the call
//   halves      one state of two stars with n bodies in all, one after the other, or each on a
//   thread
//               of its own that spins until it is told: the best that sharing the branches of one
//               state could give

#include <benchmark/benchmark.h>
#include <momenta/core/open_chain/open_chain.h>

#include <atomic>
#include <string>
#include <thread>

#include "models.h"

namespace momenta {
namespace {

void count_bodies(benchmark::State& state, double bodies) {
  state.counters["ns_per_body"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * bodies * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// Some state of a chain, with memory for its rates.
struct Moving {
  OpenChain chain;
  Eigen::VectorXd q, p, qdot, pdot;

  explicit Moving(const Scene& scene)
      : chain(scene), q(chain.tree().q0), p(chain.nv()), qdot(chain.nq()), pdot(chain.nv()) {
    chain.momenta(0, q, Eigen::VectorXd::Random(chain.nv()), p);
  }
  void evaluate() {
    chain.rates(0, q, p, qdot, pdot);
    benchmark::DoNotOptimize(pdot.data());
  }
  double bodies() const { return static_cast<double>(chain.tree().bodies.size()); }
};

void shared_states(benchmark::State& state, Eigen::Index count, int threads) {
  Moving one(benchmark_models::random_chain(63));
  const StateMatrix q = one.q.replicate(1, count), p = one.p.replicate(1, count);
  StateMatrix qdot(q), pdot(p);
  for (auto _ : state) {
    one.chain.rates_of_states(0, q, p, qdot, pdot, threads);
    benchmark::DoNotOptimize(pdot.data());
  }
  count_bodies(state, one.bodies() * static_cast<double>(count));
}

void halves(benchmark::State& state, int bodies, int threads) {
  const Scene half = benchmark_models::star(bodies / 2);
  Moving mine(half), other(half);
  std::atomic<long> asked{0}, done{0};
  std::jthread second;
  if (threads == 2)
    second = std::jthread([&](std::stop_token end) {
      for (long turn = 1;; ++turn) {
        while (asked.load(std::memory_order_acquire) < turn)
          if (end.stop_requested()) return;
        other.evaluate();
        done.store(turn, std::memory_order_release);
      }
    });
  for (auto _ : state) {
    asked.fetch_add(1, std::memory_order_release);
    mine.evaluate();
    if (threads == 1)
      other.evaluate();
    else
      while (done.load(std::memory_order_acquire) < asked.load(std::memory_order_relaxed)) {
      }
  }
  count_bodies(state, mine.bodies() + other.bodies());
}

}  // namespace

void register_threads() {
  for (const int threads : {1, 2}) {
    const std::string tail = "/threads" + std::to_string(threads);
    for (const int states : {64, 256, 1024, 4096})
      benchmark::RegisterBenchmark(
          ("open/momentum/random_chain/63/states" + std::to_string(states) + tail).c_str(),
          shared_states, states, threads)
          ->UseRealTime();
    for (const int n : {64, 256, 1024, 4096, 16384, 65536})
      benchmark::RegisterBenchmark(
          ("open/momentum/star/" + std::to_string(n) + "/halves" + tail).c_str(), halves, n,
          threads)
          ->UseRealTime();
  }
}

}  // namespace momenta
