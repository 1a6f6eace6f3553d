#pragma once
// How far a mechanism is from what is wanted of it, as residuals of a least-squares problem:
//
//   r_ik = (y_k(q(θ, s_i), θ) − y*_ik) / w_k
//
// for each pose i and quantity k that the file asks for. w_k is a radian for angles; for lengths it
// is the extent of what is wanted, the diagonal of the box about all wanted positions, so that
// angles and lengths count alike and units do not matter. Where the file says where the swept
// coordinate stands, s_i is given; else s_i are unknowns beside θ: x = (θ, s₁, …, s_n), and the
// path counts, not when it is passed.

#include <momenta/dae/study/fit/pose_derivatives.h>
#include <momenta/dae/study/fit/swept_poses.h>

#include <limits>
#include <string>

namespace momenta {

class WantedError {
 public:
  /// `sizes` as in PoseDerivatives. The family must outlive it.
  WantedError(const ParametricMechanism& family, std::string sweep, WantedPoses wanted,
              Eigen::VectorXd sizes);

  const WantedPoses& wanted() const { return wanted_; }
  int parameters() const { return static_cast<int>(family_.names().size()); }
  bool free() const { return wanted_.swept.empty(); }  ///< whether s_i are unknowns
  int unknowns() const { return parameters() + (free() ? static_cast<int>(wanted_.poses()) : 0); }
  int residuals() const { return static_cast<int>(asked_.size()); }

  /// x at these parameters, with unknown s_i at the nearest of 360 places of the path. False
  /// without a mechanism or finite path: why() says why.
  bool start(const Eigen::VectorXd& parameters, Eigen::VectorXd& x);
  /// r, and ∂r/∂x unless null. False where the mechanism cannot be assembled, a pose is not reached
  /// or has no derivatives: why() says which.
  bool evaluate(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian);
  /// y (poses × quantities) [rad or m] of the last success.
  const Eigen::MatrixXd& reached() const { return reached_; }
  const std::string& why() const { return why_; }  ///< a sentence without full stop

 private:
  struct WantedValue {
    Eigen::Index pose = 0, quantity = 0;
  };
  std::vector<double> places(const Eigen::VectorXd& x) const;
  double weight(Eigen::Index quantity) const;

  const ParametricMechanism& family_;
  std::string sweep_;
  WantedPoses wanted_;
  PoseDerivatives derivatives_;
  std::vector<WantedValue> asked_;
  double extent_ = 1;  ///< [m]
  Eigen::MatrixXd reached_;
  std::string why_;
};

/// Sizes of residuals.
struct WantedErrors {
  /// Not measured.
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double cost = none;         ///< ½ |r|² [1]
  double length_rms = none;   ///< over all wanted lengths [m]; NaN: there are none
  double length_most = none;  ///< the largest [m]
  double angle_rms = none;    ///< the same for angles [rad]
  double angle_most = none;   ///< the largest [rad]
};

/// Errors of the reached poses (poses × quantities), with their r.
WantedErrors errors_of(const WantedPoses& wanted, const Eigen::MatrixXd& reached,
                       const Eigen::VectorXd& r);

}  // namespace momenta
