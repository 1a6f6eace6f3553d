#include <momenta/dae/analysis/kinematics/held_coordinate.h>
#include <momenta/dae/analysis/kinematics/move_rows.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

namespace momenta {

MoveRows::MoveRows(const Mechanism& mechanism, double t, const MoveRequest& request,
                   const std::vector<int>& inputs, const std::vector<HeldCoordinate>& held,
                   double unit, MoveResult& result)
    : request_(request), t_(t), unit_(unit), result_(result) {
  result_.scene = mechanism.scene().name;
  result_.coordinates = mechanism.coordinate_columns();
  result_.rates = mechanism.rate_columns();
  result_.markers = mechanism.marker_columns();
  if (request.output.empty()) return;
  transmission_ = std::make_unique<Transmission>(mechanism, t, request.output, inputs, held);
  extremes_ = std::make_unique<PassedExtremes>(*transmission_, unit, result.passed);
  std::tie(result_.output, result_.output_rate) = coordinate_named(mechanism, request.output);
}

void MoveRows::take_markers(Evaluation<double>& e, MovedPose& pose) const {
  const std::size_t markers = result_.markers.size();
  if (markers == 0) return;
  pose.markers.resize(markers);
  e.place(t_, pose.q.data());
  e.move(pose.u.size() > 0 ? pose.u.data() : nullptr);
  e.markers(pose.markers.data());
  if (pose.u.size() == 0)
    for (std::size_t i = 0; i < markers; ++i)
      if (i % 6 >= 3) pose.markers[i] = NAN;
}

void MoveRows::take(PoseCurve& curve, const CurvePoint& at, MovedPose::Kind kind) {
  MovedPose pose;
  pose.kind = kind;
  pose.s = unit_ * at.s;
  pose.q = at.q;
  if (kind == MovedPose::Kind::sample && curve.derivatives(at, pose.u, pose.udot)) {
    pose.u /= unit_;
    pose.udot /= unit_ * unit_;
  } else {
    pose.u.resize(0);
    pose.udot.resize(0);
  }
  pose.branch = pose.u.size() > 0 ? at.branch() : 0;
  take_markers(curve.loops().evaluation(), pose);
  if (transmission_) {
    const Transmitting passed =
        kind == MovedPose::Kind::change_point
            ? transmission_->at(at.q)
            : extremes_->pass(curve, at, kind == MovedPose::Kind::dead_point);
    pose.transmission_angle = passed.angle;
    pose.joint_force = passed.joint_force;
  }
  if (request_.singular_values) pose.reciprocal_condition = curve.reciprocal_condition(at.q);
  auto place = result_.poses.end();
  if (kind == MovedPose::Kind::change_point)
    while (place != result_.poses.begin() && std::prev(place)->kind == MovedPose::Kind::sample &&
           (std::prev(place)->s - pose.s) * at.s_rate() > 0)
      --place;
  result_.poses.insert(place, std::move(pose));
}

void MoveRows::pass(PoseCurve& curve, const CurvePoint& at) {
  if (extremes_) extremes_->pass(curve, at, false);
}

const char* name_of(MovedPose::Kind kind) {
  return kind == MovedPose::Kind::sample       ? "sample"
         : kind == MovedPose::Kind::dead_point ? "dead point"
                                               : "change point";
}

const char* name_of(MoveResult::End end) {
  return end == MoveResult::End::closed    ? "closed"
         : end == MoveResult::End::reached ? "reached"
                                           : "stopped";
}

int MoveResult::count(MovedPose::Kind kind) const {
  return static_cast<int>(std::count_if(poses.begin(), poses.end(),
                                        [&](const MovedPose& pose) { return pose.kind == kind; }));
}

}  // namespace momenta
