#pragma once
// The size of a local error of half-explicit steps: mean square over its tolerance.
//
// By component, y alone, as for ODEs. With impulses σ in p the error of p has a part Φ_qᵀc that
// changes σ and no motion. Where loop equations come near to losing rank that part is the larger
// one: σ of a weak row is what divides by its pivot, and varies over a step as the pivot does. By
// component steps would be as short as σ wants them. There errors are those of the motion,
//
//   (e_q, v),   M v + Φ_qᵀν = e_p,   Φ_q v = 0                     (gauge_symmetry.h)
//
// as in the ODE form (explicit_run.h), from the same distance on. Elsewhere both norms lead to the
// same errors, and that by component takes no solution of (7), and fewer steps
// (docs/theory/work-precision.md).

#include <momenta/dae/integrator/gauge_symmetry.h>
#include <momenta/dae/integrator/half_explicit.h>
#include <momenta/dae/integrator/integration.h>
#include <momenta/dae/integrator/weighted_norm.h>

#include <algorithm>
#include <limits>

namespace momenta {

class HalfExplicitError {
 public:
  /// `gauge` null: none.
  HalfExplicitError(const DaeSystem& system, const HalfExplicit& parts, GaugeSymmetry* gauge,
                    const IntegrationOptions& options)
      : parts_(parts),
        gauge_(gauge != nullptr && gauge->impulse_count() > 0 ? gauge : nullptr),
        options_(options),
        norm_(system, options.rtol, options.atol) {}

  /// Prepares for the error of a step of length h from (t, y, y'), at whose end z was found last.
  void at(double t, const double* y, const double* ydot, double h) {
    end_ = weakest();
    by_motion_ = gauge_ != nullptr && std::min(start_, end_) < approaching * strongest_;
    if (by_motion_)
      gauge_->measure_at(t, y, ydot, options_.rtol, options_.atol);
    else
      norm_.set(y, h);
  }
  double operator()(const double* e) const {
    return by_motion_ ? gauge_->motion_squares(e) : norm_.squares(e) / norm_.count();
  }
  bool by_motion() const { return by_motion_; }

  void accept() {
    start_ = end_;
    strongest_ = std::max(strongest_, end_);
  }
  /// Restarts elsewhere, where a pivot is still weak.
  void restart() { start_ = 0; }

 private:
  static constexpr double approaching = 0.2;  ///< part of the best weakest pivot

  double weakest() {
    const HalfExplicit::Pivots last = parts_.pivots();
    always_faded_ = std::min(always_faded_, last.faded);
    return last.faded > always_faded_ ? 0 : last.weakest;
  }

  const HalfExplicit& parts_;
  GaugeSymmetry* gauge_;
  const IntegrationOptions& options_;
  WeightedNorm norm_;
  bool by_motion_ = false;
  double start_ = 1, end_ = 1;  ///< weakest pivot at the ends of the step
  double strongest_ = 0;        ///< largest weakest pivot so far
  int always_faded_ = std::numeric_limits<int>::max();
};

}  // namespace momenta
