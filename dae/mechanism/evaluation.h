#pragma once
// Everything that a form needs from a mechanism at one state, computed by sweeps; M and Φ_q are
// assembled only by the calls that return their entries. S is double, or a dual number for exact
// derivatives. Call place() first, then move(), then the rest: each call uses what the ones before
// left in the workspace. One object serves one thread; no call allocates.

#include <momenta/core/scalar/dual.h>

#include <memory>
#include <string>

namespace momenta {

/// The equations of motion and of the loops, row by row, for every scalar S.
template <class S>
class EquationRows {
 public:
  virtual ~EquationRows() = default;

  /// Sets the configuration q (nq) at time t.
  virtual void place(double t, const S* q) = 0;
  /// Φ (m), eq. (1b).
  virtual void positions(S* phi) = 0;

  /// Sets the rates u (nv), and so all velocities. Null: zero rates, with prescribed motion alone.
  virtual void move(const S* u) = 0;
  /// Φ̇ = Φ_q u + Φ_t (m).
  virtual void velocities(S* rate) = 0;
  /// M u + Φ_qᵀσ + prescribed part (nv): row 1 of (7). `sigma` (m) null: zero.
  virtual void momenta(const S* sigma, S* p) = 0;
  /// ṗ (nv), eq. (8), with the leak −κ Φ_qᵀσ. After momenta(sigma, …).
  virtual void momentum_rates(const S* q, const S* u, const S* sigma, double leak, S* pdot) = 0;

  /// M u̇ + bias − Q + Φ_qᵀλ (nv): the residual of (1a). `udot`, `lambda` null: zero. After
  /// move(u).
  virtual void joint_forces(const S* q, const S* u, const S* udot, const S* lambda, S* tau) = 0;
  /// Φ̈ (m), eq. (2), with the accelerations of the last joint_forces().
  virtual void accelerations(S* rate) = 0;

  /// Adds the friction of bearings under the reactions of the last joint_forces() to its residual
  /// `tau` (nv); bearings.h. `u` as in move().
  virtual void bearing_friction(const S* /*u*/, S* /*tau*/) {}

  /// Φ_qᵀ x (nv).
  virtual void constraint_forces(const S* x, S* result) = 0;

  /// q̇ (nq) from u. After place().
  virtual void coordinate_rates(const S* q, const S* u, S* qdot) const = 0;
  /// u (nv) from q̇; quaternions in q have unit length.
  virtual void joint_rates(const S* q, const S* qdot, S* u) const = 0;

  /// Generalised forces (nv) at (t, q, u), weights excluded: those of the joints and, unless
  /// `at_points` is false, those of springs, dampers and wrenches at points of bodies. Needs
  /// neither place() nor move(), and overwrites what they left.
  virtual void applied_forces(double t, const S* q, const S* u, S* tau, bool at_points = true) = 0;
};

/// The evaluation at one state. Scalars other than double have the equations alone.
template <class S>
class Evaluation : public EquationRows<S> {};

/// In doubles also the parts that no form differentiates: entries of (7), recursions without loops,
/// forces, energies, markers.
template <>
class Evaluation<double> : public EquationRows<double> {
 public:
  /// Values of M (upper triangle) and Φ_q in the order of the mechanism's KKT pattern. After
  /// place().
  virtual void mass_entries(double* values) = 0;
  /// Diagonal of M (nv), O(bodies). After place().
  virtual void mass_diagonal(double* values) = 0;
  /// Values of Φ_q in the order of the constraint pattern. After place().
  virtual void constraint_entries(double* values) = 0;

  /// (q, p, t) → (u, ṗ) by the recursion of the paper: mechanisms without loops only. False when a
  /// joint has no inertia.
  virtual bool open_momentum_rates(double t, const double* q, const double* p, double* u,
                                   double* pdot) = 0;
  /// (q, u, t) → u̇ by the articulated recursion: mechanisms without loops only.
  virtual bool open_accelerations(double t, const double* q, const double* u, double* udot) = 0;
  /// Sets forces τ (nv) that open_accelerations() adds to the joints'; null: none. Kept by
  /// reference.
  virtual void push(const double* /*tau*/) {}

  /// Forces in each bearing, four numbers (bearings.h), in the order of the scene's joints. After
  /// joint_forces().
  virtual void bearing_loads(double* /*forces*/) {}

  /// Why a slot, a cam or an equation has no value or no derivatives at the last place(), one
  /// sentence that names it; empty where all have them.
  virtual std::string lost_loop() const = 0;
  /// Place of each slot's point on its spline [m, along the chords], by index of the scene's loop;
  /// NaN for other loops. After place().
  virtual void slot_places(double* places) const = 0;
  /// Length of each spring-damper with limits [m], in the order of the scene. After place().
  virtual void limited_lengths(double* /*lengths*/) const {}

  /// Place in u of the joint at which the last open_…() call failed.
  virtual int singular_joint() const = 0;

  /// Generalised forces (nv) of springs, dampers and wrenches at points of bodies, at (t, q, u).
  /// Like applied_forces(), it overwrites what place() and move() left.
  virtual void body_forces(double t, const double* q, const double* u, double* tau) = 0;

  /// T [J]; after place() and move().
  virtual double kinetic() = 0;
  /// V [J]; after place().
  virtual double potential(const double* q) = 0;
  /// Power of the forces without potential [W]: dampers, wrenches that have no potential, formulas;
  /// and ∂V/∂t of potentials. After move(u).
  virtual double dissipated_power(const double* q, const double* u) = 0;
  /// How large the forces of formulas are, whether they balance or not [N, N m]. After move().
  virtual double formula_size() = 0;
  /// A sentence naming a force whose formula is not finite, and what was expected; empty: all are
  /// finite. After move().
  virtual std::string formula_without_value() = 0;
  /// For each marker its position x y z [m] and its velocity [m/s], in ground axes. After move().
  virtual void markers(double* values) = 0;
};

}  // namespace momenta
