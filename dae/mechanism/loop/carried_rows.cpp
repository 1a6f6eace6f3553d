#include <momenta/dae/mechanism/loop/carried_rows.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace momenta {
namespace {

constexpr double angle_tolerance = 1e-12;  // between axes parallel by construction [rad]

bool parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.cross(b).norm() < angle_tolerance;
}

/// Directions in ground axes at zero positions: parallels on a planar cycle there are so always.
class ZeroPoses {
 public:
  ZeroPoses(const Tree& tree, const Model<Spatial>& model)
      : tree_(tree), poses_(tree.zero_poses()) {
    from_model_.reserve(poses_.size());
    for (std::size_t k = 0; k < poses_.size(); ++k)
      from_model_.push_back(poses_[k].linear() * model.frames[k].linear().transpose());
  }
  /// A direction from the model's axes of a body to ground axes.
  Eigen::Vector3d direction(int body, const Vec3<double>& v) const {
    const Eigen::Vector3d own(v[0], v[1], v[2]);
    return body < 0 ? own : Eigen::Vector3d(from_model_[static_cast<std::size_t>(body)] * own);
  }
  /// The inverse of direction().
  Eigen::Vector3d in_model(int body, const Eigen::Vector3d& v) const {
    return body < 0 ? v
                    : Eigen::Vector3d(from_model_[static_cast<std::size_t>(body)].transpose() * v);
  }

  /// n of the cycle of bodies a and b (−1: ground); none where it is not planar.
  std::optional<Eigen::Vector3d> normal(int a, int b) const {
    std::vector<Eigen::Vector3d> turning, sliding;
    while (a != b) {
      int& later = a > b ? a : b;
      const Tree::Body& body = tree_.bodies[static_cast<std::size_t>(later)];
      const Eigen::Vector3d axis = poses_[static_cast<std::size_t>(later)].linear().col(2);
      if (body.kind == JointKind::revolute)
        turning.push_back(axis);
      else if (body.kind == JointKind::prismatic)
        sliding.push_back(axis);
      else if (body.kind != JointKind::weld)
        return {};
      later = body.parent;
    }
    if (turning.empty()) return {};
    const Eigen::Vector3d& n = turning.front();
    for (const Eigen::Vector3d& axis : turning)
      if (!parallel(axis, n)) return {};
    for (const Eigen::Vector3d& axis : sliding)
      if (!(std::abs(axis.dot(n)) < angle_tolerance)) return {};
    return n;
  }

 private:
  const Tree& tree_;
  std::vector<Eigen::Isometry3d> poses_;
  std::vector<Eigen::Matrix3d> from_model_;
};

/// b_j of the i-th row of points.
Vec3<double>& axis_of_row(LoopModel<Spatial>::Loop& l, int i) {
  return l.axis_b[static_cast<std::size_t>(l.points[static_cast<std::size_t>(i)])];
}

/// The b'_i (rows) from the b_j; b'_k is n.
Eigen::Matrix3d axes_with(const Eigen::Matrix3d& b, const Eigen::Vector3d& n, Eigen::Index k) {
  const Eigen::Index i = (k + 1) % 3, j = (k + 2) % 3;
  const Eigen::Vector3d first = b.row(j).transpose().cross(n).normalized();
  Eigen::Matrix3d axes;
  axes.row(k) = n;
  axes.row(i) = first;
  axes.row(j) = n.cross(first);
  return axes;
}

}  // namespace

CarriedRows::CarriedRows() = default;
CarriedRows::CarriedRows(const CarriedRows&) = default;
CarriedRows& CarriedRows::operator=(const CarriedRows&) = default;
CarriedRows::~CarriedRows() = default;

