#pragma once
// A system of index 2 for half-explicit methods,
//
//   y' = f(t, y, z),  0 = g(t, y),
//
// y without z. A mixin of the forms that are one.

#include <momenta/dae/solver/gauge_symmetry.h>
#include <momenta/dae/solver/integration.h>
#include <momenta/dae/solver/weighted_norm.h>

#include <algorithm>
#include <limits>
#include <string>

namespace momenta {

class HalfExplicit {
 public:
  virtual ~HalfExplicit() = default;
  virtual int differential_unknowns() const = 0;  ///< size of y
  virtual int multipliers() const = 0;            ///< size of z

  /// Finds z from the hidden constraint d/dt g(t, y) = 0, and f(t, y, z).
  virtual bool consistent(double t, const double* y, double* z, double* f) = 0;
  /// Finds z and f(t, y, z) such that g(t_next, base + w f) = 0, w > 0 or < 0. `z` holds that of
  /// the stage before, `f` a prediction, off by O(h^r), r ≥ 1. g is met to rounding, or, not
  /// `exact`, z is off by O(h^min(2r + 1, r + 3)).
  virtual bool advance(double t, const double* y, double t_next, const double* base, double w,
                       bool exact, double* z, double* f) = 0;
  /// Takes y onto g(t, y) = 0, to rounding, from near it: by the change of q or of v that is least
  /// in the mass metric. Equations that depend on others there count for nothing.
  virtual bool meet(double t, double* y) = 0;
  /// Scales quaternions of y to unit length.
  virtual void normalise(double* y) = 0;
  /// A clause naming equations 0 = g that depend on others at (t, y), or nearly so, where stages
  /// have no solution, or many; empty: none.
  virtual std::string dependent(double t, const double* y) = 0;
  /// Weakest pivot of the equations of the last consistent() that count, relative to its size
  /// without the others, and the number that depend on others.
  struct Pivots {
    double weakest = 1;
    int faded = 0;
  };
  virtual Pivots pivots() const = 0;
  virtual const std::string& half_explicit_failure() const = 0;
};

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
