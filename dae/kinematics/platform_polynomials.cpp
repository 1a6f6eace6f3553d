#include <momenta/dae/kinematics/dual_quaternion.h>
#include <momenta/dae/kinematics/platform_legs.h>
#include <momenta/dae/kinematics/platform_polynomials.h>

namespace momenta {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix4d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector4d;
using Eigen::VectorXcd;
using Eigen::VectorXd;

class Platform final : public LoopPolynomials {
 public:
  Platform(const Mechanism& mechanism, double t, const VectorXd& own, const std::vector<bool>& held)
      : own_(own),
        poses_(poses_of_polynomials(mechanism, t, own)),
        pieces_(mechanism, t, poses_, held),
        legs_(platform_legs(mechanism, pieces_)),
        length_(length_of(mechanism.scene())) {
    std::vector<Polynomial> equations;
    Polynomial study;
    for (int i = 0; i < 4; ++i) study.push_back({1, {i, 4 + i}});
    equations.push_back(std::move(study));
    for (const PlatformRod& leg : legs_.rods) {
      const Vector3d p = leg.on_platform() / length_, b = leg.on_base() / length_;
      const double rest = p.squaredNorm() + b.squaredNorm() - (p - b).squaredNorm();
      const Matrix4d mixed = 4 * (times_from_right(pure(p)) - times_from_left(pure(b))),
                     turned =
                         -2 * times_from_left(pure(b)).transpose() * times_from_right(pure(p)) +
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
                    std::vector<VariableGroup>{{{0, 1, 2, 3, 4, 5, 6, 7}, {{0, 1, 2, 3}}}});
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
  /// The pose with the platform displaced, where the legs can follow.
  std::optional<VectorXd> with_platform(const Isometry3d& displacement) const {
    std::vector<Isometry3d> displaced(static_cast<std::size_t>(pieces_.count()),
                                      Isometry3d::Identity());
    displaced[static_cast<std::size_t>(legs_.platform)] = displacement;
    for (const PlatformRod& rod : legs_.rods) {
      const auto leg = rod.displaced(displacement);
      if (!leg) return std::nullopt;
      for (std::size_t k = 0; k < leg->size(); ++k)
        displaced[static_cast<std::size_t>(rod.chain().pieces[k])] = (*leg)[k];
    }
    return pieces_.coordinates(displaced, own_);
  }

  VectorXd own_;
  std::vector<Isometry3d> poses_;
  Pieces pieces_;
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
