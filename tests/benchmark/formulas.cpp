// A formula's tape against the same formula written in C++ by hand: nanoseconds of one evaluation,
// in doubles, with all its slopes, and at eight points side by side. Least of many rounds, the ways
// by turns; both are called through a pointer, at points that change.

#include <momenta/core/expression/evaluate.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>

#include "formulas_by_hand.h"
#include "formulas_in_packs.h"

namespace {

using namespace momenta;
using by_hand::Traced;

constexpr int points = 64;

/// Least nanoseconds of one call of each, by turns.
std::vector<double> least(const std::vector<std::function<void()>>& ways, double per_call) {
  std::vector<double> best(ways.size(), 1e300);
  for (int round = 0; round < 60; ++round)
    for (std::size_t w = 0; w < ways.size(); ++w) {
      constexpr int repeats = 40;
      const auto from = std::chrono::steady_clock::now();
      for (int i = 0; i < repeats; ++i) ways[w]();
      const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - from;
      best[w] = std::min(best[w], took.count() / (repeats * per_call));
    }
  return best;
}

void keep(const double* x) {
  asm volatile("" : : "r"(x) : "memory");
}

}  // namespace

int main() {
  const std::vector<by_hand::Typed> typed = by_hand::all();
  const auto written = Traced<double, by_hand::InDoubles>::all();
  const auto gradients = by_hand::gradients();
  std::printf(
      "| formula | instructions | tape [ns] | C++ [ns] | ratio | with slopes, tape | C++ | ratio | "
      "eight points, tape | C++ | ratio |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (std::size_t k = 0; k < typed.size(); ++k) {
    const by_hand::Typed& f = typed[k];
    const std::size_t n = f.variables.size();
    std::vector<double> x;
    for (int p = 0; p < points; ++p)
      for (const double at : f.at) x.push_back(at * (1 + 1e-3 * p));
    const Expression formula(f.text, f.variables);
    std::vector<int> variables;
    for (std::size_t i = 0; i < n; ++i) variables.push_back(static_cast<int>(i));
    const Expression slopes = formula.with_derivatives(variables);
    std::vector<double> line(slopes.tape().size()), values(n + 1);
    const auto over_points = [&](auto&& act) {
      return [&, act] {
        for (std::size_t p = 0; p < points; ++p) act(x.data() + p * n);
        keep(values.data());
      };
    };
    const double told = formula(f.at), ours = written[k](f.at.data());
    if (!(std::abs(told - ours) <= 1e-13 * (1 + std::abs(ours)))) {
      std::printf("%s differs: %.17g, by hand %.17g\n", f.name, told, ours);
      return EXIT_FAILURE;
    }
    std::vector<std::function<void()>> ways{
        over_points([&](const double* at) {
          evaluate(formula, at, line.data(), values.data());
          keep(values.data());
        }),
        over_points([&, function = written[k]](const double* at) {
          values[0] = function(at);
          keep(values.data());
        })};
    if (gradients[k]) {
      ways.push_back(over_points([&](const double* at) {
        evaluate(slopes, at, line.data(), values.data());
        keep(values.data());
      }));
      ways.push_back(over_points([&, function = gradients[k]](const double* at) {
        function(at, values.data());
        keep(values.data());
      }));
    }
    const std::vector<double> t = least(ways, points);
    std::printf("| %-15s | %3zu | %6.1f | %6.1f | %4.2f |", f.name, formula.tape().size(), t[0],
                t[1], t[0] / t[1]);
    if (gradients[k])
      std::printf(" %6.1f | %6.1f | %4.2f |", t[2], t[3], t[2] / t[3]);
    else
      std::printf(" | | |");
    const by_hand::InPacks packs(k, formula, x);
    const std::vector<double> wide =
        least({[&] { packs.tape(); }, [&] { packs.hand(); }}, packs.points());
    std::printf(" %6.2f | %6.2f | %4.2f |\n", wide[0], wide[1], wide[0] / wide[1]);
  }
}
