#pragma once
// Articulated inertias of both algebras as full matrices, 6 × 6 and 3 × 3, and back.

#include <momenta/core/kernel/planar.h>
#include <momenta/core/kernel/spatial.h>

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
