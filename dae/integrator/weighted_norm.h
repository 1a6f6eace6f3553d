#pragma once
// The norm of implicit methods that know the index: RMS over what DaeSystem::weight keeps.

#include <momenta/dae/integrator/system.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace momenta {

/// Weights of the norms: h^power / (atol scale + rtol |y|), or zero.
class WeightedNorm {
 public:
  WeightedNorm(const DaeSystem& system, double rtol, double atol)
      : rtol_(rtol), weight_(static_cast<std::size_t>(system.size())) {
    for (int i = 0; i < system.size(); ++i) {
      const DaeSystem::Weight w = system.weight(i);
      const bool kept = w.power >= 0 && std::isfinite(w.scale);
      power_.push_back(kept ? w.power : -1);
      atol_.push_back(kept ? atol * w.scale : 0);
      kept_ += kept;
    }
  }
  /// Sets weights at a share of the tolerance.
  void set(const double* y, double h, double share = 1) {
    share_ = share;
    for (std::size_t i = 0; i < weight_.size(); ++i)
      weight_[i] = power_[i] < 0 ? 0
                                 : (power_[i] == 0 ? 1 : std::pow(h, power_[i])) /
                                       (share * (atol_[i] + rtol_ * std::abs(y[i])));
  }
  /// Sum of the squares of the weighted values.
  double squares(const double* x) const {
    double sum = 0;
    for (std::size_t i = 0; i < weight_.size(); ++i)
      if (power_[i] >= 0) sum += weight_[i] * x[i] * (weight_[i] * x[i]);
    return sum;
  }
  double of(const double* x) const { return std::sqrt(squares(x) / count()); }
  double count() const { return std::max(kept_, 1); }
  /// Norm that roundings of y may reach.
  double rounding() const {
    return 100 * std::numeric_limits<double>::epsilon() / (share_ * rtol_);
  }

 private:
  double rtol_, share_ = 1;
  std::vector<double> weight_, atol_;
  std::vector<int> power_;
  int kept_ = 0;
};

}  // namespace momenta
