#pragma once
// One number for the error of a run, as collections of benchmark problems define it. Over the
// outputs i = 1 … m after the start and the judged columns j = 1 … n, with the reference r:
//
//   threshold  E = √( 1/(m n) Σ_i Σ_j ( |y_ij − r_ij| / max(|r_ij|, s) )² )
//   mixed      E = max_ij |y_ij − r_ij| / (1 + |r_ij|)
//
// The first, with a threshold s for values near zero, is that of González, Dopico, Lugrís and
// Cuadrado, A benchmarking system for MBS simulation software, Multibody Syst. Dyn. 16 (2006), the
// source of the benchmark problems of the IFToMM Technical Committee for Multibody Dynamics;
// momenta's other studies use the second.

#include <algorithm>
#include <cmath>
#include <limits>

namespace momenta {

class BenchmarkError {
 public:
  enum class Kind { threshold, mixed };

  /// @pre threshold > 0
  BenchmarkError(Kind kind, double threshold) : kind_(kind), threshold_(threshold) {}

  void add(double value, double reference) {
    const double difference = std::abs(value - reference), size = std::abs(reference);
    ++count_;
    if (kind_ == Kind::threshold) {
      const double e = difference / std::max(size, threshold_);
      collected_ += e * e;
    } else {
      const double e = difference / (1 + size);
      if (!std::isnan(collected_) && !(e <= collected_)) collected_ = e;  // NaN stays
    }
  }

  /// NaN where nothing was added.
  double value() const {
    if (count_ == 0) return std::numeric_limits<double>::quiet_NaN();
    return kind_ == Kind::threshold ? std::sqrt(collected_ / static_cast<double>(count_))
                                    : collected_;
  }

 private:
  Kind kind_;
  double threshold_;  ///< s, in the unit of the values
  double collected_ = 0;
  long count_ = 0;
};

}  // namespace momenta
