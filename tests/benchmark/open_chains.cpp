// Rows open/<algorithm>/<model>/<n>: one evaluation of an open chain, counter ns_per_body.

#include <benchmark/benchmark.h>
#include <momenta/core/open_chain.h>

#include "models.h"

namespace momenta {
namespace {

using MakeScene = Scene (*)(int);

/// 64 states in turn, so that no branch or value is learned by heart.
class States {
 public:
  explicit States(OpenChain& chain) {
    for (int i = 0; i < 64; ++i) {
      Eigen::VectorXd q = chain.tree().q0, u = Eigen::VectorXd::Random(chain.nv()), p(chain.nv());
      for (const auto& b : chain.tree().bodies)
        if (b.nq == 1) q[b.q] += 0.02 * i;
      chain.momenta(0, q, u, p);
      q_.push_back(q);
      u_.push_back(u);
      p_.push_back(p);
    }
  }
  std::vector<Eigen::VectorXd> q_, u_, p_;
};

void finish(benchmark::State& state, int bodies) {
  state.counters["ns_per_body"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * bodies * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void momentum(benchmark::State& state, MakeScene model, Algebra algebra) {
  OpenChain chain(model(static_cast<int>(state.range(0))), algebra);
  const States states(chain);
  Eigen::VectorXd qdot(chain.nq()), pdot(chain.nv());
  std::size_t i = 0;
  for (auto _ : state) {
    chain.rates(0, states.q_[i & 63], states.p_[i & 63], qdot, pdot);
    benchmark::DoNotOptimize(pdot.data());
    ++i;
  }
  finish(state, static_cast<int>(chain.tree().bodies.size()));
}

void acceleration(benchmark::State& state, MakeScene model, Algebra algebra) {
  OpenChain chain(model(static_cast<int>(state.range(0))), algebra);
  const States states(chain);
  Eigen::VectorXd udot(chain.nv());
  std::size_t i = 0;
  for (auto _ : state) {
    chain.accelerations(0, states.q_[i & 63], states.u_[i & 63], udot);
    benchmark::DoNotOptimize(udot.data());
    ++i;
  }
  finish(state, static_cast<int>(chain.tree().bodies.size()));
}

Scene without_gravity(int n) {
  Scene s = benchmark_models::random_chain(n);
  s.gravity.setZero();
  return s;
}

}  // namespace

void register_open_chains() {
  struct Row {
    const char* name;
    MakeScene model;
    Algebra algebra;
  };
  using namespace benchmark_models;
  const Row rows[] = {{"random_chain", random_chain, Algebra::automatic},
                      {"random_chain_without_gravity", without_gravity, Algebra::automatic},
                      {"right_angle_chain", right_angle_chain, Algebra::automatic},
                      {"planar_chain", planar_chain, Algebra::automatic},
                      {"planar_chain_in_space", planar_chain, Algebra::spatial},
                      {"binary_tree", binary_tree, Algebra::automatic},
                      {"spherical_chain", spherical_chain, Algebra::automatic}};
  for (const Row& row : rows)
    for (const int n : {7, 63, 1000}) {
      benchmark::RegisterBenchmark((std::string("open/momentum/") + row.name).c_str(), momentum,
                                   row.model, row.algebra)
          ->Arg(n);
      benchmark::RegisterBenchmark((std::string("open/acceleration/") + row.name).c_str(),
                                   acceleration, row.model, row.algebra)
          ->Arg(n);
    }
}

}  // namespace momenta
