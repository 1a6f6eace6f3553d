#include <momenta/dae/algebra/dense/singular_values.h>
#include <momenta/dae/run/measure/derivative_array.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

namespace momenta {

namespace {

constexpr double rounding_only = 1e-9;  // relative; smaller rows and columns are not scaled
}  // namespace

/// Unknown by unknown, direction 0 along y, direction 1 along y'.
CurveBlocks::CurveBlocks(const CurveSystem& system, double t, const Eigen::MatrixXd& curve) {
  const int n = system.size;
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  std::vector<Jet> y(at(n)), ydot(at(n)), r(at(n));
  for (int i = 0; i < n; ++i)
    for (int k = 0; k <= jet_order; ++k) {
      y[at(i)].a.c[at(k)] = curve(i, k);
      if (k > 0) ydot[at(i)].a.c[at(k - 1)] = k * curve(i, k);
    }
  f = Eigen::MatrixXd::Zero(n, jet_order);
  a.assign(at(jet_order), Eigen::MatrixXd::Zero(n, n));
  b.assign(at(jet_order), Eigen::MatrixXd::Zero(n, n));
  for (int j = 0; j < n; ++j) {
    y[at(j)].b[0] = PowerSeries<jet_order>(1.0);
    ydot[at(j)].b[1] = PowerSeries<jet_order>(1.0);
    system.equations(t, y.data(), ydot.data(), r.data());
    y[at(j)].b[0] = ydot[at(j)].b[1] = PowerSeries<jet_order>(0.0);
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < jet_order; ++k) {
        a[at(k)](i, j) = r[at(i)].b[0].c[at(k)];
        b[at(k)](i, j) = r[at(i)].b[1].c[at(k)];
        if (j == 0) f(i, k) = r[at(i)].a.c[at(k)];
      }
  }
}

Eigen::MatrixXd CurveBlocks::by(int i, int j) const {
  if (j > i + 1) return Eigen::MatrixXd::Zero(f.rows(), f.rows());
  const auto at = [](int k) { return static_cast<std::size_t>(k); };
  if (j == 0) return a[at(i)];
  Eigen::MatrixXd block = j * b[at(i - j + 1)];
  if (i >= j) block += a[at(i - j)];
  return block;
}

Eigen::VectorXd equilibrate(Eigen::MatrixXd& matrix, Eigen::VectorXd& right) {
  Eigen::VectorXd columns = Eigen::VectorXd::Ones(matrix.cols());
  for (int pass = 0; pass < 12; ++pass) {
    const Eigen::VectorXd row = matrix.rowwise().lpNorm<Eigen::Infinity>();
    const Eigen::VectorXd column = matrix.colwise().lpNorm<Eigen::Infinity>().transpose();
    const double largest = row.maxCoeff();
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
      if (row[i] > rounding_only * largest) {
        matrix.row(i) /= std::sqrt(row[i]);
        right[i] /= std::sqrt(row[i]);
      }
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
      if (column[j] > rounding_only * largest) {
        matrix.col(j) /= std::sqrt(column[j]);
        columns[j] /= std::sqrt(column[j]);
      }
  }
  return columns;
}

namespace {

constexpr double clear_zero = 1e-9;  // relative bound of values that a rank leaves out
constexpr double consistent = 1e-9;  // equilibrated residual of the derivatives
constexpr double solved = 1e-13;
constexpr int most_corrections = 30;
constexpr double of_corrections = 1e-8;  // relative singular values for corrections

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// The array at one curve: y_0 … y_(jet_order), one column each.
class Array {
 public:
  Array(const CurveSystem& system, double t, const Vector& y, const Vector& ydot, double time_scale)
      : system_(system),
        t_(t),
        time_(time_scale),
        curve_(Matrix::Zero(system.size, jet_order + 1)) {
    curve_.col(0) = y;
    curve_.col(1) = ydot;
  }

  /// Corrects y_1 … y_(ν+1) until F_0 … F_ν vanish, and decides the two ranks there.
  ArrayLevel level(int nu) {
    const int n = system_.size, rows = (nu + 1) * n;
    ArrayLevel found;
    found.differentiations = nu;
    found.equations = rows;
    double before = std::numeric_limits<double>::infinity();
    SingularValues svd;
    for (int correction = 0;; ++correction) {
      blocks_.emplace(system_, t_, curve_);
      Matrix g = jacobian(nu);
      Vector f(rows);
      for (int i = 0; i <= nu; ++i) f.segment(i * n, n) = blocks_->f.col(i) * std::pow(time_, i);
      if (!g.allFinite() || !f.allFinite()) {
        found.residual = std::numeric_limits<double>::infinity();
        return found;
      }
      const Vector columns = equilibrate(g, f);
      Vector size(rows);
      for (int j = 1; j <= nu + 1; ++j)
        size.segment((j - 1) * n, n) = curve_.col(j) * std::pow(time_, j);
      size.array() /= columns.array();
      found.residual = f.cwiseAbs().maxCoeff() / (1 + size.cwiseAbs().maxCoeff());
      svd = SingularValues(g);
      // Solved, or no longer falling.
      if (found.residual <= solved || correction == most_corrections ||
          (found.residual < consistent && found.residual > 0.5 * before))
        break;
      before = found.residual;
      const Vector delta = svd.solve(-f, svd.rank(of_corrections)).cwiseProduct(columns);
      for (int j = 1; j <= nu + 1; ++j)
        curve_.col(j) += delta.segment((j - 1) * n, n) / std::pow(time_, j);
    }
    decide(svd, found);
    return found;
  }

