#include <momenta/dae/algebra/dense/decompositions.h>
#include <momenta/dae/analysis/linear/linearisation.h>
#include <momenta/dae/analysis/linear/reduced_spectrum.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Rounding of an eigenvalue of K̃ along y: the change of K between poses that cannot be told apart,
/// rounding of the forces in K, and of the solver. Of two poses on opposite sides the lesser change
/// counts: a force with a corner at the pose has another K on one side, however near.
class Rounding {
 public:
  Rounding(const Mechanism& mechanism, const Equilibrium& at, const MatrixXd& N, const MatrixXd& K,
           double largest)
      : floor_(8 * static_cast<double>(N.cols()) * epsilon * largest), N_(N) {
    constexpr int poses = 2;
    constexpr double least = 1e-12;  // [rad or m]
    std::mt19937 random(1);
    std::uniform_real_distribution<double> within(-1, 1);
    const double way = std::max(least, std::min(at.last_step, 1e-3));
    const auto e = mechanism.evaluation<double>();
    VectorXd delta = VectorXd::Zero(mechanism.nv()), qdot(mechanism.nq());
    e->place(at.t, at.q.data());
    e->move(delta.data());
    stiffness_ = force_scales(mechanism, *e).cwiseQuotient(natural_units(mechanism)).cwiseSqrt();
    for (int k = 0; k < 2 * poses; ++k) {
      if (k % 2 == 1)
        delta = -delta;
      else
        for (double& x : delta) x = way * within(random);
      qdot.setZero();
      e->place(at.t, at.q.data());
      e->coordinate_rates(at.q.data(), delta.data(), qdot.data());
      const Linearisation other = linearise(mechanism, at.t, at.q + qdot, at.lambda, N);
      changes_.push_back(N.transpose() * other.K - K);
    }
  }
  double along(const VectorXd& y) const {
    double most = 0;
    for (std::size_t k = 0; k + 1 < changes_.size(); k += 2)
      most = std::max(
          most, std::min(std::abs(y.dot(changes_[k] * y)), std::abs(y.dot(changes_[k + 1] * y))));
    const double forces = stiffness_.dot((N_ * y).cwiseAbs());
    return 10 * most + 4 * epsilon * forces * forces + floor_;
  }

 private:
  double floor_;
  const MatrixXd& N_;
  VectorXd stiffness_;             ///< roots of natural stiffnesses of the rates
  std::vector<MatrixXd> changes_;  ///< changes of K at poses and their opposites, in turn
};

struct OnBasis {
  MatrixXd N, C, K;  ///< N M-orthonormal; C̃, K̃
};

/// s² = −ω² of K̃ y = ω² y.
void self_adjoint(const OnBasis& r, const Mechanism& mechanism, const Equilibrium& at,
                  std::vector<Mode>& modes) {
  const MatrixXd symmetric = 0.5 * (r.K + r.K.transpose());
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(symmetric);
  const VectorXd& squares = solver.eigenvalues();
  const Rounding rounding(mechanism, at, r.N, r.K, squares.cwiseAbs().maxCoeff());
  for (Eigen::Index i = 0; i < squares.size(); ++i) {
    const VectorXd y = solver.eigenvectors().col(i);
    Mode mode;
    if (std::abs(squares[i]) > rounding.along(y))
      mode.s = squares[i] > 0 ? std::complex<double>(0, std::sqrt(squares[i]))
                              : std::complex<double>(std::sqrt(-squares[i]), 0);
    mode.shape = (r.N * y).cast<std::complex<double>>();
    normalise(mode, 1);
    modes.push_back(std::move(mode));
  }
}

