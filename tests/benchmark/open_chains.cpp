// Rows open/<algorithm>/<model>/<n>: one evaluation of an open chain, counter ns_per_body; with
// /batch<width> states side by side, ns per body and state. 64 states in turn, so that no branch or
// value is learned by heart.

#include <benchmark/benchmark.h>
#include <momenta/core/kernel/levels/open_sweeps.h>
#include <momenta/core/open_chain/open_chain.h>

#include <algorithm>
#include <vector>

#include "models.h"
#include "nanoseconds.h"

namespace momenta {
namespace {

using MakeScene = Scene (*)(int);

struct Row {
  const char* name;
  MakeScene model;
  Algebra algebra = Algebra::automatic;
  int level = 0;  ///< 0: the machine's best
  bool branches_side_by_side = true;
};

constexpr int states_in_turn = 64;

/// States as columns.
struct States64 {
  StateMatrix q, u, p;
  explicit States64(OpenChain& chain)
      : q(chain.nq(), states_in_turn),
        u(chain.nv(), states_in_turn),
        p(chain.nv(), states_in_turn) {
    for (int i = 0; i < states_in_turn; ++i) {
      Eigen::VectorXd position = chain.tree().q0, rate = Eigen::VectorXd::Random(chain.nv());
      Eigen::VectorXd momentum(chain.nv());
      for (const auto& b : chain.tree().bodies)
        if (b.nq == 1) position[b.q] += 0.02 * i;
      chain.momenta(0, position, rate, momentum);
      q.col(i) = position;
      u.col(i) = rate;
      p.col(i) = momentum;
    }
  }
};

void finish(benchmark::State& state, double bodies) {
  benchmark_models::count_nanoseconds(state, "ns_per_body", bodies);
}

enum class Algorithm { momentum, acceleration };

void single(benchmark::State& state, Row row, Algorithm algorithm) {
  OpenChain chain(row.model(static_cast<int>(state.range(0))), row.algebra, row.level,
                  row.branches_side_by_side);
  const States64 states(chain);
  std::vector<Eigen::VectorXd> q, x;
  for (int i = 0; i < states_in_turn; ++i) {
    q.emplace_back(states.q.col(i));
    x.emplace_back(algorithm == Algorithm::momentum ? states.p.col(i) : states.u.col(i));
  }
  Eigen::VectorXd qdot(chain.nq()), rate(chain.nv());
  std::size_t i = 0;
  for (auto _ : state) {
    const std::size_t k = i++ % states_in_turn;
    if (algorithm == Algorithm::momentum)
      chain.rates(0, q[k], x[k], qdot, rate);
    else
      chain.accelerations(0, q[k], x[k], rate);
    benchmark::DoNotOptimize(rate.data());
  }
  finish(state, static_cast<double>(chain.tree().bodies.size()));
}

/// Composite inertias with a sparse factorisation of M, and inverse dynamics: through the levels
/// directly, as chains offer neither.
void classical(benchmark::State& state, Row row, bool inverse) {
  const Scene scene = row.model(static_cast<int>(state.range(0)));
  OpenChain chain(scene, Algebra::spatial);
  const States64 states(chain);
  const Model<Spatial> model = build_spatial_model(chain.tree(), scene);
  const LinkTree links = build_links(model);
  const auto sweeps = make_sweeps(links, best_level());
  const auto nv = static_cast<std::size_t>(chain.nv());
  std::vector<double> in(nv, 0.0), out(nv);
  std::vector<Eigen::VectorXd> q, u;
  for (int i = 0; i < states_in_turn; ++i) {
    q.emplace_back(states.q.col(i));
    u.emplace_back(states.u.col(i));
  }
  std::size_t i = 0;
  for (auto _ : state) {
    const std::size_t k = i++ % states_in_turn;
    if (inverse)
      sweeps->inverse_dynamics(0, q[k].data(), u[k].data(), in.data(), out.data());
    else
      sweeps->composite_acceleration(0, q[k].data(), u[k].data(), in.data(), out.data());
    benchmark::DoNotOptimize(out.data());
  }
  finish(state, static_cast<double>(chain.tree().bodies.size()));
}

/// What else the sweeps give, per call.
enum class Call {
  velocities_to_momenta,
  inverse_mass,
  inverse_mass_there,
  jacobian_times,
  jacobian,
  reactions
};

void further(benchmark::State& state, Row row, Call call) {
  OpenChain chain(row.model(static_cast<int>(state.range(0))), row.algebra);
  const States64 states(chain);
  const Eigen::VectorXd q = states.q.col(0), u = states.u.col(0), p = states.p.col(0);
  Eigen::VectorXd x(chain.nv()), qdot(chain.nq());
  chain.inverse_mass_times(0, q, p, x);
  for (auto _ : state) {
    switch (call) {
      case Call::velocities_to_momenta:
        chain.momenta(0, q, u, x);
        break;
      case Call::inverse_mass:
        chain.inverse_mass_times(0, q, p, x);
        break;
      case Call::inverse_mass_there:
        chain.inverse_mass_times(p, x);
        break;
      case Call::jacobian_times:
        chain.jacobian_times(0, q, p, q, p, qdot, x);
        break;
      case Call::jacobian:
        benchmark::DoNotOptimize(chain.jacobian(0, q, p).data());
        break;
      case Call::reactions:
        benchmark::DoNotOptimize(chain.reactions(0, q, u).data());
        break;
    }
    benchmark::DoNotOptimize(x.data());
  }
  finish(state, static_cast<double>(chain.tree().bodies.size()));
}

void batch(benchmark::State& state, Row row, Algorithm algorithm) {
  OpenChain chain(row.model(static_cast<int>(state.range(0))), row.algebra, row.level);
  const States64 states(chain);
  StateMatrix qdot(chain.nq(), states_in_turn), rate(chain.nv(), states_in_turn);
  for (auto _ : state) {
    if (algorithm == Algorithm::momentum)
      chain.rates_of_states(0, states.q, states.p, qdot, rate);
    else
      chain.accelerations_of_states(0, states.q, states.u, rate);
    benchmark::DoNotOptimize(rate.data());
  }
  finish(state, static_cast<double>(chain.tree().bodies.size()) * states_in_turn);
}

Scene without_gravity(int n) {
  Scene s = benchmark_models::random_chain(n);
  s.gravity.setZero();
  return s;
}
/// Every tenth joint driven.
Scene with_drives(int n) {
  Scene s = benchmark_models::random_chain(n);
  for (std::size_t i = 5; i < s.joints.size(); i += 10) {
    DriveSpec d;
    d.joint = s.joints[i].name;
    d.kind = "harmonic";
    d.amplitude = 0.3;
    d.frequency = 2;
    s.drives.push_back(d);
  }
  return s;
}

int batch_width() {
  const int level = best_level();
  return level >= 4 ? 8 : level >= 3 ? 4 : 2;
}

void add(const char* name, const Row& row, Algorithm algorithm, std::vector<int> sizes) {
  const std::string head = std::string("open/") +
                           (algorithm == Algorithm::momentum ? "momentum/" : "acceleration/") +
                           name;
  for (const int n : sizes)
    benchmark::RegisterBenchmark(head.c_str(), single, row, algorithm)->Arg(n);
}
void add_batches(const char* name, const Row& row, Algorithm algorithm, std::vector<int> sizes) {
  const std::string head = std::string("open/") +
                           (algorithm == Algorithm::momentum ? "momentum/" : "acceleration/") +
                           name;
  for (const int n : sizes)
    benchmark::RegisterBenchmark(
        (head + "/" + std::to_string(n) + "/batch" + std::to_string(batch_width())).c_str(), batch,
        row, algorithm)
        ->Arg(n);
}

}  // namespace

void register_open_chains() {
  using namespace benchmark_models;
  const std::vector<int> all = {1, 2, 4, 7, 16, 63, 1000, 10000, 100000}, some = {7, 63, 1000},
                         balls = {1, 2, 4, 7, 8, 16, 63, 128, 1000};
  const Row rows[] = {
      {"random_chain", random_chain},       {"right_angle_chain", right_angle_chain},
      {"planar_chain", planar_chain},       {"rope", rope},
      {"binary_tree", binary_tree},         {"star", star},
      {"spherical_chain", spherical_chain}, {"slide_and_pin_chain", prismatic_and_revolute_chain},
      {"helical_chain", helical_chain},     {"random_chain_with_drives", with_drives}};
  for (const auto algorithm : {Algorithm::momentum, Algorithm::acceleration}) {
    for (const Row& row : rows) {
      add(row.name, row, algorithm,
          row.model == random_chain      ? all
          : row.model == spherical_chain ? balls
                                         : some);
      add_batches(row.name, row, algorithm, some);
    }
    const Row person{"humanoid", humanoid};
    add(person.name, person, algorithm, {31});
    const Row body_by_body[] = {
        {"binary_tree_body_by_body", binary_tree, Algebra::automatic, 0, false},
        {"star_body_by_body", star, Algebra::automatic, 0, false},
        {"humanoid_body_by_body", humanoid, Algebra::automatic, 0, false}};
    for (const Row& row : body_by_body)
      add(row.name, row, algorithm, row.model == humanoid ? std::vector{31} : some);
  }
  for (const bool inverse : {false, true}) {
    const std::string head = inverse ? "open/inverse_dynamics/" : "open/composite/";
    for (const Row& row :
         {Row{"random_chain", random_chain}, Row{"right_angle_chain", right_angle_chain},
          Row{"binary_tree", binary_tree}, Row{"spherical_chain", spherical_chain}})
      for (const int n : {7, 63})
        benchmark::RegisterBenchmark((head + row.name).c_str(), classical, row, inverse)->Arg(n);
    benchmark::RegisterBenchmark((head + "humanoid").c_str(), classical, Row{"humanoid", humanoid},
                                 inverse)
        ->Arg(31);
  }
  const std::pair<const char*, Call> calls[] = {
      {"momenta", Call::velocities_to_momenta},
      {"inverse_mass_times", Call::inverse_mass},
      {"inverse_mass_times_there", Call::inverse_mass_there},
      {"jacobian_times", Call::jacobian_times},
      {"jacobian", Call::jacobian},
      {"reactions", Call::reactions}};
  for (const auto& [name, call] : calls)
    for (const int n : {7, 32})
      benchmark::RegisterBenchmark((std::string("open/") + name + "/random_chain").c_str(), further,
                                   Row{"random_chain", random_chain}, call)
          ->Arg(n);
  // What the plan leaves out, and what a level brings.
  const Row omissions[] = {
      {"random_chain_without_gravity", without_gravity},
      {"planar_chain_in_space", planar_chain, Algebra::spatial},
      {"random_chain_level1", random_chain, Algebra::automatic, 1},
      {"random_chain_level3", random_chain, Algebra::automatic, 3},
  };
  for (const Row& row : omissions)
    if (row.level == 0 || level_at_most(row.level) == row.level)
      add(row.name, row, Algorithm::momentum, some);
}

}  // namespace momenta
