// Rows closed/<form>/<model>/<n>: one right-hand side of a mechanism with loops, counter
// ns_per_evaluation, with the error of its rates against quadruple precision. `momentum` is (7)-(8)
// with leak and centre, (q, p) → (u, σ, ṗ); `acceleration` is (3), (q, v) → (u̇, λ). Loops are
// carried by the sweeps; _sparse and _dense assemble the matrix. 16 states in turn, near the start.

#include <benchmark/benchmark.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/kernel/levels/level.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include "equations/linkages.h"
#include "equations/quad_loops.h"
#include "models.h"
#include "nanoseconds.h"

namespace momenta {
namespace {

constexpr int states_in_turn = 16;
constexpr double leak = 3;

struct Row {
  const char* form;
  Scene (*model)(int);
  Algebra algebra = Algebra::automatic;
  KktChoice kkt = KktChoice::sweeps;
  int level = 0;
  bool branches_side_by_side = true;
};

/// States close to the scene's start, assembled where that is cheap (the models of any size start
/// closed), with momenta of its velocity and others besides.
struct States16 {
  std::vector<Eigen::VectorXd> q, p, v;
  Eigen::VectorXd centre;
  explicit States16(const Mechanism& mechanism) {
    Start start;
    start.q = mechanism.tree().q0;
    start.u = mechanism.tree().u0;
    if (mechanism.m() <= 40) start = assemble(mechanism).start;
    const auto e = mechanism.evaluation<double>();
    for (int i = 0; i < states_in_turn; ++i) {
      Eigen::VectorXd at = start.q, momentum(mechanism.nv());
      for (const auto& b : mechanism.tree().bodies)
        if (b.nq == 1) at[b.q] += 1e-9 * i;
      Eigen::VectorXd rate = start.u;
      e->place(0, at.data());
      e->move(rate.data());
      e->momenta(nullptr, momentum.data());
      Eigen::VectorXd inertia(mechanism.nv());
      e->mass_diagonal(inertia.data());
      for (Eigen::Index k = 0; k < inertia.size(); ++k)  // any p is consistent
        momentum[k] += inertia[k] * std::sin(static_cast<double>(k + 1));
      q.push_back(at);
      v.push_back(rate);
      p.push_back(momentum);
    }
    centre = Eigen::VectorXd::Zero(mechanism.m());
  }
};

void finish(benchmark::State& state, double evaluations) {
  benchmark_models::count_nanoseconds(state, "ns_per_evaluation", evaluations);
}

double error(const Eigen::VectorXd& x, const Eigen::VectorXd& exact) {
  return (x - exact).cwiseAbs().maxCoeff() / std::max(1.0, exact.cwiseAbs().maxCoeff());
}

void time_row(benchmark::State& state, Row row) {
  const Mechanism mechanism(row.model(static_cast<int>(state.range(0))), {row.algebra, row.kkt});
  const States16 s(mechanism);
  const bool momentum = std::string(row.form) == "momentum";
  const auto nv = mechanism.nv();
  Eigen::VectorXd u(nv), sigma(mechanism.m()), rate(nv), zero = Eigen::VectorXd::Zero(nv);
  std::size_t i = 0;
  const auto time = [&](auto&& one) {
    for (auto _ : state) {
      one();
      benchmark::DoNotOptimize(rate.data());
      i = (i + 1) % states_in_turn;
    }
    i = 0;  // leaves the rates of the first state
    one();
  };
  if (mechanism.solver().kkt() == KktChoice::sweeps) {
    const auto sweeps = mechanism.solver().sweeps(row.level, row.branches_side_by_side);
    RightSide<double> right;
    right.centre = s.centre.data();
    right.fade = fade_evaluation;
    right.leak = leak;
    right.rates = true;
    const auto one = [&] {
      if (momentum)
        sweeps->momentum(0, s.q[i].data(), s.p[i].data(), right, u.data(), sigma.data(),
                         rate.data());
      else
        sweeps->acceleration(0, s.q[i].data(), s.v[i].data(), zero.data(), right, rate.data(),
                             sigma.data());
    };
    time(one);
  } else {
    const auto e = mechanism.evaluation<double>();
    const auto solver = make_loop_solver(mechanism, *e);
    const auto one = [&] {
      if (momentum)
        solver->momentum(0, s.q[i].data(), s.p[i].data(), s.centre.data(), fade_evaluation, leak,
                         u.data(), sigma.data(), rate.data());
      else
        solver->acceleration(0, s.q[i].data(), s.v[i].data(), s.centre.data(), 0, 0, rate.data(),
                             sigma.data());
    };
    time(one);
  }
  finish(state, 1);
  if (mechanism.has_body_forces() || mechanism.has_joint_forces()) return;
  const LoopedRates exact = quad_rates(mechanism, s.q[0], s.p[0], s.v[0], leak, fade_evaluation);
  if (momentum) state.counters["error_rates"] = error(u, exact.u);
  state.counters[momentum ? "error_momentum_rates" : "error_accelerations"] =
      error(rate, momentum ? exact.pdot : exact.udot);
}

/// States side by side in the lanes of a pack.
void evaluate_batch(benchmark::State& state, Row row) {
  const Mechanism mechanism(row.model(static_cast<int>(state.range(0))), {row.algebra, row.kkt});
  const States16 s(mechanism);
  const auto sweeps = mechanism.solver().sweeps(row.level);
  const auto nq = mechanism.nq(), nv = mechanism.nv(), m = mechanism.m();
  using States = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const bool momentum = std::string(row.form) == "momentum";
  States q(nq, states_in_turn), x(nv, states_in_turn), found(nv, states_in_turn),
      pdot(nv, states_in_turn), multipliers(m, states_in_turn);
  for (int i = 0; i < states_in_turn; ++i) {
    const auto k = static_cast<std::size_t>(i);
    q.col(i) = s.q[k];
    x.col(i) = momentum ? s.p[k] : s.v[k];
  }
  const LoopedStates states{q.data(),    x.data(),       found.data(),  multipliers.data(),
                            pdot.data(), states_in_turn, states_in_turn};
  for (auto _ : state) {
    if (momentum)
      sweeps->momentum(0, states, fade_evaluation, leak);
    else
      sweeps->acceleration(0, states, fade_evaluation);
    benchmark::DoNotOptimize(found.data());
  }
  finish(state, states_in_turn);
}

Scene one_four_bar(int) {
  return benchmark_models::four_bar();
}
Scene andrews(int) {
  Scene s = read_scene(std::string(MOMENTA_SOURCE_DIR) + "/examples/andrews/scene.toml");
  s.forces.clear();
  return s;
}
Scene andrews_chained(int n) {
  Scene s = andrews(n);
  // E4 to FE instead of BDE, E6 to GE: consecutive subtrees share loops.
  const auto tie = [&](std::size_t loop, std::size_t to) {
    s.loops[loop].parent = s.loops[to].child;
    s.loops[loop].origin_parent = s.loops[to].origin_child;
  };
  tie(2, 1);
  return s;
}
Scene stewart(int) {
  return equations::platform(6);
}
Scene bricard(int) {
  return equations::bricard();
}

}  // namespace

void register_closed_loops() {
  for (const char* form : {"momentum", "acceleration"}) {
    const auto add = [&](const std::string& model, Row row, std::vector<long> sizes,
                         const std::string& how = "") {
      row.form = form;
      for (const long n : sizes)
        benchmark::RegisterBenchmark(("closed/" + std::string(form) + how + "/" + model).c_str(),
                                     time_row, row)
            ->Arg(n);
    };
    const Row four{form, one_four_bar}, andrew{form, andrews}, chained{form, andrews_chained},
        bars{form, benchmark_models::n_four_bar}, ladder{form, benchmark_models::scissor_ladder},
        platform{form, stewart}, six{form, bricard};
    add("four_bar", four, {1});
    add("andrews", andrew, {1});
    add("andrews_chained", chained, {1});
    add("n_four_bar", bars, {5, 40, 200, 1000, 10000});
    add("ladder", ladder, {10, 50, 200, 1000, 10000});
    add("stewart", platform, {1});
    Row leg_by_leg = platform;
    leg_by_leg.branches_side_by_side = false;
    add("stewart", leg_by_leg, {1}, "_leg_by_leg");
    add("bricard", six, {1});
    Row in_space = four;
    in_space.algebra = Algebra::spatial;
    add("four_bar_in_space", in_space, {1});
    for (const int level : {1, 3}) {
      if (level_at_most(level) != level) continue;
      const auto at = [&](Row row) {
        row.level = level;
        return row;
      };
      const std::string how = "_level" + std::to_string(level);
      add("four_bar", at(four), {1}, how);
      add("andrews", at(andrew), {1}, how);
      add("n_four_bar", at(bars), {40}, how);
      add("stewart", at(platform), {1}, how);
    }
    for (const auto kkt : {KktChoice::sparse, KktChoice::dense}) {
      const auto by = [&](Row row) {
        row.kkt = kkt;
        return row;
      };
      const std::string how = std::string("_") + name_of(kkt);
      add("four_bar", by(four), {1}, how);
      add("andrews", by(andrew), {1}, how);
      add("n_four_bar", by(bars), {5, 40}, how);
      add("ladder", by(ladder), {10, 50}, how);
      add("stewart", by(platform), {1}, how);
    }
  }
  const std::string batch = "/batch" + std::to_string(best_level() >= 4   ? 8
                                                      : best_level() >= 3 ? 4
                                                                          : 2);
  const auto add_batch = [&](const std::string& model, Scene (*made)(int), std::vector<long> sizes,
                             Algebra algebra = Algebra::automatic) {
    for (const char* form : {"momentum", "acceleration"})
      for (const long n : sizes)
        benchmark::RegisterBenchmark(("closed/" + std::string(form) + "/" + model + batch).c_str(),
                                     evaluate_batch, Row{form, made, algebra})
            ->Arg(n);
  };
  add_batch("four_bar", one_four_bar, {1});
  add_batch("andrews", andrews, {1});
  add_batch("andrews_chained", andrews_chained, {1});
  add_batch("n_four_bar", benchmark_models::n_four_bar, {40, 200, 1000, 10000});
  add_batch("ladder", benchmark_models::scissor_ladder, {10, 50, 200, 1000, 10000});
  add_batch("stewart", stewart, {1});
  add_batch("bricard", bricard, {1});
  add_batch("four_bar_in_space", one_four_bar, {1}, Algebra::spatial);
}

}  // namespace momenta
