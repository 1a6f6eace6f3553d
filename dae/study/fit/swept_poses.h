#pragma once
// The poses of a mechanism with one freedom where its swept coordinate c stands at given places s:
// from the assembled start along the curve of poses (dae/analysis/kinematics/pose_curve.h), so all
// of them are of the assembly of the start, up to dead points, beyond which none of it has such an
// s.

#include <momenta/dae/analysis/kinematics/pose_curve.h>

#include <string>
#include <vector>

namespace momenta {

class SweptPoses {
 public:
  /// Assembles the mechanism, which must outlive it. @throws SceneError where it cannot be
  /// assembled, `sweep` is unknown or cannot move, or freedoms are left
  SweptPoses(const Mechanism& mechanism, const std::string& sweep);

  /// c at the start [rad or m].
  double start() const { return start_; }
  /// Place of c in u.
  int rate() const { return rate_; }
  /// q (nq) at each place [rad or m]; false where one is not reached: why() says which.
  /// Cost: a dense factorisation of nv + 1 for each tenth of a radian on the way
  bool reach(const std::vector<double>& places, std::vector<Eigen::VectorXd>& q);
  /// The same, with tangents.
  bool reach(const std::vector<double>& places, std::vector<CurvePoint>& points);
  /// u and u̇ (nv) at `at` while c has this rate [rad/s or m/s] and no acceleration; false at a
  /// dead point: why() says so.
  bool rates(const CurvePoint& at, double rate, Eigen::VectorXd& u, Eigen::VectorXd& udot);
  /// Reachable places, ascending, and their poses: `by` apart, at most `most` beside the start, of
  /// an angle within half a turn of it.
  void sample(double by, int most, std::vector<double>& places, std::vector<Eigen::VectorXd>& q);
  /// A sentence without full stop.
  const std::string& why() const { return why_; }

  /// Unit in which steps along c are counted [rad or m].
  double unit() const { return unit_; }
  bool is_angle() const { return angle_; }

 private:
  bool walk(CurvePoint& here, double s);
  const Mechanism& mechanism_;
  std::string name_;
  int coordinate_ = 0, rate_ = 0;
  bool angle_ = false;
  double unit_ = 1, start_ = 0;
  std::unique_ptr<PoseCurve> curve_;
  CurvePoint beginning_;
  std::string why_;
};

}  // namespace momenta
