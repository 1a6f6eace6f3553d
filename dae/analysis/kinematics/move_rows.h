#pragma once
// The rows of a move, made from points of the curve of poses.

#include <momenta/dae/analysis/kinematics/move.h>
#include <momenta/dae/analysis/kinematics/passed_extremes.h>
#include <momenta/dae/analysis/kinematics/pose_curve.h>
#include <momenta/dae/analysis/kinematics/transmission.h>

#include <memory>
#include <vector>

namespace momenta {

class MoveRows {
 public:
  /// Names the columns of `result`. @param inputs swept rates
  /// @param unit of s on the curve [rad or m]
  /// @throws SceneError for an unknown output
  MoveRows(const Mechanism& mechanism, double t, const MoveRequest& request,
           const std::vector<int>& inputs, const std::vector<HeldCoordinate>& held, double unit,
           MoveResult& result);
  /// Appends a row; a change point, found from beyond it, at its place.
  void take(PoseCurve& curve, const CurvePoint& at, MovedPose::Kind kind);
  /// Takes a point without a row.
  void pass(PoseCurve& curve, const CurvePoint& at);

 private:
  void take_markers(Evaluation<double>& e, MovedPose& pose) const;

  const MoveRequest& request_;
  double t_;                                    ///< [s]
  double unit_;                                 ///< pose.s = unit_ s
  std::unique_ptr<Transmission> transmission_;  ///< null: no output
  std::unique_ptr<PassedExtremes> extremes_;    ///< null: no output
  MoveResult& result_;
};

}  // namespace momenta
