#pragma once
// The norm of implicit methods that know the index: RMS over what DaeSystem::weight keeps.

#include <momenta/dae/solver/sundials_handles.h>
#include <momenta/dae/solver/system.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
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

// Newton's method of IDA with a floor of rounding for its corrections.
//
// A correction is J⁻¹ F, and F comes with roundings: of y and y' as they are stored and of its own
// operations. J⁻¹ may carry them far: with Φ(q) = 0 among the rows, an opening of ε |q| is answered
// by an impulse of ε |q| over the step, and that by a change of p that no shorter step lessens. IDA
// asks of corrections that each is smaller than the one before; at the floor none is, and a step
// that is solved as well as it can be is taken for one that does not converge.
//
// So where IDA's test gives up, the floor is measured: every number of y and y' moved by one
// rounding, up or down by chance, what F changes by, through the factors at hand,
//
//   δ = J⁻¹ [F(t, y + ρ, y' + ρ') − F(t, y, y')],
//
// root mean square of three samples in IDA's norm. The iteration is at its end when its correction
// is no more than a few δ, and if that is still well within the tolerance the step is as good as
// any.
//
// Source: Higham, Accuracy and Stability of Numerical Algorithms, ch. 25, for the limiting accuracy
// of Newton's method.

class RoundingFloor {
 public:
  /// r = F(t, y, y'); false: no value.
  using Residual = std::function<bool(double t, const double* y, const double* ydot, double* r)>;

  RoundingFloor(int size, const sundials::Context& context, Residual residual);
  RoundingFloor(const RoundingFloor&) = delete;
  RoundingFloor& operator=(const RoundingFloor&) = delete;

  /// To be called before the first step; the solver and its matrix are IDA's.
  void attach(void* ida, SUNLinearSolver solver, SUNMatrix matrix);

  /// The floor in tolerances, where the last trial of a step did not converge because of it; else
  /// 0.
  double reached() const { return reached_; }
  void forget() { reached_ = 0; }
  /// ‖δ‖ at IDA's last y and y', with its weights and last factors; not finite where F has no
  /// value. Four evaluations of F.
  double here();
  long evaluations() const { return evaluations_; }

 private:
  static int test(SUNNonlinearSolver newton, N_Vector sum, N_Vector correction, double bound,
                  N_Vector weight, void* self);
  double measure(N_Vector weight);

  Residual residual_;
  void* ida_ = nullptr;
  SUNLinearSolver solver_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNNonlinSolConvTestFn own_test_ = nullptr;  ///< IDA's
  void* own_data_ = nullptr;
  sundials::NonlinearSolver newton_;
  sundials::Vector y_, ydot_, r_, moved_, delta_, weight_;
  std::minstd_rand chance_;
  double reached_ = 0;
  long evaluations_ = 0;
};

}  // namespace momenta
