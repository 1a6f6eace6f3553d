#pragma once
// A sparse symmetric matrix on a fixed pattern, both triangles by columns, as the libraries take
// it.

#include <momenta/dae/mechanism/mechanism.h>

#include <array>
#include <vector>

namespace momenta {

class SymmetricMatrix {
 public:
  /// `entries`: one of each pair (i, j), (j, i); places on the diagonal that are not among them are
  /// added, zero.
  SymmetricMatrix(int size, const std::vector<KktPattern::Entry>& entries);

  int size() const { return static_cast<int>(diagonal_.size()); }
  /// Sets the given entry `i`.
  void set(std::size_t i, double x) { value_[place_[i][0]] = value_[place_[i][1]] = x; }
  void set_diagonal(int i, double x) { value_[diagonal_[static_cast<std::size_t>(i)]] = x; }
  bool finite() const;

  /// r = b − A x (size); returns its largest entry relative to Σ|A||x| + |b| of its row, infinite
  /// where it is not finite. Where that is itself rounding of the largest of x, as in a body that
  /// stands still, the largest entry of the row times that counts too.
  /// Source: Arioli, Demmel, Duff, SIAM J. Matrix Anal. Appl. 10 (1989) 165.
  double residual(const double* b, const double* x, double* r);
  /// Σ|A||x| + |b| of a row at the last residual().
  double row_size(std::size_t i) const { return scale_[i]; }

  // By columns, rows ascending.
  std::vector<int> start, row;
  const std::vector<double>& values() const { return value_; }

 private:
  std::vector<double> value_, scale_, largest_;  ///< largest_: entry of a row
  std::vector<std::array<std::size_t, 2>> place_;
  std::vector<std::size_t> diagonal_;
};

}  // namespace momenta
