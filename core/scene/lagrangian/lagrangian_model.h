#pragma once
// The tapes of exact derivatives of a Lagrangian that forms evaluate. With L quadratic in q̇,
//
//   p = ∂L/∂q̇ = M(q, t) q̇ + b(q, t),        M = ∂²L/∂q̇∂q̇,   b = ∂L/∂q̇ at q̇ = 0
//   ṗ = ∂L/∂q + Q + Φ̇_qᵀσ                    (8), p with Φ_qᵀσ in it
//   d/dt ∂L/∂q̇ − ∂L/∂q − Q + Φ_qᵀλ = 0       (1a)
//
// Time derivatives are directional ones. With v for q̇ and a for q̈, held constant,
//
//   dL/dt = D = L_q v + L_q̇ a + L_t,    d/dt ∂L/∂q̇ = ∂D/∂q̇  at v = q̇, a = q̈,
//   Φ̇ = Φ_q v + Φ_t,                    Φ̈ = Φ̇_q v + Φ̇_v a + Φ̇_t,
//   Φ_qᵀ s = ∂(s·Φ)/∂q,                 Φ̇_qᵀ s = ∂(s·Φ̇)/∂q,
//
// each one reverse sweep over a tape of the one before. The energy is that of Jacobi,
//
//   h = p·q̇ − L = ½ q̇ᵀM q̇ − L(q, 0, t),   ḣ = Q·q̇ − L_t − λ·Φ_t,
//
// which is T + V where T has no part without q̇.
// Source: Griewank and Walther, Evaluating Derivatives, 3.2; Lanczos, The Variational Principles of
// Mechanics, VI.

#include <momenta/core/expression/expression.h>
#include <momenta/core/scene/scene.h>

#include <string>
#include <vector>

namespace momenta {

/// Tapes over the variables x = (q, q̇, t, v, a, s); n coordinates, m constraints.
struct LagrangianModel {
  struct Entry {
    int row, column;
  };
  /// Values and where they stand.
  struct Entries {
    std::vector<Entry> places;
    Expression values;
  };

  int n, m;
  int rate(int i) const { return n + i; }                  ///< place of q̇_i in x
  int time() const { return 2 * n; }                       ///< place of t
  int direction(int i) const { return 2 * n + 1 + i; }     ///< place of v_i
  int acceleration(int i) const { return 3 * n + 1 + i; }  ///< place of a_i
  int multiplier(int i) const { return 4 * n + 1 + i; }    ///< place of s_i
  int variables() const { return 4 * n + 1 + m; }          ///< size of x

  Expression positions;          ///< Φ (m): of q, t
  Expression velocities;         ///< Φ̇ (m): of q, t, v
  Expression accelerations;      ///< Φ̈ (m): of q, t, v, a
  Expression constraint_forces;  ///< Φ_qᵀs (n): of q, t, s
  Expression constraint_rates;   ///< Φ̇_qᵀs (n): of q, t, v, s
  Expression momenta;            ///< ∂L/∂q̇ (n): of q, q̇, t
  Expression momentum_rates;     ///< ∂L/∂q + Q (n): of q, q̇, t
  Expression joint_forces;       ///< d/dt ∂L/∂q̇ − ∂L/∂q − Q (n): of q, q̇, t, v, a
  Expression applied;            ///< Q (n): of q, q̇, t
  Expression kinetic;            ///< ½ q̇ᵀM q̇: of q, q̇, t
  Expression potential;          ///< −L(q, 0, t): of q, t
  Expression power;              ///< Q·q̇ − L_t: of q, q̇, t
  /// M: upper triangle, of q, t. Column j has all its ancestors in the elimination tree, from the
  /// last coordinate to the first, so that a factor fills no other place.
  Entries mass;
  Entries constraint;  ///< Φ_q: of q, t
  bool in_time;        ///< t is in a formula
  bool linear;         ///< b is not zero
  bool balanced;       ///< Q is zero at rest: all other forces have a potential
  bool has_power;      ///< power is not zero
  bool moving;         ///< Φ_t is not zero: constraints do work
};

/// @pre a valid scene with a Lagrangian. @throws SceneError: a fault of a formula, an L not
/// quadratic in the rates. O(n tape) and, for the pattern of M, O(n²)
LagrangianModel build_lagrangian_model(const Scene& scene);

}  // namespace momenta
