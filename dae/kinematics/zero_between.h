#pragma once
// A zero of a function between two places of other signs.

#include <algorithm>
#include <cmath>
#include <functional>

namespace momenta {

/// Where f changes its sign between a and b, by the Illinois rule; NaN where f fails.
inline double zero_between(const std::function<double(double)>& f, double a, double fa, double b,
                           double fb) {
  constexpr int most = 60;
  for (int k = 0; k < most && std::abs(b - a) > 1e-15 * (std::abs(a) + std::abs(b)); ++k) {
    double c = b - fb * (b - a) / (fb - fa);
    if (!(c > std::min(a, b) && c < std::max(a, b))) c = 0.5 * (a + b);
    const double fc = f(c);
    if (!std::isfinite(fc)) return fc;
    if (fc == 0) return c;
    if ((fc < 0) != (fb < 0)) {
      a = b;
      fa = fb;
    } else {
      fa *= 0.5;
    }
    b = c;
    fb = fc;
  }
  return b;
}

}  // namespace momenta
