#pragma once
// How large rows that tie axes are by nature. Where all hinges of a loop are parallel, the
// equations for its axes vanish to rounding in every entry: they are redundant, not weak, and what
// is left of them is no scale for anything.

#include <momenta/dae/mechanism.h>

#include <vector>

namespace momenta {

class AxisScale {
 public:
  explicit AxisScale(const Mechanism& mechanism);

  /// Per row (m): Σ_j 1/M_jj over the rotations that an axis row hangs on, whose entries are at
  /// most 1: its W_ii when the axes are anyhow; 0 for rows of points and distances. `mass`: values
  /// of M in the order of the KKT pattern.
  void measure(const std::vector<double>& mass, std::vector<double>& scale) const;

 private:
  struct Hanging {
    std::size_t row, mass;  ///< row of Φ, place of M_jj among the values
  };
  std::vector<Hanging> hanging_;
};

}  // namespace momenta
