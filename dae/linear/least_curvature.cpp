#include <momenta/dae/linear/least_curvature.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>

namespace momenta {

using Eigen::MatrixXd;
using Eigen::VectorXd;

LeastCurvature::LeastCurvature(const Mechanism& mechanism, PoseMotion& poses)
    : mechanism_(mechanism),
      poses_(poses),
      dual_(mechanism.evaluation<Dual8>()),
      q_(static_cast<std::size_t>(mechanism.nq())),
      u_(static_cast<std::size_t>(mechanism.nv()), Dual8(0.0)),
      lambda_(static_cast<std::size_t>(mechanism.m())),
      r_(u_.size()),
      way_(VectorXd::Zero(mechanism.nq())) {}

VectorXd LeastCurvature::stiffness(double t, const VectorXd& y) {
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

Curvature LeastCurvature::find(double t, const VectorXd& q, const VectorXd& lambda, int steps) {
  const int nv = mechanism_.nv();
  place_ = q;
  std::copy(lambda.begin(), lambda.end(), lambda_.begin());
  steps = std::min(steps, nv);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  VectorXd force(nv), y(nv);
  for (double& x : force) x = normal(random);
  poses_.evaluation().place(t, q.data());
  VectorXd diagonal(nv);
  poses_.evaluation().mass_diagonal(diagonal.data());
  force = force.cwiseProduct(diagonal.cwiseMax(0).cwiseSqrt());

  // Y: M-orthonormal, of the space of force, (M⁻¹K) y, (M⁻¹K)² y, …; P = M Y, S = K Y.
  MatrixXd Y(nv, steps), P(nv, steps), S(nv, steps);
  int count = 0;
  for (double scale = 0; count < steps; ++count) {
    if (!poses_.free_velocity(t, q, force, y) || !y.allFinite()) break;
    poses_.evaluation().place(t, q.data());
    const double whole = std::sqrt(std::max(0.0, y.dot(poses_.momentum(y))));
    for (int pass = 0; pass < 2; ++pass)
      y -= Y.leftCols(count) * (P.leftCols(count).transpose() * y);
    const VectorXd p = poses_.momentum(y);
    const double size = std::sqrt(std::max(0.0, y.dot(p)));
    scale = std::max(scale, whole);
    if (!(size > 1e-10 * scale)) break;  // nothing new
    Y.col(count) = y / size;
    P.col(count) = p / size;
    S.col(count) = force = stiffness(t, Y.col(count));
  }
  Curvature found;
  if (count == 0) return found;
  const MatrixXd T = Y.leftCols(count).transpose() * S.leftCols(count);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> ritz(0.5 * (T + T.transpose()));
  found.least = ritz.eigenvalues()[0];
  found.largest = ritz.eigenvalues()[count - 1];
  const double size = std::max(found.largest, -found.least);
  VectorXd sum = VectorXd::Zero(count);
  for (int i = 0; i < count && ritz.eigenvalues()[i] < -1e-6 * size; ++i)
    sum += ritz.eigenvectors().col(i);
  if (!sum.isZero(0)) found.downwards = Y.leftCols(count) * sum;
  return found;
}

}  // namespace momenta
