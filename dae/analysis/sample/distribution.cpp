#include <momenta/core/text/number_text.h>
#include <momenta/dae/analysis/sample/distribution.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace momenta {

double normal_quantile(double u) {
  if (u > 0.5) return -normal_quantile(1 - u);
  // Newton's method on ln Φ(x) = ln u. ln Φ is concave and rises, so that a start to the left of
  // the root stays there and comes nearer at each step; Φ(-y) <= exp(-y²/2) / 2 gives such a start.
  double x = -std::sqrt(-2 * std::log(2 * u));
  const double target = std::log(u);
  for (int step = 0; step < 60; ++step) {
    const double below = 0.5 * std::erfc(-x / std::numbers::sqrt2);
    const double density = std::exp(-0.5 * x * x) / std::sqrt(2 * std::numbers::pi);
    const double next = x + (target - std::log(below)) * below / density;
    if (!(next - x > 1e-17 + 1e-16 * std::abs(x))) break;
    x = next;
  }
  return x;
}

double Distribution::quantile(double u) const {
  switch (kind) {
    case Kind::uniform:
      return a + (b - a) * u;
    case Kind::log_uniform:
      return a * std::pow(b / a, u);
    case Kind::normal:
      return a + b * normal_quantile(u);
    case Kind::choice:
      break;
  }
  const auto place = static_cast<std::size_t>(u * static_cast<double>(values.size()));
  return values[std::min(place, values.size() - 1)];
}

const char* Distribution::name() const {
  switch (kind) {
    case Kind::uniform:
      return "uniform";
    case Kind::log_uniform:
      return "log uniform";
    case Kind::normal:
      return "normal";
    case Kind::choice:
      break;
  }
  return "choice";
}

std::string Distribution::words() const {
  if (kind == Kind::normal) return "normal, mean " + compact(a, 6) + ", deviation " + compact(b, 6);
  if (kind == Kind::choice)
    return "choice of " + std::to_string(values.size()) + " value" +
           (values.size() == 1 ? "" : "s");
  return std::string(name()) + ", " + compact(a, 6) + " to " + compact(b, 6);
}

}  // namespace momenta
