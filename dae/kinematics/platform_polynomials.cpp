#include <momenta/dae/kinematics/platform_legs.h>
#include <momenta/dae/kinematics/platform_polynomials.h>

#include <cmath>

namespace momenta {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector4d;
using Eigen::VectorXcd;
using Eigen::VectorXd;

/// v e as a matrix on e = (w, x, y, z).
Matrix4d from_left(const Vector3d& v) {
  Matrix4d m;
  m << 0, -v.x(), -v.y(), -v.z(),  //
      v.x(), 0, -v.z(), v.y(),     //
      v.y(), v.z(), 0, -v.x(),     //
      v.z(), -v.y(), v.x(), 0;
  return m;
}
/// e v
Matrix4d from_right(const Vector3d& v) {
  Matrix4d m;
  m << 0, -v.x(), -v.y(), -v.z(),  //
      v.x(), 0, v.z(), -v.y(),     //
      v.y(), -v.z(), 0, v.x(),     //
      v.z(), v.y(), -v.x(), 0;
  return m;
}

class Platform final : public LoopPolynomials {
 public:
  Platform(const Mechanism& mechanism, double t, const VectorXd& own, const std::vector<bool>& held)
      : mechanism_(mechanism),
        own_(own),
        poses_(poses_of_polynomials(mechanism, t, own)),
        legs_(platform_legs(mechanism, t, poses_, held)),
        length_(length_of(mechanism.scene())) {
    std::vector<Polynomial> equations;
    Polynomial study;
    for (int i = 0; i < 4; ++i) study.push_back({1, {i, 4 + i}});
    equations.push_back(std::move(study));
    for (const PlatformRod& leg : legs_.rods) {
      const Vector3d p = leg.on_platform / length_, b = leg.on_base / length_;
      const double rest = p.squaredNorm() + b.squaredNorm() - (p - b).squaredNorm();
      const Matrix4d mixed = 4 * (from_right(p) - from_left(b)),
                     turned = -2 * from_left(b).transpose() * from_right(p) +
                              rest * Matrix4d::Identity();
      Polynomial rod;
      for (int i = 0; i < 4; ++i) {
        rod.push_back({4, {4 + i, 4 + i}});
        for (int j = 0; j < 4; ++j) {
          rod.push_back({mixed(i, j), {4 + i, j}});
          rod.push_back({turned(i, j), {i, j}});
        }
      }
      equations.push_back(std::move(rod));
    }
    system_.emplace(std::move(equations),
                    std::vector<VariableGroup>{{{0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 3}}});
  }

  const PolynomialSystem& system() const override { return *system_; }

  std::optional<VectorXd> pose(const VectorXcd& x) const override {
    Eigen::Index largest;
    x.head<4>().cwiseAbs().maxCoeff(&largest);
    const VectorXcd turned = x / x[largest];
    if (turned.imag().norm() > real_enough * turned.norm()) return std::nullopt;
    const Vector4d e = turned.real().head<4>(), g = turned.real().tail<4>();
    const Quaterniond rotation(e[0], e[1], e[2], e[3]), dual(g[0], g[1], g[2], g[3]);
    Isometry3d displacement = Isometry3d::Identity();
    displacement.translate(2 * length_ / e.squaredNorm() * (dual * rotation.conjugate()).vec());
    displacement.rotate(rotation.normalized());
    return with_platform(displacement);
  }

 private:
  /// The pose with the platform displaced from the own one, where the legs can follow.
  std::optional<VectorXd> with_platform(const Isometry3d& displacement) const {
    std::vector<Isometry3d> displaced(poses_.size() + 1, Isometry3d::Identity());
    displaced[static_cast<std::size_t>(legs_.platform)] = displacement;
    for (const PlatformRod& rod : legs_.rods) {
      if (rod.leg < 0) continue;
      const std::optional<Isometry3d> leg = rod.displaced(displacement);
      if (!leg) return std::nullopt;
      displaced[static_cast<std::size_t>(rod.leg)] = *leg;
    }
    VectorXd q = own_;
    const Tree& tree = mechanism_.tree();
    for (const JointSpec& joint : mechanism_.scene().joints) {
      const int child = tree.body(joint.child), first = tree.first_part(child),
                parent = tree.bodies[static_cast<std::size_t>(first)].parent;
      if (legs_.pieces.of(parent) == legs_.pieces.of(child)) continue;
      const auto now = [&](int body) {
        const Isometry3d before =
            body < 0 ? Isometry3d::Identity() : poses_[static_cast<std::size_t>(body)];
        return Isometry3d(displaced[static_cast<std::size_t>(legs_.pieces.of(body))] * before);
      };
      take_coordinates(first, child, now(parent).inverse() * now(child), q);
    }
    return q;
  }

  /// Those of a free, spherical or universal joint whose child stands so beside its parent.
  void take_coordinates(int first, int last, const Isometry3d& child, VectorXd& q) const {
    const Tree::Body& outer = mechanism_.tree().bodies[static_cast<std::size_t>(first)];
    const Isometry3d in_joint = outer.placement.inverse() * child;
    if (first == last) {
      const Quaterniond rotation(in_joint.linear());
      if (outer.kind == JointKind::free) q.segment<3>(outer.q) = in_joint.translation();
      q.segment<4>(outer.q + outer.nq - 4) << rotation.w(), rotation.vec();
      return;
    }
    // R_z(q₁) P R_z(q₂), and so R_z(q₁) P z is where it turns z to.
    const Tree::Body& inner = mechanism_.tree().bodies[static_cast<std::size_t>(last)];
    const Matrix3d p = inner.placement.linear(), r = in_joint.linear();
    const double q1 = std::atan2(r(1, 2), r(0, 2)) - std::atan2(p(1, 2), p(0, 2));
    const Matrix3d rest = p.transpose() * AngleAxisd(-q1, Vector3d::UnitZ()) * r;
    q[outer.q] = q1;
    q[inner.q] = std::atan2(rest(1, 0), rest(0, 0));
  }

  const Mechanism& mechanism_;
  VectorXd own_;
  std::vector<Isometry3d> poses_;
  PlatformLegs legs_;
  double length_;
  std::optional<PolynomialSystem> system_;
};

}  // namespace

std::unique_ptr<LoopPolynomials> platform_polynomials(const Mechanism& mechanism, double t,
                                                      const VectorXd& own,
                                                      const std::vector<bool>& held) {
  return std::make_unique<Platform>(mechanism, t, own, held);
}

}  // namespace momenta
