#pragma once
// Gauge symmetry of a form with impulse multipliers σ, by which a method keeps them small. For
// constant c
//
//   (p, σ) → (p + Φ_qᵀ(q) c, σ + c)
//
// maps solutions to solutions with the same q(t), so all values y_k that a method remembers may be
// shifted by one c, each with Φ_q at its own q_k. A mixin of forms that are a DaeSystem.

namespace momenta {

class GaugeSymmetry {
 public:
  virtual ~GaugeSymmetry() = default;

  /// Whether σ is to be shifted to zero before each step (gauge reset); there must be no leak then,
  /// which is no symmetry.
  virtual bool resets() const = 0;
  virtual int impulse_count() const = 0;  ///< size of σ and c
  /// σ in y.
  virtual const double* impulses(const double* y) const = 0;

  /// Number of values that gauge_directions() writes.
  virtual int direction_entries() const = 0;
  /// The entries of Φ_q at (t, q), q from y, for shift().
  virtual void gauge_directions(double t, const double* y, double* entries) = 0;
  /// p += Φ_qᵀc, σ += c in y; `entries` are those of its q.
  virtual void shift(const double* entries, const double* c, double* y) const = 0;
  /// The shift c = −σ of y and, by Φ̇_qᵀc, of y', which are consistent: y' is then that of (8).
  virtual void reset(double t, double* y, double* ydot) = 0;

  /// Sets the norm of motion_squares(): at (t, y, y'), weights 1/(atol scale + rtol size).
  virtual void measure_at(double t, const double* y, const double* ydot, double rtol,
                          double atol) = 0;
  /// Mean square of e_q, by the same weights. O(n).
  virtual double coordinate_squares(const double* e) = 0;
  /// Mean square, over q and u, of the change of motion by a change e of y: (e_q, v) with M v +
  /// Φ_qᵀν = e_p, Φ_q v = 0. (0, Φ_qᵀc) counts nothing. Not finite where it cannot be computed. One
  /// solution of (7).
  virtual double motion_squares(const double* e) = 0;
};

}  // namespace momenta
