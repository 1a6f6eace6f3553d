#pragma once
// Past of a multistep method: the last values y_{n−1}, y_{n−2}, … with their times, and the
// polynomials ω through them in Lagrange's form.
//
// Values and not differences, so that the gauge of σ can be changed for all of them at once:
// (p_k, σ_k) → (p_k + Φ_q(q_k)ᵀc, σ_k + c) (gauge_symmetry.h). Entries of Φ_q(q_k) are kept beside
// y_k: a shift takes as many products as Φ_q has entries, for each value.

#include <momenta/dae/integrator/gauge_symmetry.h>

#include <array>
#include <vector>

namespace momenta {

class PastValues {
 public:
  static constexpr int most = 8;  ///< values

  /// Values of `size` numbers; `gauge` null where they are not to be shifted.
  PastValues(int size, GaugeSymmetry* gauge);

  /// Keeps only this value.
  void begin(double t, const double* y);
  /// Adds a newest value; the oldest goes where there are `most`.
  void add(double t, const double* y);
  /// Overwrites the value k back, 0 the newest; k ≤ count().
  void put(int k, double t, const double* y);
  int count() const { return count_; }

  double time(int k) const { return at(k).t; }
  const double* value(int k) const { return at(k).y.data(); }

  /// Takes every value into another gauge, by the same c.
  void shift(const double* c);
  /// Takes all values into the gauge in which the newest σ is zero.
  void reset();

  /// ω(t) and, not null, ω'(t) through the `degree` + 1 newest values; degree < count().
  void interpolate(double t, int degree, double* y, double* ydot) const;
  /// y[t, t_{n−1}, …, t_{n−order}] with y the value at t; order ≤ count().
  void difference(double t, const double* y, int order, double* result) const;

 private:
  struct Value {
    double t = 0;
    std::vector<double> y, directions;
  };
  const Value& at(int k) const { return values_[static_cast<std::size_t>((newest_ + k) % most)]; }
  Value& at(int k) { return values_[static_cast<std::size_t>((newest_ + k) % most)]; }

  std::size_t size_;
  GaugeSymmetry* gauge_;
  std::array<Value, most> values_;
  int newest_ = 0, count_ = 0;
  std::vector<double> c_;
};

}  // namespace momenta
