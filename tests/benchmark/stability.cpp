// What rounding costs the two states of an open chain, (q, p) and (q, u): errors of one evaluation
// and of a second of motion in double precision, against quad precision for the same doubles.
//
//   momenta_stability [--json FILE]
//
// Every figure is max |error| / max |value| over the chain, but for the energy norm; five random
// states a row, median and worst. Takes some minutes.

#include <momenta/core/kernel/mass_matrix.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <limits>
#include <random>

#include "both_states.h"
#include "exact_chain.h"
#include "stability_cases.h"

namespace momenta::stability {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

struct Column {
  const char* key;
  const char* title;
  const char* meaning;
};
enum Which {
  condition,
  bound,
  p_rounded,
  qdot,
  qdot_energy,
  pdot,
  qdot_dense,
  qddot,
  rate_p,
  rate_u,
  path_p,
  path_u
};
constexpr Column columns[] = {
    {"condition", "cond M", "largest row sum of |M| times that of |M^-1|, n <= 100"},
    {"bound", "bound", "max |M^-1| |M| |u| / max |u| times half a unit of rounding, n <= 100"},
    {"p_rounded", "p rounded",
     "q' from p = M u computed exactly, then rounded to double, all else exact: no algorithm can "
     "do better"},
    {"qdot", "q' from p", "the momentum recursion in double, from that p"},
    {"qdot_energy", "in energy",
     "its error d in the energy norm, sqrt(d'Md / u'Mu), by kinetic energies"},
    {"pdot", "p'", "the other output of the same evaluation"},
    {"qdot_dense", "q', Cholesky", "M u = p with the dense M and its Cholesky factor, n <= 1000"},
    {"qddot", "q'' from u", "the acceleration recursion in double, from (q, u)"},
    {"rate_p", "fastest of (q, p)",
     "largest eigenvalue of the rates' Jacobian at the start [1/s], n <= 100"},
    {"rate_u", "fastest of (q, u)", "the same for the state (q, u)"},
    {"path_p", "1 s of (q, p)",
     "angles after 1 s in steps of RK4, against the same steps in quad, n <= 100; dash: some state "
     "blows up at this step even in quad"},
    {"path_u", "1 s of (q, u)", "the same with the acceleration recursion"},
};
constexpr std::size_t column_count = std::size(columns);
using Figures = std::array<double, column_count>;

struct State {
  Doubles q, u;
};
State random_state(const Case& c, unsigned seed) {
  std::mt19937 random(1000 + seed);
  std::uniform_real_distribution<double> any(-1, 1);
  State s;
  for (int i = 0; i < c.n; ++i) s.q.push_back(c.spread * any(random));
  for (int i = 0; i < c.n; ++i) s.u.push_back(any(random));
  return s;
}

template <class S>
Quads difference(const std::vector<S>& x, const Quads& y) {
  Quads d(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) d[i] = Quad(x[i]) - y[i];
  return d;
}
template <class S>
double error(const std::vector<S>& found, const Quads& exact) {
  return value_of(largest(difference(found, exact)) / largest(exact));
}

double path_error(const Doubles& found, const Quads& exact) {
  // A chain that turned a thousand times in a second did not: the method blew up.
  constexpr double most = 6e3;
  if (exact.empty() || !(largest(exact) < most)) return nothing;
  const bool lost = found.empty() || !(largest(found) < most);
  return lost ? std::numeric_limits<double>::infinity() : error(found, exact);
}
Doubles joined(Doubles a, const Doubles& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// q̇ from the dense M = L Lᵀ, row by row; empty where a pivot is not positive.
Doubles by_cholesky(const Model<Spatial>& model, const Doubles& q, const Doubles& p) {
  const std::size_t n = p.size();
  Workspace<Spatial, double> w(model);
  std::vector<Doubles> l(n, Doubles(n));
  poses_outward(w, 0.0, q.data(), false);
  mass_matrix_inward(w, [&](int i, int j, double value) {
    l[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] = value;
  });
  Doubles x(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto less = [&](double from, const Doubles& other, std::size_t count) {
      for (std::size_t k = 0; k < count; ++k) from -= l[i][k] * other[k];
      return from;
    };
    for (std::size_t j = 0; j < i; ++j) l[i][j] = less(l[i][j], l[j], j) / l[j][j];
    const double pivot = less(l[i][i], l[i], i);
    if (!(pivot > 0)) return {};
    l[i][i] = std::sqrt(pivot);
    x[i] = less(p[i], x, i) / l[i][i];
  }
  for (std::size_t i = n; i-- > 0;) {
    x[i] /= l[i][i];
    for (std::size_t k = 0; k < i; ++k) x[k] -= l[i][k] * x[i];
  }
  return x;
}

/// What may be lost by rounding p: δu ≤ ε/2 |M⁻¹| |p| ≤ ε/2 |M⁻¹| |M| |u|, and cond M beside it.
void foresee(ExactChain& exact, const Quads& u, Figures& f) {
  const std::size_t n = u.size();
  Quads sum(n), inverse_sum(n), grown(n), lost(n), unit(n);
  const auto add_columns = [&](auto&& column_of, const Quads& x, Quads& rows, Quads& product) {
    for (std::size_t j = 0; j < n; ++j) {
      unit[j] = 1;
      const Quads column = column_of(unit);
      unit[j] = 0;
      for (std::size_t i = 0; i < n; ++i) {
        rows[i] += abs(column[i]);
        product[i] += abs(column[i]) * abs(x[j]);
      }
    }
  };
  add_columns([&](const Quads& x) { return exact.momenta(x); }, u, sum, grown);
  add_columns([&](const Quads& x) { return exact.velocities(x); }, grown, inverse_sum, lost);
  f[condition] = value_of(largest(sum) * largest(inverse_sum));
  f[bound] = std::numeric_limits<double>::epsilon() / 2 * value_of(largest(lost) / largest(u));
}

Figures measure(const Case& c, unsigned seed) {
  const Scene scene = c.scene(seed);
  const Tree tree = build_tree(scene);
  const Model<Spatial> model = build_spatial_model(tree, scene);
  const LinkTree links = build_links(model);
  State s = random_state(c, seed);
  const std::size_t n = s.q.size();
  const Quads u = quads(s.u);

  ExactChain exact(model);
  exact.place(quads(s.q));
  Doubles p;
  for (const Quad& value : exact.momenta(u)) p.push_back(value_of(value));
  const Quads rates = exact.velocities(quads(p));

  Doubles u_found(n), pdot_found(n), udot_found(n);
  const Doubles no_force(n);
  MomentumSweeps<Spatial, double> momentum(links);
  AccelerationSweeps<Spatial, double> acceleration(links);
  if (!momentum(0.0, s.q.data(), p.data(), u_found.data(), pdot_found.data()) ||
      !acceleration(0.0, s.q.data(), s.u.data(), no_force.data(), udot_found.data()))
    throw std::runtime_error(c.name + ": a joint has no inertia");

  Figures f;
  f.fill(nothing);
  f[p_rounded] = error(rates, u);
  f[qdot] = error(u_found, rates);
  f[qdot_energy] =
      std::sqrt(value_of(exact.kinetic(difference(u_found, rates)) / exact.kinetic(rates)));
  f[pdot] = error(pdot_found, exact.momentum_rates(rates));
  f[qddot] = error(udot_found, exact.accelerations(u));
  if (n <= 1000) {
    const Doubles dense = by_cholesky(model, s.q, p);
    if (!dense.empty()) f[qdot_dense] = error(dense, rates);
  }
  const Doubles with_p = joined(s.q, p), with_u = joined(s.q, s.u);
  if (n <= 100) {
    foresee(exact, u, f);
    f[rate_p] = fastest_rate<MotionOfMomenta>(links, with_p);
    f[rate_u] = fastest_rate<MotionOfVelocities>(links, with_u);
  }
  if (c.steps > 0) {
    f[path_p] = path_error(angles_after_1_s<MotionOfMomenta, double>(links, c.steps, with_p),
                           angles_after_1_s<MotionOfMomenta, Quad>(links, c.steps, with_p));
    f[path_u] = path_error(angles_after_1_s<MotionOfVelocities, double>(links, c.steps, with_u),
                           angles_after_1_s<MotionOfVelocities, Quad>(links, c.steps, with_u));
  }
  return f;
}

struct Spread {
  double median = nothing, worst = nothing;
};
/// Over all states; nothing unless every state has its figure.
Spread spread_of(std::vector<Figures> all, std::size_t column) {
  Doubles x;
  for (const Figures& f : all) x.push_back(f[column]);
  for (const double value : x)
    if (std::isnan(value)) return {};
  std::sort(x.begin(), x.end());
  return {x[x.size() / 2], x.back()};
}

void print(const Case& c, const std::array<Spread, column_count>& row) {
  std::printf("| %s | %d | %s |", c.name.c_str(), c.n,
              c.steps ? std::to_string(c.steps).c_str() : "–");
  for (const Spread& s : row)
    if (!std::isnan(s.worst))
      std::printf(" %.0e / %.0e |", s.median, s.worst);
    else
      std::printf(" – |");
  std::printf("\n");
  std::fflush(stdout);
}

void write(std::ostream& out, const Case& c, const std::array<Spread, column_count>& row) {
  const auto number = [&](double x) -> std::ostream& {
    return std::isfinite(x) ? out << x : out << "null";
  };
  out << "  {\"case\": \"" << c.name << "\", \"n\": " << c.n << ", \"steps\": " << c.steps;
  for (std::size_t i = 0; i < column_count; ++i) {
    out << ", \"" << columns[i].key << "\": {\"median\": ";
    number(row[i].median) << ", \"worst\": ";
    number(row[i].worst) << "}";
  }
  out << "}";
}

int run(std::ostream* json) {
  constexpr unsigned states = 5;
  for (const Column& column : columns) std::printf("%-18s%s\n", column.title, column.meaning);
  std::printf("\nMedian / worst of %u states.\n\n| case | n | steps |", states);
  for (const Column& column : columns) std::printf(" %s |", column.title);
  std::printf("\n|---|---|---|");
  for (std::size_t i = 0; i < column_count; ++i) std::printf("---|");
  std::printf("\n");
  const char* before = "[\n";
  for (const Case& c : cases()) {
    std::vector<Figures> all;
    for (unsigned seed = 1; seed <= states; ++seed) all.push_back(measure(c, seed));
    std::array<Spread, column_count> row;
    for (std::size_t i = 0; i < column_count; ++i) row[i] = spread_of(all, i);
    print(c, row);
    if (!json) continue;
    *json << before;
    write(*json, c, row);
    before = ",\n";
  }
  if (json) *json << "\n]\n";
  return 0;
}

}  // namespace
}  // namespace momenta::stability

int main(int argc, char** argv) {
  const bool with_json = argc == 3 && std::string(argv[1]) == "--json";
  if (argc != 1 && !with_json) {
    std::cerr << "usage: momenta_stability [--json FILE]\n";
    return 2;
  }
  try {
    if (!with_json) return momenta::stability::run(nullptr);
    std::ofstream file(argv[2]);
    const int status = momenta::stability::run(&file);
    if (file.flush()) return status;
    std::cerr << "cannot write " << argv[2] << "\n";
  } catch (const std::exception& e) {
    std::cerr << e.what() << "\n";
  }
  return 1;
}
