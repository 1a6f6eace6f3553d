#pragma once
// Position and velocity drift at a state: |Φ|₂ and |Φ̇|₂, of rows in m and of rows in rad apart.

#include <momenta/dae/mechanism/mechanism.h>

#include <cmath>

namespace momenta {

struct Drift {
  double lengths = 0, angles = 0;
  bool finite() const { return std::isfinite(lengths) && std::isfinite(angles); }
  /// The drift of a mechanism: of lengths if it has any, else of angles.
  double named(const Mechanism& mechanism) const {
    return mechanism.has_lengths() ? lengths : angles;
  }
};
/// Drift of x (m), by rows of Φ. O(m)
inline Drift drift_of(const Mechanism& mechanism, const Eigen::VectorXd& x) {
  if (!mechanism.has_angles()) return {x.norm(), 0};
  if (!mechanism.has_lengths()) return {0, x.norm()};
  Drift sum;
  for (Eigen::Index i = 0; i < x.size(); ++i)
    (mechanism.angle_rows()[static_cast<std::size_t>(i)] ? sum.angles : sum.lengths) += x[i] * x[i];
  return {std::sqrt(sum.lengths), std::sqrt(sum.angles)};
}

}  // namespace momenta
