#pragma once
// A system of index 2 for half-explicit methods,
//
//   y' = f(t, y, z),  0 = g(t, y),
//
// y without z. A mixin of the forms that are one.

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

}  // namespace momenta
