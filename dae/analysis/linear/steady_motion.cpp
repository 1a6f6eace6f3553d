#include <momenta/dae/algebra/dense/decompositions.h>
#include <momenta/dae/analysis/linear/linearisation.h>
#include <momenta/dae/analysis/linear/reduced_spectrum.h>
#include <momenta/dae/analysis/linear/steady_motion.h>
#include <momenta/dae/form/natural_sizes.h>
#include <momenta/dae/kkt/loop_rank.h>
#include <momenta/dae/mechanism/joint_places.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace momenta {
namespace {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

/// Left and right null space, and pseudo-inverse, of a matrix whose columns are scaled.
struct Decomposed {
  MatrixXd free;     ///< columns x, A x = 0
  MatrixXd inverse;  ///< A⁺ in the scaled columns
  Decomposed(const MatrixXd& a, const VectorXd& column) {
    const Eigen::Index n = column.size();
    free = column.asDiagonal();
    inverse.setZero(n, a.rows());
    if (a.rows() == 0) return;
    MatrixXd scaled = a * column.asDiagonal();
    VectorXd row = scaled.rowwise().norm();
    for (double& x : row) x = x > 0 ? 1 / x : 0;
    scaled = row.asDiagonal() * scaled;
    const SingularValues svd(scaled);
    const VectorXd& sizes = svd.values;
    const Eigen::Index rank = svd.rank(rank_tolerance);
    free = column.asDiagonal() * svd.v.rightCols(n - rank);
    inverse = column.asDiagonal() * svd.v.leftCols(rank) *
              sizes.head(rank).cwiseInverse().asDiagonal() * svd.u.leftCols(rank).transpose() *
              row.asDiagonal();
  }
};

/// First-order system of w and of the y that act, y in units of 1/ω.
struct Reduced {
  MatrixXd mass, P, N, S, kept, dropped;  ///< kept, dropped: of y
  MatrixXd E, of_w, system;               ///< ẏ = E y + of_w w
  double omega = 1;
};

Reduced reduce(const Mechanism& mechanism, const SteadyMotion& at) {
  const int nv = mechanism.nv(), m = mechanism.m();
  const MovingLinearisation l =
      linearise_moving(mechanism, at.t, at.q, at.u, at.lambda, MatrixXd::Identity(nv, nv));
  Reduced r;
  r.mass = l.M;
  const double heaviest = l.M.diagonal().maxCoeff();
  const VectorXd column = l.M.diagonal().unaryExpr([&](double x) {
    return 1 / std::sqrt(x > 0 ? x : heaviest > 0 ? heaviest : 1.0);
  });
  MatrixXd of_positions = l.loops;
  for (int i = 0; i < m; ++i)
    if (mechanism.nonholonomic()[static_cast<std::size_t>(i)]) of_positions.row(i).setZero();
  const Decomposed rates(l.loops, column), positions(of_positions, column);
  r.N = rates.free;
  r.P = positions.free;
  r.S = -rates.inverse * l.loop_rates * r.P;
  // P = diag(column) V with orthonormal V.
  const MatrixXd inverse = (column.cwiseInverse().cwiseAbs2().asDiagonal() * r.P).transpose();
  r.E = inverse * (r.S + l.turning * r.P);
  r.of_w = inverse * r.N;
  const MatrixXd mass = r.N.transpose() * l.M * r.N;
  const Eigen::LLT<MatrixXd> cholesky(0.5 * (mass + mass.transpose()));
  if (cholesky.info() != Eigen::Success)
    throw SceneError(mechanism.scene().where({}) +
                     "a motion that the loops allow moves no mass: expected inertia in every "
                     "motion");
  const MatrixXd inertial = r.N.transpose() * l.M * r.S;
  const MatrixXd D = -cholesky.solve(r.N.transpose() * (l.K * r.P + l.C * r.S) + inertial * r.E);
  const MatrixXd G = -cholesky.solve(r.N.transpose() * l.C * r.N + inertial * r.of_w);
  r.omega = std::max({std::sqrt(D.norm()), G.norm(), r.E.norm(), 1e-300});
  // Rows of O, each power in units of ω.
  constexpr double none = 1e-10;
  const Eigen::Index g = r.P.cols(), f = r.N.cols();
  MatrixXd observed(g * f, g);
  MatrixXd power = D / (r.omega * r.omega);
  for (Eigen::Index k = 0; k < g; ++k, power = power * r.E / r.omega)
    observed.middleRows(k * f, f) = power;
  Eigen::Index acting = 0;
  MatrixXd basis = MatrixXd::Identity(g, g);
  if (observed.size() > 0) {
    const SingularValues svd(observed, Eigen::ComputeThinU | Eigen::ComputeFullV);
    while (acting < svd.values.size() && svd.values[acting] > none) ++acting;
    basis = svd.v;
  }
  r.kept = basis.leftCols(acting);
  r.dropped = basis.rightCols(g - acting);
  r.system.resize(acting + f, acting + f);
  r.system << r.kept.transpose() * r.E * r.kept, r.omega * r.kept.transpose() * r.of_w,
      D * r.kept / r.omega, G;
  if (!r.system.allFinite())
    throw SceneError(mechanism.scene().where({}) +
                     "the linearised equations are not finite along the motion, expected another");
  return r;
}

/// Rounding of eigenvalues.
double dust(const Reduced& r) {
  return 64 * static_cast<double>(r.system.rows()) * std::numeric_limits<double>::epsilon() *
         r.omega;
}

std::vector<Mode> modes_of(const Reduced& r) {
  if (r.system.rows() == 0) return {};
  const Eigen::EigenSolver<MatrixXd> solver(r.system);
  const Eigen::Index kept = r.kept.cols();
  std::vector<Mode> modes;
  for (Eigen::Index i = 0; i < r.system.rows(); ++i) {
    Mode mode;
    mode.s = solver.eigenvalues()[i];
    if (std::abs(mode.s.imag()) <= dust(r)) mode.s.imag(0);
    if (std::abs(mode.s.real()) <= dust(r)) mode.s.real(0);
    if (mode.s.imag() < 0) continue;
    mode.real = mode.s.imag() == 0;
    const VectorXcd x = solver.eigenvectors().col(i), w = x.tail(r.N.cols());
    VectorXcd y = r.kept * x.head(kept) / r.omega;
    if (mode.s == 0.0) {
      mode.shape = r.N * w + r.S * y;
    } else {
      if (r.dropped.cols() > 0) {  // y that follow from w
        const MatrixXcd follows = mode.s * MatrixXcd::Identity(r.dropped.cols(), r.dropped.cols()) -
                                  MatrixXcd(r.dropped.transpose() * r.E * r.dropped);
        y += r.dropped * follows.fullPivLu().solve(r.dropped.transpose() * (r.E * y + r.of_w * w));
      }
      mode.shape = r.P * y;
    }
    normalise(mode, (mode.shape.adjoint() * (r.mass * mode.shape)).value().real());
    modes.push_back(std::move(mode));
  }
  sort_modes(modes);
  return modes;
}

/// q after a time at constant rates.
VectorXd carried(const Mechanism& mechanism, const VectorXd& q, const VectorXd& u, double time) {
  constexpr int steps = 400;
  const auto e = mechanism.evaluation<double>();
  VectorXd at = q, k(q.size()), sum(q.size());
  const double h = time / steps;
  for (int i = 0; i < steps; ++i) {
    VectorXd stage = at;
    sum.setZero();
    for (const auto& [ahead, weight] : {std::pair{0.5, 1.0}, {0.5, 2.0}, {1.0, 2.0}, {0.0, 1.0}}) {
      k.setZero();
      e->coordinate_rates(stage.data(), u.data(), k.data());
      sum += weight / 6 * k;
      stage = at + ahead * h * k;
    }
    at += h * sum;
    mechanism.tree().normalise(at);
  }
  return at;
}

/// One sentence on changes.
[[noreturn]] void refuse_unsteady(const Mechanism& mechanism, const VectorXd& udot) {
  Eigen::Index worst = 0;
  udot.cwiseQuotient(natural_units(mechanism)).cwiseAbs().maxCoeff(&worst);
  const Column column = mechanism.rate_columns()[static_cast<std::size_t>(worst)];
  char size[32];
  std::snprintf(size, sizeof size, "%.3g", udot[worst]);
  throw SceneError(mechanism.scene().where({}) + "the start is no steady motion: " + column.name +
                   " changes at " + size + " " + column.unit +
                   "²; expected constant rates, those of what turns on its way as rates of a free "
                   "joint, which are in body axes");
}

}  // namespace

