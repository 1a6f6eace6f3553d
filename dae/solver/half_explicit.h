#pragma once
// What half-explicit methods need of a system of index 2,
//
//   y' = f(t, y, z),  0 = g(t, y),
//
// y without z. A mixin of the forms that are one.

#include <string>

namespace momenta {

class HalfExplicit {
 public:
  virtual ~HalfExplicit() = default;
  virtual int differential_unknowns() const = 0;  ///< of y
  virtual int multipliers() const = 0;            ///< of z

  /// z from the hidden constraint d/dt g(t, y) = 0, and f(t, y, z).
  virtual bool consistent(double t, const double* y, double* z, double* f) = 0;
  /// z and f(t, y, z) such that g(t_next, base + w f) = 0, w > 0 or < 0. `z` holds that of the
  /// stage before, `f` a prediction, off by O(h^r), r ≥ 1. g is met to rounding, or, not `exact`, z
  /// is off by O(h^min(2r + 1, r + 3)).
  virtual bool advance(double t, const double* y, double t_next, const double* base, double w,
                       bool exact, double* z, double* f) = 0;
  /// y onto g(t, y) = 0, to rounding, from near it: by the change of q or of v that is least in the
  /// mass metric. Equations that depend on others there count for nothing.
  virtual bool meet(double t, double* y) = 0;
  /// Quaternions of y back to unit length.
  virtual void normalise(double* y) = 0;
  /// Which equations 0 = g depend on others at (t, y), or nearly so, as a clause; empty: none.
  /// There stages have no solution, or many.
  virtual std::string dependent(double t, const double* y) = 0;
  /// Of the equations of the last consistent(): the weakest pivot of those that count, relative to
  /// what it would be without the others, and how many depend on others and count for nothing.
  struct Pivots {
    double weakest = 1;
    int faded = 0;
  };
  virtual Pivots pivots() const = 0;
  /// Why one of them failed.
  virtual const std::string& half_explicit_failure() const = 0;
};

}  // namespace momenta
