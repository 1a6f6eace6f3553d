#pragma once
// Cholesky factors of matrices of two to six rows, their size known to the compiler: plain loops
// that it unrolls.

#include <momenta/core/kernel/planar.h>
#include <momenta/core/kernel/spatial.h>

#include <cmath>

namespace momenta::small {

/// a = L Lᵀ from its lower triangle, in place, with 1/L_ii on the diagonal. False where a pivot is
/// not above `least` times its diagonal entry.
template <int n>
bool cholesky(double (&a)[n][n], double least) {
  for (int j = 0; j < n; ++j) {
    double pivot = a[j][j];
    const double bound = least * pivot;
    for (int k = 0; k < j; ++k) pivot -= a[j][k] * a[j][k];
    if (!(pivot > bound) || !(pivot < HUGE_VAL)) return false;
    const double inverse = 1 / std::sqrt(pivot);
    a[j][j] = inverse;
    for (int i = j + 1; i < n; ++i) {
      double sum = a[i][j];
      for (int k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
      a[i][j] = sum * inverse;
    }
  }
  return true;
}

/// x ← L⁻¹ x
template <int n>
void forward(const double (&l)[n][n], double* x) {
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < i; ++k) x[i] -= l[i][k] * x[k];
    x[i] *= l[i][i];
  }
}
/// The same for m columns, row by row.
template <int n, int m>
void forward(const double (&l)[n][n], double (*x)[m]) {
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < i; ++k)
      for (int j = 0; j < m; ++j) x[i][j] -= l[i][k] * x[k][j];
    for (int j = 0; j < m; ++j) x[i][j] *= l[i][i];
  }
}
/// x ← L⁻ᵀ x
template <int n>
void backward(const double (&l)[n][n], double* x) {
  for (int i = n; i-- > 0;) {
    x[i] *= l[i][i];
    for (int k = 0; k < i; ++k) x[k] -= l[i][k] * x[i];
  }
}

}  // namespace momenta::small

// Articulated inertias of both algebras as full matrices, 6 × 6 and 3 × 3, and back.

namespace momenta {

inline void expand(const Planar::ArticulatedInertia<double>& m, double (&all)[3][3]) {
  all[0][0] = m.xx, all[0][1] = m.xy, all[0][2] = m.H[0];
  all[1][0] = m.xy, all[1][1] = m.yy, all[1][2] = m.H[1];
  all[2][0] = m.H[0], all[2][1] = m.H[1], all[2][2] = m.I;
}
inline void expand(const Spatial::ArticulatedInertia<double>& m, double (&all)[6][6]) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      all[i][j] = m.A(i, j);
      all[3 + i][3 + j] = m.I(i, j);
      all[i][3 + j] = all[3 + j][i] = m.H(i, j);
    }
}

/// From a symmetric matrix.
template <class Inertia>
Inertia compress(const double (&all)[3][3]) {
  return {all[0][0], all[0][1], all[1][1], {{all[0][2], all[1][2]}}, all[2][2]};
}
template <class Inertia>
Inertia compress(const double (&all)[6][6]) {
  Inertia m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      if (i <= j) m.A(i, j) = all[i][j];
      if (i <= j) m.I(i, j) = all[3 + i][3 + j];
      m.H(i, j) = all[i][3 + j];
    }
  return m;
}

}  // namespace momenta