/// With K̃ Z = 0 and (Z R) orthonormal, y = Z z + R x, w = ẏ: z itself drops out of
///
///   (x)'   ( 0     Rᵀ ) (x)
///   (w)  = ( −K̃R  −C̃ ) (w),
///
/// which has one zero less for every z. Zeros remain where C̃ does not hold z either, as many as (K̃R
/// C̃Z) has dependent columns. x is in units of 1/ω₀, ω₀² about the size of K̃.
void first_order(const OnBasis& r, const Mechanism& mechanism, const Equilibrium& at,
                 std::vector<Mode>& modes) {
  const Eigen::Index d = r.K.rows();
  const SingularValues svd(r.K);
  const VectorXd& sizes = svd.values;
  const Rounding rounding(mechanism, at, r.N, r.K, sizes[0]);
  Eigen::Index held = d;
  while (held > 0 && sizes[held - 1] <= rounding.along(svd.v.col(held - 1))) --held;
  const MatrixXd R = svd.v.leftCols(held), Z = svd.v.rightCols(d - held);
  const double omega = std::max({std::sqrt(sizes[0]), r.C.norm(), 1e-300});
  MatrixXd A = MatrixXd::Zero(held + d, held + d);
  A.topRightCorner(held, d) = omega * R.transpose();
  A.bottomLeftCorner(d, held) = -r.K * R / omega;
  A.bottomRightCorner(d, d) = -r.C;

  MatrixXd coupled(d, d);
  coupled << r.K * R / omega, r.C * Z;
  const VectorXd ranks = SingularValues(coupled).values;
  Eigen::Index free = 0;
  while (free < d - held && ranks[d - 1 - free] <= 1e-11 * std::max(omega, ranks[0])) ++free;

  const Eigen::EigenSolver<MatrixXd> solver(A);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(A.rows()));
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Eigen::Index>(i);
  const auto& values = solver.eigenvalues();
  std::stable_sort(order.begin(), order.end(),
                   [&](auto i, auto j) { return std::abs(values[i]) < std::abs(values[j]); });
  for (Eigen::Index i = 0; i < Z.cols(); ++i) {
    Mode mode;
    mode.shape = (r.N * Z.col(i)).cast<std::complex<double>>();
    normalise(mode, 1);
    modes.push_back(std::move(mode));
  }
  const double dust = 64 * static_cast<double>(A.rows()) * epsilon * omega;
  for (auto i = order.begin() + free; i != order.end(); ++i) {
    Mode mode;
    mode.s = values[*i];
    if (std::abs(mode.s.imag()) <= dust) mode.s.imag(0);
    if (std::abs(mode.s.real()) <= dust) mode.s.real(0);
    if (mode.s.imag() < 0) continue;
    mode.real = mode.s.imag() == 0;
    const VectorXcd y = solver.eigenvectors().col(*i).tail(d);
    mode.shape = r.N.cast<std::complex<double>>() * y;
    normalise(mode, y.squaredNorm());
    modes.push_back(std::move(mode));
  }
}

}  // namespace

void normalise(Mode& mode, double squared) {
  if (mode.shape.size() == 0) return;
  Eigen::Index largest;
  mode.shape.cwiseAbs().maxCoeff(&largest);
  const std::complex<double> at = mode.shape[largest];
  mode.shape *= std::conj(at) / (std::abs(at) * std::sqrt(squared));
  if (mode.real) mode.shape = mode.shape.real().cast<std::complex<double>>().eval();
}

void sort_modes(std::vector<Mode>& modes) {
  std::stable_sort(modes.begin(), modes.end(), [](const Mode& a, const Mode& b) {
    const double x = std::max(a.s.real(), 0.0), y = std::max(b.s.real(), 0.0);
    return x != y ? x > y : std::abs(a.s) < std::abs(b.s);
  });
}

void reduced_spectrum(const Mechanism& mechanism, const Equilibrium& at, const MatrixXd& N,
                      Spectrum& found) {
  if (N.cols() == 0) return;
  Linearisation l = linearise(mechanism, at.t, at.q, at.lambda, N);
  const MatrixXd mass = N.transpose() * l.M;
  const Eigen::LLT<MatrixXd> cholesky(0.5 * (mass + mass.transpose()));
  if (cholesky.info() != Eigen::Success || !mass.allFinite())
    throw SceneError(mechanism.scene().where({}) +
                     "a motion that the loops allow moves no mass: expected inertia in every "
                     "motion");
  const auto orthonormal = [&](const MatrixXd& x) -> MatrixXd {  // x L⁻ᵀ
    return cholesky.matrixL().solve(x.transpose()).transpose();
  };
  OnBasis r;
  r.N = orthonormal(N);
  r.C = r.N.transpose() * orthonormal(l.C);
  r.K = r.N.transpose() * orthonormal(l.K);
  if (!r.C.allFinite() || !r.K.allFinite())
    throw SceneError(
        mechanism.scene().where({}) +
        "the linearised equations are not finite at the equilibrium, expected another");
  found.conservative = l.C.isZero(0) && has_potential(mechanism);
  if (found.conservative)
    self_adjoint(r, mechanism, at, found.modes);
  else
    first_order(r, mechanism, at, found.modes);
  sort_modes(found.modes);
}

}  // namespace momenta
