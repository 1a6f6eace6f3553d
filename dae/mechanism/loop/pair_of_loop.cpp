#include <momenta/dae/mechanism/loop/loop_choice.h>
#include <momenta/dae/mechanism/loop/pair_of_loop.h>

namespace momenta {
namespace {

/// A curve as a polyline in axes e₁, e₂ of the plane.
DrawnCurves::Polyline drawn(const PlaneCurve& curve, double reach) {
  DrawnCurves::Polyline line;
  line.closed = curve.period() > 0;
  const auto add = [&](double s) {
    const auto p = curve.at(s).p;
    line.points.emplace_back(p[0], p[1], 0);
  };
  for (const double s : curve.samples()) add(s);
  if (curve.is_straight())
    for (const double s : {-reach, reach}) add(s);
  return line;
}

DrawnCurves::Polyline placed(DrawnCurves::Polyline line, const Eigen::Matrix3d& axes,
                             const Eigen::Vector3d& origin) {
  for (Eigen::Vector3d& p : line.points) p = origin + axes * p;
  return line;
}

}  // namespace

HigherPair pair_of(const LoopSpec& loop) {
  const Eigen::Matrix3d frame = frame_across(loop);
  const auto curve = [&](const CurveSpec& spec) {
    return PlaneCurve(spec, frame.col(0), frame.col(1));
  };
  HigherPair pair;
  if (loop.kind == LoopKind::rack) {
    pair.kind = HigherPair::Kind::rolling;
    pair.radius = loop.radius;
    pair.offset = loop.offset;
  } else if (loop.kind == LoopKind::cam) {
    pair.kind = HigherPair::Kind::contact;
    pair.of_a = curve(loop.child_curve);
    pair.of_b = curve(loop.curve);
  } else if (loop.curve.kind == "circle") {
    pair.radius = loop.curve.radius;
  } else {
    pair.kind = HigherPair::Kind::curve;
    pair.of_b = curve(loop.curve);
  }
  return pair;
}

DrawnCurves drawn_curves(const LoopSpec& loop, double reach) {
  const Eigen::Matrix3d frame = frame_across(loop);
  const Eigen::Matrix3d in_parent = loop.rotation.toRotationMatrix() * frame;
  const auto curve = [&](const CurveSpec& spec) {
    return drawn(PlaneCurve(spec, frame.col(0), frame.col(1)), reach);
  };
  DrawnCurves all;
  if (loop.kind == LoopKind::slot && loop.curve.kind.empty()) {
    const Eigen::Vector3d way = reach * (loop.rotation * loop.axis.normalized());
    all.of_parent.points = {loop.origin_parent - way, loop.origin_parent + way};
    return all;
  }
  if (loop.kind == LoopKind::rack) {
    CurveSpec pinion;
    pinion.kind = "circle";
    pinion.radius = loop.radius;
    all.of_parent = drawn(PlaneCurve(), reach);
    all.of_child = curve(pinion);
  } else {
    all.of_parent = curve(loop.curve);
    if (loop.kind == LoopKind::cam) all.of_child = curve(loop.child_curve);
  }
  all.of_parent = placed(std::move(all.of_parent), in_parent, loop.origin_parent);
  all.of_child = placed(std::move(all.of_child), frame, loop.origin_child);
  return all;
}

}  // namespace momenta
