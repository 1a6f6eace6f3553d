#include <momenta/dae/algebra/dense/least_squares.h>
#include <momenta/dae/algebra/dense/singular_values.h>
#include <momenta/dae/run/measure/consistent_point.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace momenta {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double usable = 1e-8;  // relative singular values that count
constexpr double met = 1e-13, met_enough = 1e-10;
constexpr int most_newton_steps = 60, most_halvings = 10;

}  // namespace

struct CurveCorrection::Factors {
  int n = 0, nu = 0;
  double time = 1;
  std::vector<int> least, free;  ///< least-changed and free unknowns of y_0
  Vector rows, columns, scale;   ///< scales of F_0 …; of y_1 … and `free`; of `least`
  Matrix by_y;                   ///< J_0 of scaled rows and unknowns
  SingularValues svd;            ///< SVD of J_+
  Eigen::Index rank = 0;
  DenseLeastSquares constraints;  ///< N J_0

  Vector stacked(const Matrix& f) const {
    Vector all(rows.size());
    for (int i = 0; i <= nu; ++i) all.segment(i * n, n) = f.col(i) * std::pow(time, i);
    return all.cwiseProduct(rows);
  }
};

CurveCorrection::CurveCorrection(const CurveBlocks& at, int nu, double time_scale,
                                 const Vector& scale)
    : factors_(std::make_unique<Factors>()) {
  Factors& f = *factors_;
  const int n = f.n = static_cast<int>(at.f.rows());
  f.nu = nu;
  f.time = time_scale;
  for (int j = 0; j < n; ++j)
    if (scale[j] != 0) (std::isinf(scale[j]) ? f.free : f.least).push_back(j);
  const auto least = static_cast<Eigen::Index>(f.least.size()),
             free = static_cast<Eigen::Index>(f.free.size());
  f.scale.resize(least);
  for (Eigen::Index k = 0; k < least; ++k) f.scale[k] = scale[f.least[static_cast<std::size_t>(k)]];
  const int size = (nu + 1) * n;
  // J_+, with free columns of y_0, then the rest of J_0.
  Matrix all = Matrix::Zero(size, size + free + least);
  for (int i = 0; i <= nu; ++i) {
    for (int j = 1; j <= i + 1; ++j)
      all.block(i * n, (j - 1) * n, n, n) = at.by(i, j) * std::pow(time_scale, i - j);
    const Matrix by_y = at.by(i, 0) * std::pow(time_scale, i);
    for (Eigen::Index k = 0; k < free; ++k)
      all.col(size + k).segment(i * n, n) = by_y.col(f.free[static_cast<std::size_t>(k)]);
    for (Eigen::Index k = 0; k < least; ++k)
      all.col(size + free + k).segment(i * n, n) =
          by_y.col(f.least[static_cast<std::size_t>(k)]) * f.scale[k];
  }
  f.rows = Vector::Ones(size);
  const Vector columns = equilibrate(all, f.rows);
  f.columns = columns.head(size + free);
  // Least changes do not depend on how F is written.
  f.by_y = all.rightCols(least) * columns.tail(least).cwiseInverse().asDiagonal();
  f.svd = SingularValues(all.leftCols(size + free));
  f.rank = f.svd.rank(usable);
  const auto null = f.svd.u.rightCols(size - f.rank);
  if (least > 0) f.constraints.compute(null.transpose() * f.by_y, usable);
}

CurveCorrection::~CurveCorrection() = default;

Matrix CurveCorrection::of(const Matrix& f) const {
  const Factors& k = *factors_;
  Vector rest = -k.stacked(f);
  const Eigen::Index size = rest.size();
  Matrix change = Matrix::Zero(k.n, k.nu + 2);
  if (k.rank < size && !k.least.empty()) {
    const Vector of_y = k.svd.u.rightCols(size - k.rank).transpose() * rest;
    const Vector scaled = k.constraints.solve(of_y);
    for (std::size_t j = 0; j < k.least.size(); ++j) {
      const auto place = static_cast<Eigen::Index>(j);
      change(k.least[j], 0) = scaled[place] * k.scale[place];
    }
    rest -= k.by_y * scaled;
  }
  const Vector further = k.svd.solve(rest, k.rank).cwiseProduct(k.columns);
  for (int j = 1; j <= k.nu + 1; ++j)
    change.col(j) = further.segment((j - 1) * k.n, k.n) / std::pow(k.time, j);
  for (std::size_t j = 0; j < k.free.size(); ++j)
    change(k.free[j], 0) = further[size + static_cast<Eigen::Index>(j)];
  return change;
}

double CurveCorrection::size(const Matrix& f) const {
  return factors_->stacked(f).cwiseAbs().maxCoeff();
}

namespace {

/// Corrects the curve until F_0 … F_ν vanish; returns the residual. NaN: F is not finite.
double meet(const CurveSystem& system, double t, int nu, const Vector& scale, double time_scale,
            Matrix& curve) {
  double before = std::numeric_limits<double>::infinity();
  for (int count = 0;; ++count) {
    const CurveBlocks blocks(system, t, curve);
    bool finite = blocks.f.leftCols(nu + 1).allFinite();
    for (int i = 0; i <= nu; ++i)
      finite = finite && blocks.a[static_cast<std::size_t>(i)].allFinite() &&
               blocks.b[static_cast<std::size_t>(i)].allFinite();
    if (!finite) return std::numeric_limits<double>::quiet_NaN();
    const CurveCorrection correction(blocks, nu, time_scale, scale);
    const Matrix f = blocks.f.leftCols(nu + 1);
    const double size = correction.size(f);
    if (size <= met || count == most_newton_steps || (size <= met_enough && size > 0.5 * before))
      return size;
    before = size;
    const Matrix change = correction.of(f);
    // Newton's whole step where it lessens F, else half, and so on.
    double part = 1;
    for (int half = 0;; ++half, part *= 0.5) {
      Matrix tried = curve;
      tried.leftCols(nu + 2) += part * change;
      const CurveBlocks there(system, t, tried);
      const double left = correction.size(there.f.leftCols(nu + 1));
      if (left < size || half == most_halvings) {
        if (!std::isfinite(left)) return std::numeric_limits<double>::quiet_NaN();
        curve = std::move(tried);
        break;
      }
    }
  }
}

}  // namespace

ConsistentPoint consistent_point(const CurveSystem& system, double t, const Vector& y,
                                 const Vector& ydot, const Vector& scale, double time_scale) {
  ConsistentPoint point{y, ydot, {}, 0, ""};
  Matrix curve = Matrix::Zero(system.size, jet_order + 1);
  curve.col(0) = y;
  curve.col(1) = ydot;
  for (int nu = 0; nu <= most_differentiations; ++nu) {
    const double left = meet(system, t, nu, scale, time_scale, curve);
    if (std::isnan(left)) {
      point.why = "the equations are not finite near the guess";
      return point;
    }
    if (!(left <= met_enough)) {
      char text[160];
      std::snprintf(text, sizeof text,
                    "Newton's method found no point near the guess that meets the equations and "
                    "%d of their derivatives: %.2g is left of them",
                    nu, left);
      point.why = text;
      return point;
    }
    point.y = curve.col(0);
    point.differentiations = nu;
    point.found = find_index(system, t, point.y, curve.col(1), time_scale);
    if (point.found.index >= 0) {
      point.ydot = point.found.ydot;
      return point;
    }
  }
  point.why = point.found.why;
  return point;
}

}  // namespace momenta
