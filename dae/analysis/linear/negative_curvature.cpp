#include <momenta/dae/algebra/dense/decompositions.h>
#include <momenta/dae/analysis/linear/negative_curvature.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace momenta {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double least_ritz = 1e-8;  // relative: rounding

/// Eigenvectors of negative eigenvalues.
MatrixXd negative_of_symmetric(const MatrixXd& T) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> ritz(0.5 * (T + T.transpose()));
  const double dust = least_ritz * ritz.eigenvalues().cwiseAbs().maxCoeff();
  return ritz.eigenvectors().leftCols((ritz.eigenvalues().array() < -dust).count());
}

/// Sum of those of real eigenvalues.
MatrixXd negative_of(const MatrixXd& T) {
  if (!(T - T.transpose()).isZero(least_ritz * T.cwiseAbs().maxCoeff())) {
    const Eigen::EigenSolver<MatrixXd> ritz(T);
    const double dust = least_ritz * ritz.eigenvalues().cwiseAbs().maxCoeff();
    VectorXd sum = VectorXd::Zero(T.rows());
    for (int i = 0; i < T.rows(); ++i)
      if (const auto kappa = ritz.eigenvalues()[i];
          kappa.real() < -dust && std::abs(kappa.imag()) <= dust)
        sum += ritz.eigenvectors().col(i).real();
    return sum.isZero(0) ? MatrixXd(T.rows(), 0) : MatrixXd(sum);
  }
  return negative_of_symmetric(T);
}

VectorXd sum_of(const MatrixXd& ways) {
  return ways.cols() > 0 ? VectorXd(ways.rowwise().sum()) : VectorXd();
}

}  // namespace

NegativeCurvature::NegativeCurvature(const Mechanism& mechanism, PoseMotion& poses)
    : mechanism_(mechanism),
      poses_(poses),
      dual_(mechanism.evaluation<Dual8>()),
      q_(static_cast<std::size_t>(mechanism.nq())),
      u_(static_cast<std::size_t>(mechanism.nv()), Dual8(0.0)),
      lambda_(static_cast<std::size_t>(mechanism.m())),
      r_(u_.size()),
      way_(VectorXd::Zero(mechanism.nq())) {}

VectorXd NegativeCurvature::stiffness(double t, const VectorXd& y) {
  Evaluation<double>& e = poses_.evaluation();
  e.place(t, place_.data());
  e.coordinate_rates(place_.data(), y.data(), way_.data());
  for (std::size_t i = 0; i < q_.size(); ++i) {
    q_[i] = Dual8(place_[static_cast<long>(i)]);
    q_[i].b[0] = way_[static_cast<long>(i)];
  }
  dual_->place(t, q_.data());
  dual_->move(u_.data());
  dual_->joint_forces(q_.data(), u_.data(), nullptr, lambda_.data(), r_.data());
  VectorXd result(y.size());
  for (std::size_t i = 0; i < r_.size(); ++i) result[static_cast<long>(i)] = r_[i].b[0];
  return result;
}

/// Ritz vectors of negative value, in the Krylov space of a random vector. `image` takes y
/// and M y, and is self-adjoint in M where K is symmetric; an empty result ends the space.
template <class Image>
MatrixXd NegativeCurvature::negative(int steps, bool symmetric, Image&& image) {
  const int nv = mechanism_.nv();
  steps = std::min(steps, nv);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  VectorXd next(nv), start(nv), p(nv);
  poses_.evaluation().mass_diagonal(p.data());
  for (int i = 0; i < nv; ++i) start[i] = normal(random) * std::sqrt(std::max(0.0, p[i]));
  if (!poses_.free_velocity(now_, place_, start, next)) return {};

  MatrixXd Y(nv, steps), P(nv, steps), images(nv, steps);  // P = M Y
  int count = 0;
  for (double scale = 0; count < steps; ++count) {
    poses_.evaluation().place(now_, place_.data());
    const double whole = std::sqrt(std::max(0.0, next.dot(poses_.momentum(next))));
    for (int pass = 0; pass < 2; ++pass)
      next -= Y.leftCols(count) * (P.leftCols(count).transpose() * next);
    p = poses_.momentum(next);
    const double size = std::sqrt(std::max(0.0, next.dot(p)));
    scale = count == 0 ? 0 : std::max(scale, whole);
    if (!(size > 1e-10 * scale)) break;  // invariant space
    Y.col(count) = next / size;
    P.col(count) = p / size;
    next = image(VectorXd(Y.col(count)), VectorXd(P.col(count)));
    if (next.size() == 0 || !next.allFinite()) break;
    images.col(count) = next;
  }
  if (count == 0) return {};
  const MatrixXd T = P.leftCols(count).transpose() * images.leftCols(count);
  const MatrixXd ways = symmetric ? negative_of_symmetric(T) : negative_of(T);
  return Y.leftCols(count) * ways;
}

MatrixXd NegativeCurvature::downward(const MatrixXd& ways) {
  MatrixXd all(ways.rows(), ways.cols());
  Eigen::Index count = 0;
  for (const VectorXd y : ways.colwise())
    if (y.dot(stiffness(now_, y)) < 0) all.col(count++) = y;
  return all.leftCols(count);
}

VectorXd NegativeCurvature::find(double t, const VectorXd& q, const VectorXd& lambda,
                                 LocalPencil& factored, bool symmetric) {
  constexpr int most_far = 60, most_near = 30;
  now_ = t;
  place_ = q;
  std::copy(lambda.begin(), lambda.end(), lambda_.begin());
  poses_.evaluation().place(t, q.data());
  const auto checked = [&](const MatrixXd& ways) {
    return sum_of(symmetric ? downward(ways) : ways);
  };
  const VectorXd far =
      checked(negative(most_far, symmetric, [&](const VectorXd& y, const VectorXd&) {
        VectorXd next;
        const VectorXd force = stiffness(t, y);
        return poses_.free_velocity(t, q, force, next) ? next : VectorXd();
      }));
  if (far.size() > 0) return far;
  poses_.evaluation().place(t, q.data());
  return checked(negative(most_near, symmetric, [&](const VectorXd&, VectorXd p) {
    VectorXd gap = VectorXd::Zero(mechanism_.m());
    factored.solve(p, gap);
    return p;
  }));
}

}  // namespace momenta
