#pragma once
// Small motions by differences of accelerations: the slow twin of the linearised equations.
//
//   δ̈ = A δ + B δ̇,  A = ∂u̇/∂δ at rest, B = ∂u̇/∂u,   along a basis N of Φ_q δ = 0
//
// where u̇ is that of (3), at poses brought back to Φ = 0: neither λ nor any second derivative of
// V or Φ is asked for. Good to about 1e-7.

#include "equations/kkt_blocks.h"

#include <momenta/dae/analysis/linear/equilibrium.h>
#include <momenta/dae/analysis/linear/pose_motion.h>

#include <Eigen/Dense>
#include <complex>
#include <vector>

namespace momenta::equations {

/// All s of δ = e^{st}, conjugate and negative ones too.
inline std::vector<std::complex<double>> differenced_spectrum(const Mechanism& mechanism,
                                                              const Equilibrium& at) {
  using Eigen::MatrixXd, Eigen::VectorXd;
  constexpr double h = 1e-5;
  const int nv = mechanism.nv(), m = mechanism.m();
  PoseMotion poses(mechanism);
  Evaluation<double>& e = poses.evaluation();
  e.place(at.t, at.q.data());
  const KktBlocks blocks(mechanism, e);
  MatrixXd N = MatrixXd::Identity(nv, nv);
  if (m > 0) {
    Eigen::FullPivLU<MatrixXd> lu(blocks.J);
    lu.setThreshold(1e-9);
    if (lu.dimensionOfKernel() == 0) return {};
    N = lu.kernel();
  }
  const MatrixXd onto = (N.transpose() * N).ldlt().solve(N.transpose());
  const auto solver = m > 0 ? make_loop_solver(mechanism, e) : nullptr;
  const auto acceleration = [&](const VectorXd& q, const VectorXd& u) {
    VectorXd udot = VectorXd::Zero(nv), lambda(m);
    if (solver)
      solver->acceleration(at.t, q.data(), u.data(), nullptr, 0, 0, udot.data(), lambda.data());
    else
      e.open_accelerations(at.t, q.data(), u.data(), udot.data());
    return udot;
  };
  const Eigen::Index d = N.cols();
  MatrixXd first_order = MatrixXd::Zero(2 * d, 2 * d);
  first_order.topRightCorner(d, d).setIdentity();
  const VectorXd rest = VectorXd::Zero(nv);
  for (Eigen::Index k = 0; k < d; ++k) {
    const VectorXd step = h / N.col(k).cwiseAbs().maxCoeff() * N.col(k);
    const double size = h / N.col(k).cwiseAbs().maxCoeff();
    VectorXd ahead, behind;
    poses.move(at.t, at.q, step, ahead);
    poses.move(at.t, at.q, -step, behind);
    first_order.block(d, k, d, 1) =
        onto * (acceleration(ahead, rest) - acceleration(behind, rest)) / (2 * size);
    first_order.block(d, d + k, d, 1) =
        onto * (acceleration(at.q, step) - acceleration(at.q, -step)) / (2 * size);
  }
  const Eigen::EigenSolver<MatrixXd> eigen(first_order, false);
  return {eigen.eigenvalues().begin(), eigen.eigenvalues().end()};
}

}  // namespace momenta::equations
