#pragma once
// The sparse matrix of residuals that were evaluated in LocalDual,
//
//   ( A  B ) ( dy )   ( dr )
//   ( C  T ) ( dz ) = (  0 ),     ∂r/∂y = A − B T⁻¹ C,
//
// and the pattern of ∂r/∂y itself, which follows from it: row i has an entry for every y that it
// reaches, directly or through rows of z.

#include <momenta/core/scalar/local_dual.h>
#include <momenta/dae/integrator/system.h>

#include <vector>

namespace momenta {

class LocalRows {
 public:
  /// Takes the residuals r (n) and the cuts of their evaluation. O(entries); allocates where the
  /// pattern changes.
  void take(const std::vector<LocalDual>& r, const Cuts& cuts);

  int size() const { return size_; }  ///< n + cuts
  const JacobianPattern& pattern() const { return pattern_; }
  const std::vector<double>& values() const { return values_; }
  /// Number of patterns so far.
  int version() const { return version_; }

  /// Pattern of ∂r/∂y, n × n. O(its entries, times the length of the ways)
  JacobianPattern eliminated(int n) const;

 private:
  void analyse();

  int size_ = 0, version_ = 0;
  std::vector<std::size_t> end_, end_before_;  ///< ends of each row's terms
  std::vector<int> at_, at_before_;
  std::vector<double> term_;
  std::vector<std::size_t> place_;     ///< places of terms in values_
  std::vector<std::size_t> diagonal_;  ///< places of the 1 in each row of z
  JacobianPattern pattern_;
  std::vector<double> values_;
};

/// Groups of columns that share no row, column by column into the first group that fits: each
/// group is one direction (Curtis, Powell, Reid 1974). O(Σ over rows of their entries²)
std::vector<std::vector<int>> apart_columns(const JacobianPattern& pattern);

}  // namespace momenta
