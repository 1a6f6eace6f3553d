#pragma once
// The equations of small motions about a pose at rest. With r(q, u, u̇, λ) the residual of (1a),
//
//   q = q* ∘ exp δ,  u = δ̇:    M δ̈ + C δ̇ + K δ + Φ_qᵀ δλ = 0,   Φ_q δ = 0
//   M = ∂r/∂u̇,  C = ∂r/∂u,  K = ∂r/∂δ at constant λ,   all at (q*, 0, 0, λ*)
//
// K has the geometric part Σ λ_i ∂(∇Φ_i)/∂δ: loops' forces turn. All are exact to rounding, by dual
// numbers. Derivation: docs/theory/small-motions.md.
//
// About a motion at constant rates u*, in axes that move along with it,
//
//   δ̇ = δu + B δ,    M δu̇ + C δu + K δ + Aᵀ δλ = 0,    A δu + V δ = 0
//   B δ: q̇ = H(q) u, H δ̇ = H δu + [∂(H u)/∂q] H δ − [∂(H δ)/∂q] H u;   zero where u = q̇
//   V = ∂(A u − b)/∂δ
//
// A has the rows of all loops, nonholonomic ones too; all matrices at (q*, u*, 0, λ*).
//
// About any state of a motion all are taken at (q*, u*, u̇*, λ*), with rows of accelerations and
// derivatives of markers beside them:
//
//   A δu̇ + C_a δu + K_a δ = 0,    C_a = ∂Φ̈/∂u,  K_a = ∂Φ̈/∂δ

#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>

namespace momenta {

struct Linearisation {
  Eigen::MatrixXd M, C, K;  ///< M X, C X, K X, nv × columns of X
  Eigen::MatrixXd loops;    ///< Φ_q X, m × columns; of nonholonomic rows A X
};

/// About a motion at constant rates.
struct MovingLinearisation : Linearisation {
  Eigen::MatrixXd loop_rates;  ///< V X, m × columns
  Eigen::MatrixXd turning;     ///< B X, nv × columns
};

/// About a state of any motion.
struct StateLinearisation : MovingLinearisation {
  Eigen::MatrixXd second_by_rates, second_by_poses;    ///< C_a X, K_a X, m × columns
  Eigen::MatrixXd markers_by_rates, markers_by_poses;  ///< in the order of
                                                       ///< Mechanism::marker_columns()
};

/// Derivatives along X (nv × any number), at (t, q), u = u̇ = 0, with λ (m). Cost O(bodies) a
/// column.
Linearisation linearise(const Mechanism& mechanism, double t, const Eigen::VectorXd& q,
                        const Eigen::VectorXd& lambda, const Eigen::MatrixXd& X);

/// The same at rates u (nv), without accelerations.
MovingLinearisation linearise_moving(const Mechanism& mechanism, double t, const Eigen::VectorXd& q,
                                     const Eigen::VectorXd& u, const Eigen::VectorXd& lambda,
                                     const Eigen::MatrixXd& X);

/// The same at rates u and accelerations udot (nv).
StateLinearisation linearise_state(const Mechanism& mechanism, double t, const Eigen::VectorXd& q,
                                   const Eigen::VectorXd& u, const Eigen::VectorXd& udot,
                                   const Eigen::VectorXd& lambda, const Eigen::MatrixXd& X);

/// Every drive held at its value for t = 0, at rest.
Scene held_at_start(Scene scene);

}  // namespace momenta
