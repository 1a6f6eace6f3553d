#pragma once
// Lagrange's polynomials ℓ_k of points x_0 … x_{n−1}, ℓ_k(x_j) = δ_kj, by their factors, and their
// derivatives by the product rule. O(n) each. Source: Berrut, Trefethen, SIAM Rev. 46 (2004) 501.

namespace momenta {

struct LagrangeBasis {
  double value = 1;  ///< ℓ_k(x)
  double slope = 0;  ///< ℓ_k'(x)
};

/// `point(j)`: x_j, 0 ≤ j < n, no two the same.
template <class Point>
LagrangeBasis lagrange_basis(int n, int k, double x, Point&& point) {
  LagrangeBasis l;
  for (int j = 0; j < n; ++j) {
    if (j == k) continue;
    const double over = 1 / (point(k) - point(j)), factor = (x - point(j)) * over;
    l.slope = l.slope * factor + l.value * over;
    l.value *= factor;
  }
  return l;
}

}  // namespace momenta
