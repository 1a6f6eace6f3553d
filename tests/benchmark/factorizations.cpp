// (7) by sparse factorisations: which matrix, which library. A table: times of the analysis, of a
// factorisation with the pivots at hand and of a solution with one step of refinement, entries of
// the factors, and how far u is from that of the sweeps.
//
//   joints   M and Φ_q                                     (kkt_pattern of the mechanism)
//   bodies   Ω, u, P*, σ of every body                     (dae/kkt/body_matrix.h)
//
// CHOLMOD does not pivot: ±δ of the scale stands on the diagonal where it is zero, and its errors
// are those of δ after one refinement of the equations without it.
//
// Usage: momenta_factorizations [MOST]   mechanisms of at most so many cells or pairs; 1000

#include <momenta/dae/kkt/body_matrix.h>
#include <momenta/dae/kkt/kkt.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/kkt/loop_units.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "equations/large_scenes.h"
#include "equations/linkages.h"
#include "processor_time.h"
#include "pushed_state.h"
#include "sparse_solvers.h"

namespace momenta {
namespace {

using benchmark_solvers::SparseSolver;
using Eigen::VectorXd;

/// A system to solve: (7) for one state, by one of its matrices.
struct System {
  std::string name;
  SymmetricMatrix matrix, shifted;  ///< shifted: with δ on the diagonal
  std::vector<double> right;
  int rates = 0;  ///< place of u among the unknowns
};

constexpr double delta = 1e-9;

System joints_of(const Mechanism& mechanism, const PushedState& s) {
  const KktPattern& pattern = mechanism.kkt_pattern();
  const int n = mechanism.nv(), m = mechanism.m();
  std::vector<KktPattern::Entry> entries = pattern.mass;
  for (const auto& e : pattern.constraint) entries.push_back({n + e.row, e.column});
  System system{"joints", {n + m, entries}, {n + m, entries}, {}, 0};
  std::vector<double> mass(pattern.mass.size()), constraint(pattern.constraint.size());
  const auto e = mechanism.evaluation<double>();
  e->place(0, s.q.data());
  e->mass_entries(mass.data());
  e->constraint_entries(constraint.data());
  const std::vector<double> scale = row_scales(mechanism, *e);
  for (SymmetricMatrix* a : {&system.matrix, &system.shifted}) {
    for (std::size_t i = 0; i < mass.size(); ++i) a->set(i, mass[i]);
    for (std::size_t i = 0; i < constraint.size(); ++i) a->set(mass.size() + i, constraint[i]);
  }
  for (int i = 0; i < m; ++i)
    system.shifted.set_diagonal(n + i, -delta * scale[static_cast<std::size_t>(i)]);
  system.right.assign(static_cast<std::size_t>(n + m), 0.0);
  std::copy_n(s.p.data(), n, system.right.begin());
  return system;
}

System bodies_of(const Mechanism& mechanism, const PushedState& s) {
  return with_body_matrix(mechanism, [&](auto equations) {
    const int size = equations->size(), n = mechanism.nv();
    System system{"bodies",
                  {size, equations->entries()},
                  {size, equations->entries()},
                  std::vector<double>(static_cast<std::size_t>(size)),
                  equations->rate(0)};
    equations->place(0, s.q.data());
    for (SymmetricMatrix* a : {&system.matrix, &system.shifted}) {
      std::size_t i = 0;
      equations->each_entry([&](int, int, double x) { a->set(i++, x); });
    }
    const int bodies = equations->rate(0) / 2;
    for (int i = 0; i < bodies; ++i) system.shifted.set_diagonal(bodies + i, -delta);
    for (int i = 0; i < n; ++i) system.shifted.set_diagonal(equations->rate(i), delta);
    for (int i = 0; i < mechanism.m(); ++i)
      system.shifted.set_diagonal(equations->impulse(i), -delta);
    std::copy_n(s.p.data(), n, system.right.begin() + system.rates);
    return system;
  });
}

void row(const char* mechanism, int n, const std::string& matrix, const std::string& how,
         double analysis, double factorisation, double solution, double entries, double error) {
  const auto cell = [](double x, const char* format) {
    char text[32] = "";
    if (x >= 0) std::snprintf(text, sizeof text, format, x);
    return std::string(text);
  };
  std::printf("| %s | %d | %s | %s | %s | %s | %s | %s | %s |\n", mechanism, n, matrix.c_str(),
              how.c_str(), cell(analysis, "%.3g").c_str(), cell(factorisation, "%.3g").c_str(),
              cell(solution, "%.3g").c_str(), cell(entries, "%.0f").c_str(),
              cell(error, "%.0e").c_str());
  std::fflush(stdout);
}

void measure(const char* name, int n, System& system, SparseSolver& solver, bool shifts,
             const VectorXd& exact) {
  const SymmetricMatrix& a = shifts ? system.shifted : system.matrix;
  double analysis = HUGE_VAL;
  for (int i = 0; i < 3; ++i) {
    const double from = processor_seconds();
    if (!solver.analyse(a))
      return row(name, n, system.name, solver.name() + ": refused", -1, -1, -1, -1, -1);
    analysis = std::min(analysis, 1e3 * (processor_seconds() - from));
  }
  if (!solver.factor(a))
    return row(name, n, system.name, solver.name() + ": singular", analysis, -1, -1, -1, -1);
  const double factorisation = least_ms([&] { solver.factor(a); });
  std::vector<double> x, r(system.right.size());
  const double solution = least_ms([&] {
    x = system.right;
    solver.solve(x);
    system.matrix.residual(system.right.data(), x.data(), r.data());
    solver.solve(r);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += r[i];
  });
  const VectorXd u = Eigen::Map<const VectorXd>(x.data() + system.rates, exact.size());
  row(name, n, system.name, solver.name(), analysis, factorisation, solution, solver.entries(),
      (u - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff());
}

void measure(const char* name, int n, const Scene& scene) {
  using namespace benchmark_solvers;
  const Mechanism mechanism(scene);
  const PushedState s = pushed_state(mechanism, mechanism.tree().q0);
  VectorXd exact(mechanism.nv()), sigma(mechanism.m());
  const auto e = mechanism.evaluation<double>();
  const auto sweeps = make_loop_solver(mechanism, *e);
  const auto once = [&] {
    sweeps->momentum(0, s.q.data(), s.p.data(), nullptr, fade_evaluation, 0, exact.data(),
                     sigma.data(), nullptr);
  };
  once();
  row(name, n, "none", "sweeps, all of it", -1, -1, least_ms(once), -1, -1);
  constexpr double most_mass = 3e6;  // entries of M: beyond that the joints' matrix is left out
  double depths = 0;
  std::vector<int> depth;
  for (const auto& b : mechanism.tree().bodies) {
    depth.push_back(b.parent < 0 ? 1 : 1 + depth[static_cast<std::size_t>(b.parent)]);
    depths += depth.back();
  }
  const VectorXd zero = VectorXd::Zero(mechanism.m());
  const auto ours = [&](const char* how, std::unique_ptr<Kkt> (*make)(const Mechanism&)) {
    const double from = processor_seconds();
    const auto kkt = make(mechanism);
    const double analysis = 1e3 * (processor_seconds() - from);
    VectorXd u(exact.size());
    kkt->factor(*e, 0, s.q.data(), fade_evaluation);
    const double factorisation = least_ms([&] { kkt->factor(*e, 0, s.q.data(), fade_evaluation); });
    const double solution =
        least_ms([&] { kkt->solve(s.p.data(), zero.data(), nullptr, u.data(), sigma.data()); });
    row(name, n, how, "as the program has it, places and assembly with it", analysis, factorisation,
        solution, -1, (u - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff());
  };
  if (depths <= most_mass) ours("joints, filtered LDLᵀ", make_sparse_kkt);
  ours("bodies, KLU", make_body_kkt);
  std::vector<System> systems;
  if (depths <= most_mass) systems.push_back(joints_of(mechanism, s));
  systems.push_back(bodies_of(mechanism, s));
  for (System& system : systems)
    for (const auto& solver :
         {make_klu(system.name == "bodies"), make_umfpack(), make_cholmod(), make_spqr()})
      measure(name, n, system, *solver, solver->name() == "CHOLMOD LDLᵀ", exact);
}

}  // namespace
}  // namespace momenta

int main(int argc, char** argv) {
  using namespace momenta;
  const int most = argc > 1 ? std::atoi(argv[1]) : 1000;
  std::printf(
      "| mechanism | n | matrix | by | analysis [ms] | factorisation [ms] | solution [ms] | "
      "entries | error of u |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  for (const int n : {40, 200, 1000, 10000})
    if (n <= most) measure("n-four-bar", n, equations::row_of_four_bars(n, 1.1, 1));
  for (const int n : {50, 200, 1000, 10000})
    if (n <= most) measure("ladder", n, equations::crossed_bars(n));
}
