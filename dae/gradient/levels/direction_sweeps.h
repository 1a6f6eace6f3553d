#pragma once
// Evaluations at stages of a run with tangents, of several directions in the lanes of registers:
// direction k of number i stands at [i · width + k]. Compiled for several x86-64 levels. No call
// allocates; one object serves one thread.

#include <momenta/core/kernel/link.h>
#include <momenta/core/kernel/planar_joint.h>
#include <momenta/dae/kkt/sweeps/levels/loop_sweeps.h>

#include <memory>

namespace momenta {

/// Derivatives of (q, p, t) → (u, σ, ṗ), eqs. (7)-(8), along several directions (δq, δp).
class DirectionSweeps {
 public:
  struct Result {
    double *du, *dpdot;  ///< nv × width
    double* dsigma;      ///< m × width, by rows as they are swept
  };
  virtual ~DirectionSweeps() = default;
  virtual int width() const = 0;
  /// κ of (8) and β of (7) [1/s], zero until then.
  virtual void feed_back(double leak, double beta) = 0;
  /// Evaluates at (t, q, p) along dq, dp (nv × width). `besides`: added to the second row (m ×
  /// width), by rows as they are swept; null: zero. False where a joint has no inertia or a branch
  /// is weak. O(bodies + m)
  virtual bool operator()(double t, const double* q, const double* p, const double* dq,
                          const double* dp, const double* besides, const Result& result) = 0;
};

/// Derivatives of the rows of (7), (8) by numbers of a mechanism's tables, at constant q, u, σ.
/// Without places these are numbers of inertias, gravity, joints and springs: r1 = M u + Φ_qᵀσ and
/// r3 = ṗ are linear in them, and Φ̇ has none of them.
class NumberRows {
 public:
  virtual ~NumberRows() = default;
  virtual int width() const = 0;
  /// κ of (8) and β of (7) [1/s], zero until then.
  virtual void feed_back(double leak, double beta) = 0;
  /// Takes directions dn, numbers × width, in the order of NumberPlaces (tangent_sweeps.h); returns
  /// their index. O(numbers)
  virtual std::size_t take(const double* dn) = 0;
  /// Goes to (t, q, u, σ), which stay where they are; σ null: zero. O(bodies)
  virtual void place(double t, const double* q, const double* u, const double* sigma) = 0;
  /// r1, r2 and r3 (nv, m and nv, × width) of these directions; r2 only with places. O(bodies + m)
  virtual void rows(std::size_t place, double* r1, double* r2, double* r3) = 0;
};

/// Sweeps at best_level(); the arguments stay where they are. `fade`: share of its scale below
/// which a pivot fades. Null where the fronts of one direction fill the registers by themselves.
/// @pre swept.plan.fits()
template <class Tree, class Space>
std::unique_ptr<DirectionSweeps> make_direction_sweeps(const Tree& tree,
                                                       const SweptLoops<Space>& swept, double fade,
                                                       bool body_forces);
/// Rows with places if `loops` is not null, in the model's frames; `count`: loops that have
/// numbers.
template <class Space>
std::unique_ptr<NumberRows> make_number_rows(const Model<Space>& model, std::size_t count,
                                             const LoopModel<Space>* loops);

}  // namespace momenta
