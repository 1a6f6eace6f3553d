#pragma once
// The rows of a move: points of the curve of poses as what is told of them.

#include <momenta/dae/kinematics/move.h>
#include <momenta/dae/kinematics/passed_extremes.h>
#include <momenta/dae/kinematics/pose_curve.h>
#include <momenta/dae/kinematics/transmission.h>

#include <memory>
#include <vector>

namespace momenta {

class MoveRows {
 public:
  /// Names the columns of `result`. @param inputs rates that are swept
  /// @param unit of s on the curve [rad or m]
  /// @throws SceneError where the output is not known
  MoveRows(const Mechanism& mechanism, double t, const MoveRequest& request,
           const std::vector<int>& inputs, const std::vector<HeldCoordinate>& held, double unit,
           MoveResult& result);
  /// A point becomes a row, behind the others; a change point, which is found when the curve is
  /// beyond it, where it was passed.
  void take(PoseCurve& curve, const CurvePoint& at, MovedPose::Kind kind);
  /// A point of the curve that is no row.
  void pass(PoseCurve& curve, const CurvePoint& at);

 private:
  void take_markers(Evaluation<double>& e, MovedPose& pose) const;

  const MoveRequest& request_;
  double t_;                                    ///< [s]
  double unit_;                                 ///< pose.s = unit_ s
  std::unique_ptr<Transmission> transmission_;  ///< null: no output is asked for
  std::unique_ptr<PassedExtremes> extremes_;    ///< the same
  MoveResult& result_;
};

}  // namespace momenta
