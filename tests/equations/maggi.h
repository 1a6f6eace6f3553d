#pragma once
// Accelerations under rows A(q) u = b(q, t) without multipliers: with the columns of N a basis of
// A N = 0,
//
//   Nᵀ(M u̇ + h) = 0,    A u̇ = −(Ȧ u − ḃ)        (Maggi)
//
// M, h and A are taken of the evaluation, dense: M column by column from the residual of (1a), A
// from the rates of the rows, γ = Ȧ u − ḃ by differences of these rates along the motion at u̇ = 0.

#include <momenta/dae/form/coordinate_motion.h>

#include <Eigen/LU>

namespace momenta::equations {

struct Maggi {
  Eigen::MatrixXd M, A, N;
  Eigen::VectorXd h, gamma, udot;

  Maggi(const Mechanism& mechanism, double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) {
    const int nv = mechanism.nv(), m = mechanism.m();
    const auto e = mechanism.evaluation<double>();
    const auto rates = [&](double at, const Eigen::VectorXd& place, const Eigen::VectorXd& rate) {
      Eigen::VectorXd g(m);
      e->place(at, place.data());
      e->move(rate.data());
      e->velocities(g.data());
      return g;
    };
    const auto forces = [&](const Eigen::VectorXd& acceleration) {
      Eigen::VectorXd r(nv);
      e->place(t, q.data());
      e->move(u.data());
      e->joint_forces(q.data(), u.data(), acceleration.data(), nullptr, r.data());
      return r;
    };
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(nv);
    h = forces(none);
    M.resize(nv, nv);
    A.resize(m, nv);
    const Eigen::VectorXd b = rates(t, q, none);
    for (int j = 0; j < nv; ++j) {
      M.col(j) = forces(Eigen::VectorXd::Unit(nv, j)) - h;
      A.col(j) = rates(t, q, Eigen::VectorXd::Unit(nv, j)) - b;
    }
    CoordinateMotion motion(mechanism);
    const auto along = [&](double x) {
      Eigen::VectorXd there(q.size());
      const Eigen::VectorXd way = x * u;
      e->place(t, q.data());
      motion.move(*e, q.data(), way.data(), there.data());
      return rates(t + x, there, u);
    };
    constexpr double d = 1e-3;  // eighth order
    gamma =
        (4.0 / 5 * (along(d) - along(-d)) - 1.0 / 5 * (along(2 * d) - along(-2 * d)) +
         4.0 / 105 * (along(3 * d) - along(-3 * d)) - 1.0 / 280 * (along(4 * d) - along(-4 * d))) /
        d;
    N = Eigen::FullPivLU<Eigen::MatrixXd>(A).kernel();
    Eigen::MatrixXd left(N.cols() + m, nv);
    left << N.transpose() * M, A;
    Eigen::VectorXd right(left.rows());
    right << -N.transpose() * h, -gamma;
    udot = left.fullPivLu().solve(right);
  }
};

}  // namespace momenta::equations