CarriedRows::CarriedRows(const Tree& tree, const Model<Spatial>& model, LoopModel<Spatial>& loops) {
  const ZeroPoses zero(tree, model);
  for (auto& l : loops.loops) {
    const int first = l.row, rows = l.rows;
    l.row = static_cast<int>(rows_.size());
    const auto keep = [&](int row) { rows_.push_back(first + row); };
    const auto normal =
        l.is_distance() || l.is_coupler() || l.is_pair() || l.is_wheel() || l.motion >= 0
            ? std::nullopt
            : zero.normal(l.a, l.b);
    const auto across = [&](int body, const Vec3<double>& axis) {
      return parallel(zero.direction(body, axis), *normal);
    };
    if (normal && l.n_points == 3 && l.n_axes == 0 &&
        std::none_of(l.axis_b.begin(), l.axis_b.end(),
                     [&](const Vec3<double>& axis) { return across(l.b, axis); })) {
      Eigen::Matrix3d b;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) b(i, j) = axis_of_row(l, i)[j];
      const Eigen::Vector3d n = zero.in_model(l.b, *normal);
      Eigen::Index nearest = 0;
      (b * n).cwiseAbs().maxCoeff(&nearest);
      const Eigen::Matrix3d axes = axes_with(b, n, nearest);
      for (int i = 0; i < 3; ++i) axis_of_row(l, i) = {{axes(i, 0), axes(i, 1), axes(i, 2)}};
      turned_.push_back({first, static_cast<int>(nearest), axes * b.transpose()});
    }
    auto kept = l;
    kept.n_points = kept.n_axes = 0;
    std::vector<int> kept_rows;
    for (int i = 0; normal && i < l.n_points; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (across(l.b, l.axis_b[static_cast<std::size_t>(l.points[at])])) continue;
      kept.points[static_cast<std::size_t>(kept.n_points++)] = l.points[at];
      kept_rows.push_back(i);
    }
    for (int i = 0; normal && i < l.n_axes; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const auto [x, y] = l.axes[at];
      if (across(l.a, l.axis_a[static_cast<std::size_t>(x)]) ||
          across(l.b, l.axis_b[static_cast<std::size_t>(y)]))
        continue;
      kept.axes[static_cast<std::size_t>(kept.n_axes++)] = l.axes[at];
      kept_rows.push_back(l.n_points + i);
    }
    if (kept_rows.empty()) {  // no planar cycle, or one that nothing holds
      for (int row = 0; row < rows; ++row) keep(row);
      continue;
    }
    kept.rows = static_cast<int>(kept_rows.size());
    l = kept;
    std::size_t next = 0;
    for (int row = 0; row < rows; ++row)
      if (next < kept_rows.size() && kept_rows[next] == row)
        keep(row), ++next;
      else
        left_out_.push_back(first + row);
  }
  loops.rows = static_cast<int>(rows_.size());
}

int CarriedRows::given(int carried) const {
  return all() ? carried : rows_[static_cast<std::size_t>(carried)];
}

void CarriedRows::to_given(double* sigma, std::ptrdiff_t stride, const double* centre) const {
  auto next = static_cast<std::ptrdiff_t>(rows_.size());
  // From the last on: a carried row moves to a later place, or stays.
  for (auto row = next + static_cast<std::ptrdiff_t>(left_out_.size()); row-- > 0;) {
    if (next > 0 && rows_[static_cast<std::size_t>(next - 1)] == row)
      sigma[row * stride] = sigma[--next * stride];
    else
      sigma[row * stride] = centre ? centre[row] : 0.0;
  }
  for (const Turned& turned : turned_) {
    Eigen::Map<Eigen::Vector3d, 0, Eigen::InnerStride<>> own(sigma + turned.first * stride,
                                                             Eigen::InnerStride<>(stride));
    if (centre)
      own[turned.nearest] =
          turned.R.row(turned.nearest) * Eigen::Map<const Eigen::Vector3d>(centre + turned.first);
    own = (turned.R.transpose() * own).eval();
  }
}

const double* CarriedRows::of_carried(const double* x) {
  numbers_.resize(rows_.size());
  for (std::size_t k = 0; k < rows_.size(); ++k) numbers_[k] = x[rows_[k]];
  return numbers_.data();
}

const double* CarriedRows::to_carried(const double* sigma) {
  impulses_.resize(rows_.size());
  std::size_t k = 0;
  for (; k < rows_.size(); ++k) impulses_[k] = sigma[rows_[k]];
  k = 0;
  for (const Turned& turned : turned_) {
    const Eigen::Vector3d own = turned.R * Eigen::Map<const Eigen::Vector3d>(sigma + turned.first);
    while (rows_[k] < turned.first) ++k;
    for (int i = 0; i < 3; ++i)
      if (i != turned.nearest) impulses_[k++] = own[i];
  }
  return impulses_.data();
}

}  // namespace momenta
