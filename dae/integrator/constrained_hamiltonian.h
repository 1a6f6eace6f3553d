#pragma once
// A system beside y = (q, p) for RATTLE and the energy-momentum scheme: the parts of H(q, p), L's
// Legendre transform, under Φ(q, t) = 0, with p = M u + (prescribed part), no impulses σ in it.

#include <memory>
#include <string>

namespace momenta {

/// The parts at one (t, q), with factors of M and, where asked for, of ( M Φ_qᵀ; Φ_q 0 ). A method
/// that iterates between places has one for each. After at(), no call allocates.
class HamiltonianPlace {
 public:
  virtual ~HamiltonianPlace() = default;

  /// Goes to (t, q). False where M is not positive definite.
  virtual bool at(double t, const double* q) = 0;
  /// Φ (m).
  virtual void positions(double* phi) = 0;
  /// u (nv) of M u + Φ_qᵀσ = p − prescribed part; `sigma` (m) null: zero.
  virtual void rates(const double* p, const double* sigma, double* u) = 0;
  /// Φ̇ (m) at rates u (nv).
  virtual void velocities(const double* u, double* rate) = 0;
  /// −∂H/∂q + Q = L_q + Q + Φ̇_qᵀσ (nv) at rates u (nv); `sigma` (m) null: zero.
  virtual void force(const double* q, const double* u, const double* sigma, double* g) = 0;
  /// Φ_qᵀ x (nv).
  virtual void constraint_forces(const double* x, double* result) = 0;
  /// M u + prescribed part (nv).
  virtual void momentum(const double* u, double* p) = 0;
  /// M x (nv), and x ← M⁻¹x.
  virtual void mass_times(const double* x, double* p) = 0;
  virtual void solve_mass(double* x) = 0;
  /// T + V [J] at rates u (nv), and T of the last energy().
  virtual double energy(const double* q, const double* u) = 0;
  virtual double kinetic() = 0;
  /// Power of forces without potential [W], at rates u (nv) of the last force().
  virtual double power(const double* q, const double* u) = 0;

  /// Factorises the matrix at (t, q), the place of the last at(). False where it has no solution.
  virtual bool factor(double t, const double* q) = 0;
  /// δ (nv) and ν (m) of M δ + Φ_qᵀν = 0, Φ_q δ = −g (m), where the last factor() was. In rows that
  /// depend on others ν fades to zero. False where a result is not finite.
  virtual bool correction(const double* g, double* delta, double* nu) = 0;
};

class ConstrainedHamiltonian {
 public:
  virtual ~ConstrainedHamiltonian() = default;
  virtual int coordinates() const = 0;  ///< nq
  virtual int momenta() const = 0;      ///< nv
  virtual int multipliers() const = 0;  ///< m
  /// What is prescribed, in words: a drive, or a constraint that takes the time; empty: nothing.
  virtual std::string prescribed() const = 0;
  virtual std::unique_ptr<HamiltonianPlace> place() const = 0;
  /// Why M has no inverse at (t, q), in words; empty: it has one.
  virtual std::string without_inverse(double t, const double* q) = 0;
  /// q' (nq) at rates u, and q ∘ exp δ: see SecondOrder.
  virtual void coordinate_rates(const double* q, const double* u, double* qdot) = 0;
  virtual void move(const double* q, const double* delta, double* moved) = 0;
};

}  // namespace momenta