Spectrum steady_spectrum(const Mechanism& mechanism, const Start& start, SteadyMotion& motion) {
  constexpr double same = 1e-7;
  Spectrum found;
  motion = {start.t, start.q, start.u, start.lambda, 0, 0, 0};
  if (mechanism.nv() == 0) return found;
  const double rate = own_rate(mechanism, start);
  const auto expect_steady = [&](const VectorXd& udot) {
    const double change = udot.cwiseQuotient(natural_units(mechanism)).cwiseAbs().maxCoeff();
    if (!(change <= same * rate * rate)) refuse_unsteady(mechanism, udot);
  };
  expect_steady(start.udot);
  const Reduced reduced = reduce(mechanism, motion);
  found.modes = modes_of(reduced);
  for (const double way : {0.31, 1.7}) {
    const double time = way / rate;
    const VectorXd q = carried(mechanism, start.q, start.u, time);
    const Assembly later = assemble(mechanism, start.t + time, q, start.u);
    expect_steady(later.start.udot);
    SteadyMotion there{start.t + time, later.start.q, later.start.u, later.start.lambda, 0, 0, 0};
    const Reduced other = reduce(mechanism, there);
    bool differs = other.system.rows() != reduced.system.rows();
    if (!differs) {
      // Matrices have a scale, up to the bases; coefficients of characteristic polynomials have
      // none.
      const std::vector<Mode> modes = modes_of(other);
      differs = modes.size() != found.modes.size();
      for (std::size_t i = 0; !differs && i < modes.size(); ++i)
        differs = !(std::abs(modes[i].s - found.modes[i].s) <= 100 * same * reduced.omega);
    }
    if (differs)
      throw SceneError(mechanism.scene().where({}) +
                       "the equations of small motions change along the motion: expected one that "
                       "looks the same at any time");
  }
  motion.positions = static_cast<int>(reduced.P.cols());
  motion.rates = static_cast<int>(reduced.N.cols());
  motion.left_out = static_cast<int>(reduced.dropped.cols());
  found.mobility = motion.rates;
  found.rank = mechanism.nv() - motion.rates;
  found.conservative = false;
  return found;
}

}  // namespace momenta
