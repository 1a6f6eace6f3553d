#include <momenta/dae/analysis/kinematics/turns.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace momenta {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double within_rounding = 1e-9;  // tolerance of squared lengths, relative to that of v

/// Angle from u to v about an axis.
double angle_about(const Vector3d& axis, const Vector3d& u, const Vector3d& v) {
  return std::atan2(axis.dot(u.cross(v)), u.dot(v) - axis.dot(u) * axis.dot(v));
}

/// α and β of both solutions, if any.
std::vector<std::array<double, 2>> both_pairs(const Vector3d& a, const Vector3d& b,
                                              const Vector3d& v, const Vector3d& to) {
  const double c = a.dot(b), across = 1 - c * c, on_a = to.dot(a), on_b = v.dot(b),
               x = (on_a - c * on_b) / across, y = (on_b - c * on_a) / across,
               left = v.squaredNorm() - x * x - y * y - 2 * c * x * y;
  if (left < -within_rounding * v.squaredNorm()) return {};
  const double z = std::sqrt(std::max(left, 0.0) / across);
  std::vector<std::array<double, 2>> pairs;
  for (const double side : {z, -z}) {
    const Vector3d w = x * a + y * b + side * a.cross(b);
    pairs.push_back({angle_about(a, w, to), angle_about(b, v, w)});
  }
  return pairs;
}

}  // namespace

std::optional<std::vector<Quaterniond>> turns_that_take(const Vector3d& a, const Vector3d& b,
                                                        const Vector3d& v, const Vector3d& to) {
  std::optional<std::vector<Quaterniond>> found;
  double least = 0;
  for (const auto& [alpha, beta] : both_pairs(a, b, v, to)) {
    const double size = std::abs(alpha) + std::abs(beta);
    if (found && size >= least) continue;
    found = {Quaterniond(AngleAxisd(alpha, a)), Quaterniond(AngleAxisd(beta, b))};
    least = size;
  }
  return found;
}

std::optional<std::vector<Quaterniond>> turns_that_make(const Vector3d& a, const Vector3d& b,
                                                        const Vector3d& c, const Quaterniond& q) {
  std::optional<std::vector<Quaterniond>> found;
  double least = 0;
  const Vector3d across = b.cross(c).normalized();
  for (const auto& [alpha, beta] : both_pairs(a, b, c, q * c)) {
    const Quaterniond outer(AngleAxisd(alpha, a)), middle(AngleAxisd(beta, b));
    const double gamma = angle_about(c, across, (outer * middle).conjugate() * (q * across)),
                 size = std::abs(alpha) + std::abs(beta) + std::abs(gamma);
    if (found && size >= least) continue;
    found = {outer, middle, Quaterniond(AngleAxisd(gamma, c))};
    least = size;
  }
  return found;
}

}  // namespace momenta
