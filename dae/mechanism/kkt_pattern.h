#pragma once
#include <vector>

namespace momenta {

/// Nonzeros of the two blocks of (7): M (upper triangle) and Φ_q, in the order in which an
/// evaluation writes them.
struct KktPattern {
  /// A nonzero.
  struct Entry {
    int row;     ///< from 0
    int column;  ///< from 0
  };
  std::vector<Entry> mass;        ///< row ≤ column < nv
  std::vector<Entry> constraint;  ///< row < m, column < nv
};

}  // namespace momenta
