#pragma once
// The poses of a mechanism with one freedom where its swept coordinate c stands at given places s:
// from the assembled start along the curve of poses (dae/kinematics/pose_curve.h), so all of them
// are of the assembly of the start, up to dead points, beyond which none of it has such an s.

#include <momenta/dae/kinematics/pose_curve.h>

#include <string>
#include <vector>

namespace momenta {

class SweptPoses {
 public:
  /// Assembles the mechanism, which must outlive it. @throws SceneError where it cannot be
  /// assembled, where `sweep` is not known or cannot move, where freedoms are left
  SweptPoses(const Mechanism& mechanism, const std::string& sweep);

  /// Where c stands at the start [rad or m].
  double start() const { return start_; }
  /// Place of c in u.
  int rate() const { return rate_; }
  /// q (nq) for each of these places [rad or m]; false where one is not reached: why() says which.
  /// Cost: a dense factorisation of nv + 1 for each tenth of a radian on the way
  bool reach(const std::vector<double>& places, std::vector<Eigen::VectorXd>& q);
  /// The same, with tangents.
  bool reach(const std::vector<double>& places, std::vector<CurvePoint>& points);
  /// u and u̇ (nv) there while c has this rate [rad/s or m/s] and no acceleration; false at a dead
  /// point: why() says so.
  bool rates(const CurvePoint& at, double rate, Eigen::VectorXd& u, Eigen::VectorXd& udot);
  /// What can be reached: places `by` apart, at most half a turn of an angle to each side of the
  /// start, at most `most` of them, ascending, and their poses.
  void sample(double by, int most, std::vector<double>& places, std::vector<Eigen::VectorXd>& q);
  /// In one sentence, without its full stop.
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
