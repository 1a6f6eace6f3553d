#pragma once
// The effect on a loop's equations of varying its drive: the columns of linearise_state() that its
// f would have as a coordinate.
//
// The loop has Φ(q, f), and the rest follows from Φ along the motion, since variation and time
// derivative commute:
//
//   Φ_f   in Φ by f, in Φ̇ by ḟ, in Φ̈ by f̈
//   V = d/dt Φ_f    in Φ̇ by f, in Φ̈ by ḟ twice:  ∂Φ̈/∂ḟ = 2 ∂Φ̇/∂f
//   W = d²/dt² Φ_f  in Φ̈ by f
//   K = ∂(Φ_qᵀλ)/∂f  in (1a) by f
//
// f, ḟ, f̈ of a drive are numbers here, and Φ, Φ̇, Φ̈ and Φ_qᵀλ known functions of them
// (loop_model.h); the columns are derivatives without truncation error:
//
//   numbers  l of (D² − l²)/2l₀:  Φ_f = −l/l₀, V = −l̇/l₀, W = −l̈/l₀, K = 0;  c of Σ r q − c:  −1
//   slides   x_B moves by f d: polynomials of degree 2 at the most, F' = (F(f+h) − F(f−h)) / 2h
//   angles   axes turn by f: trigonometric polynomials. Φ̈ of O_ij is (a × b)·ẇ + products of one
//            axis and two angular velocities, each of degree 1 in the angle: degree 3, and with
//            x_k = (2k − 1) π/6 (M. Riesz, Jahresber. DMV 23 (1914) 354)
//              F' = Σ_{k=1..6} (−1)^{k+1} F(f + x_k) / (12 sin²(x_k/2))
//
// Drives of origins of slots on curves, cams and racks have none of these F and stay functions of
// time.

#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <vector>

namespace momenta {

/// Places in scene.drives of the drives of loops that can be varied.
std::vector<int> drives_of_loops_that_vary(const Scene& scene);

/// Columns f, ḟ, f̈, named by the loop: "B.q", "B.u", "B.udot"; with several coordinates "B.q2" …;
/// of the origin "B.x", "B.vx", "B.ax".
std::vector<Column> columns_of_loop_drive(const Scene& scene, int drive);

struct LoopDriveColumns {
  Eigen::MatrixXd loops, loop_rates, second_by_poses;  ///< Φ_f, V, W, m × drives
  Eigen::MatrixXd forces;                              ///< K, nv × drives
};

/// Columns at (t, q, u, u̇) with λ. Cost: at most six mechanisms and their equations for each drive.
LoopDriveColumns loop_drive_columns(const Mechanism& mechanism, const std::vector<int>& drives,
                                    double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                                    const Eigen::VectorXd& udot, const Eigen::VectorXd& lambda);

}  // namespace momenta