  /// Whether F depends on y'_i: column i of B_0 ≠ 0. After level().
  std::vector<bool> appears() const {
    std::vector<bool> there;
    for (const auto& column : blocks_->b[0].colwise()) there.push_back(column.any());
    return there;
  }
  /// y' of the last level().
  Vector rate() const { return curve_.col(1); }

 private:
  /// G_ν with time in units of the time scale.
  Matrix jacobian(int nu) const {
    const int n = system_.size;
    Matrix g = Matrix::Zero((nu + 1) * n, (nu + 1) * n);
    for (int i = 0; i <= nu; ++i)
      for (int j = 1; j <= i + 1; ++j)
        g.block(i * n, (j - 1) * n, n, n) = blocks_->by(i, j) * std::pow(time_, i - j);
    return g;
  }

  /// The kernel's part in y_1: K its orthonormal basis, K_1 the first N rows. rank K_1 directions
  /// of y' are free, and y'_i is free where row i of K_1 is not zero.
  void decide(const SingularValues& svd, ArrayLevel& found) const {
    const int n = system_.size;
    const RankFound whole = rank_by_gap(svd.values, svd.values[0]);
    found.rank = whole.rank;
    found.constraints = found.equations - whole.rank;
    found.gap = whole.dropped <= clear_zero ? whole.gap() : 1;
    found.determined.assign(static_cast<std::size_t>(n), true);
    if (found.constraints == 0) return;
    const Matrix first = svd.v.topRightCorner(n, found.constraints);
    const RankFound free = rank_by_gap(SingularValues(first).values, 1.0);
    found.undetermined = free.rank;
    const double middle = std::sqrt(free.kept * free.dropped);
    found.gap = std::min(found.gap, free.gap());
    for (int i = 0; i < n; ++i)
      found.determined[static_cast<std::size_t>(i)] = !(first.row(i).norm() > middle);
  }

  const CurveSystem& system_;
  double t_, time_;
  Matrix curve_;
  std::optional<CurveBlocks> blocks_;
};

std::string text(const char* format, double x) {
  char buffer[96];
  std::snprintf(buffer, sizeof buffer, format, x);
  return buffer;
}

}  // namespace

RankFound rank_by_gap(const Eigen::VectorXd& values, double largest) {
  RankFound found;
  const double floor = 64 * std::numeric_limits<double>::epsilon() *
                       static_cast<double>(std::max<Eigen::Index>(values.size(), 1));
  const auto value = [&](Eigen::Index i) {
    return i < values.size() && largest > 0 ? std::max(values[i] / largest, floor) : floor;
  };
  // Rank zero: all values are rounding.
  found.kept = 1;
  found.dropped = value(0);
  for (Eigen::Index i = 0; i < values.size(); ++i)
    if (value(i) / value(i + 1) > found.gap()) {
      found.rank = static_cast<int>(i) + 1;
      found.kept = value(i);
      found.dropped = value(i + 1);
    }
  return found;
}

IndexFound find_index(const CurveSystem& system, double t, const Eigen::VectorXd& y,
                      const Eigen::VectorXd& ydot, double time_scale, int most) {
  IndexFound found;
  if (system.size == 0) {
    found.index = 0;
    found.decided = true;
    return found;
  }
  Array array(system, t, y, ydot, time_scale);
  for (int nu = 0; nu <= std::min(most, most_differentiations); ++nu) {
    found.levels.push_back(array.level(nu));
    const ArrayLevel& level = found.levels.back();
    found.ydot = array.rate();
    if (nu == 0) found.appears = array.appears();
    const std::string after = " after " + std::to_string(nu) + " differentiations";
    if (!(level.residual <= consistent)) {
      found.why = "no derivatives that meet the equations were found" + after +
                  text(": residual %.2g", level.residual);
      return found;
    }
    if (level.gap < least_gap) {
      found.why = "not decided: the gap between what counts and what does not is" +
                  text(" %.2g", level.gap) + after;
      return found;
    }
    if (level.undetermined == 0) {
      found.index = nu;
      found.decided = true;
      return found;
    }
  }
  const ArrayLevel& last = found.levels.back();
  found.decided = true;
  found.why = std::to_string(last.undetermined) + " direction" +
              (last.undetermined == 1 ? "" : "s") + " of y' not determined by the " +
              std::to_string(last.differentiations) + " differentiations that are tried at most";
  return found;
}

}  // namespace momenta
