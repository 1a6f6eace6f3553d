#include <momenta/dae/dense/least_squares.h>
#include <momenta/dae/dense_blocks.h>
#include <momenta/dae/unheld_joints.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double motion_part = 1e-9;  // of a motion's largest rate
constexpr double held_pivot = 1e-9;   // of pivots of Φ_q N, beside the largest terms of a column

/// N of those `lost`.
MatrixXd motions_without_momentum(const MatrixXd& mass, const std::vector<MasslessJoint>& joints) {
  const auto n = static_cast<int>(mass.rows());
  std::vector<int> lost;
  for (const MasslessJoint& joint : joints) lost.push_back(joint.rate);
  std::vector<int> kept;
  for (int i = 0; i < n; ++i)
    if (!std::binary_search(lost.begin(), lost.end(), i)) kept.push_back(i);
  MatrixXd motions = MatrixXd::Zero(n, static_cast<Eigen::Index>(lost.size()));
  for (std::size_t k = 0; k < lost.size(); ++k) motions(lost[k], static_cast<Eigen::Index>(k)) = 1;
  if (kept.empty()) return motions;
  motions(kept, Eigen::all) = -mass(kept, kept).ldlt().solve(mass(kept, lost));
  return motions;
}

/// Y, columns.
MatrixXd left_free(const MatrixXd& constraint, const MatrixXd& motions) {
  MatrixXd a = constraint * motions;
  for (Eigen::Index k = 0; k < a.cols(); ++k) {
    const double size = (constraint.cwiseAbs() * motions.col(k).cwiseAbs()).maxCoeff();
    if (size > 0) a.col(k) /= size;
  }
  // Beside what its terms are, not beside the largest: where all of them cancel, none holds.
  MatrixXd y = left_null_space(a.transpose(), held_pivot);
  if (y.cols() == 0) return y;  // all are held; rows of nothing lie nowhere
  for (Eigen::Index k = 0; k < a.cols(); ++k) {
    const double size = (constraint.cwiseAbs() * motions.col(k).cwiseAbs()).maxCoeff();
    if (size > 0) y.row(k) /= size;
  }
  return y;
}

}  // namespace

UnheldJoints unheld_joints(const Mechanism& mechanism, Evaluation<double>& e, double t,
                           const double* q, bool loops, int known) {
  UnheldJoints found;
  e.place(t, q);
  VectorXd diagonal(mechanism.nv());
  e.mass_diagonal(diagonal.data());
  if (!diagonal.allFinite()) return found;
  MatrixXd mass;
  if (mechanism.nv() <= most_pivots) mass = dense_mass(mechanism, e);
  found.joints = massless_joints(mechanism.tree(), diagonal, mass, known);
  if (mass.size() == 0 || found.joints.empty()) return found;
  found.motions = motions_without_momentum(mass, found.joints);
  if (!loops || mechanism.m() == 0) return found;
  const MatrixXd y = left_free(dense_constraints(mechanism, e), found.motions);
  std::vector<MasslessJoint> unheld;
  for (Eigen::Index k = 0; k < y.rows(); ++k)
    for (Eigen::Index j = 0; j < y.cols(); ++j)
      if (std::abs(y(k, j)) > motion_part * y.col(j).cwiseAbs().maxCoeff()) {
        unheld.push_back(found.joints[static_cast<std::size_t>(k)]);
        break;
      }
  found.joints = std::move(unheld);
  found.motions = found.motions * y;
  return found;
}

bool solve_beside(const UnheldJoints& unheld, const Mechanism& mechanism, Evaluation<double>& e,
                  const VectorXd& r, const VectorXd& g, VectorXd& x, VectorXd& lambda) {
  constexpr double powerless = 1e-12;  // of the largest force
  const Eigen::Index n = mechanism.nv(), m = g.size();
  const Eigen::Index motions = unheld.motions.cols();
  if ((motions == 0 && !unheld.joints.empty()) || n + m > 2 * most_pivots) return false;
  MatrixXd mass = dense_mass(mechanism, e);
  if (motions > 0) {
    const MatrixXd free = orthogonal_factor(unheld.motions).leftCols(motions);
    if (!((free.transpose() * r).cwiseAbs().maxCoeff() <= powerless * r.cwiseAbs().maxCoeff()))
      return false;
    const double heaviest = mass.diagonal().maxCoeff();
    mass += (heaviest > 0 ? heaviest : 1) * free * free.transpose();
  }
  MatrixXd a = MatrixXd::Zero(n + m, n + m);
  a.topLeftCorner(n, n) = mass;
  if (m > 0) {
    a.bottomLeftCorner(m, n) = dense_constraints(mechanism, e);
    a.topRightCorner(n, m) = a.bottomLeftCorner(m, n).transpose();
  }
  // Rows of Φ of one size beside inertias of one size.
  VectorXd scale = VectorXd::Ones(n + m), b(n + m);
  const double least = 1e-12 * mass.diagonal().maxCoeff();  // of what loops alone hold
  for (Eigen::Index i = 0; i < n; ++i)
    if (mass(i, i) > 0) scale[i] = 1 / std::sqrt(std::max(mass(i, i), least));
  for (Eigen::Index i = n; i < n + m; ++i) {
    const double size = a.row(i).head(n).cwiseProduct(scale.head(n).transpose()).norm();
    if (size > 0) scale[i] = 1 / size;
  }
  b << r, g;
  a = scale.asDiagonal() * a * scale.asDiagonal();
  DenseLeastSquares system;
  system.compute(a);
  const VectorXd all = scale.asDiagonal() * system.solve(VectorXd(scale.asDiagonal() * b));
  x = all.head(n);
  lambda = all.tail(m);
  return all.allFinite();
}

void blank(const UnheldJoints& unheld, VectorXd& x) {
  for (Eigen::Index k = 0; k < unheld.motions.cols(); ++k) {
    const double largest = unheld.motions.col(k).cwiseAbs().maxCoeff();
    for (Eigen::Index i = 0; i < x.size(); ++i)
      if (std::abs(unheld.motions(i, k)) > motion_part * largest)
        x[i] = std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace momenta
