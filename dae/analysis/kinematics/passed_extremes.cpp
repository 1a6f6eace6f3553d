#include <momenta/dae/analysis/kinematics/passed_extremes.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace momenta {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

}  // namespace

Transmitting PassedExtremes::pass(PoseCurve& curve, const CurvePoint& at, bool is_dead_point) {
  Seen next{at, is_dead_point ? limit(curve, at) : transmission_.at(at.q)};
  widen(next.at, next.passed);
  if (before_ && last_ && !is_dead_point) locate(curve, next);
  before_ = std::exchange(last_, std::move(next));
  return last_->passed;
}

/// Limit at a dead point, by two poses beside it, one twice as far.
Transmitting PassedExtremes::limit(PoseCurve& curve, const CurvePoint& at) {
  constexpr double beside = 1e-4, grows = 1.5;
  CurvePoint there;
  Transmitting far{NAN, NAN, ""}, near = far;
  if (curve.step(at, 2 * beside, there)) far = transmission_.at(there.q);
  if (curve.step(at, beside, there)) near = transmission_.at(there.q);
  if (!(near.joint_force > grows * far.joint_force))
    return {2 * near.angle - far.angle, 2 * near.joint_force - far.joint_force, near.where};
  const double angle = far.angle > grows * near.angle ? 0 : 2 * near.angle - far.angle;
  return {angle, infinite, near.where};
}

/// Locates an extreme if the last point is beyond both neighbours.
void PassedExtremes::locate(PoseCurve& curve, const Seen& next) {
  constexpr double within = 1e-9;
  const double back = -curve.way(last_->at, before_->at).norm(),
               on = curve.way(last_->at, next.at).norm();
  CurvePoint point;
  const auto look = [&](double sign, double Transmitting::*number, double known) {
    const double here = sign * (last_->passed.*number), before = sign * (before_->passed.*number),
                 after = sign * (next.passed.*number);
    if (!(here <= before && here <= after && (here < before || here < after))) return;
    // No further down than the neighbours are up.
    if (here - std::max(before, after) + here >= sign * known) return;
    Transmitting least = last_->passed;
    CurvePoint at = last_->at;
    const auto value = [&](double x) {
      if (!curve.step(last_->at, x, point)) return infinite;
      const Transmitting passed = transmission_.at(point.q);
      if (!(sign * (passed.*number) == sign * (passed.*number))) return infinite;
      if (sign * (passed.*number) < sign * (least.*number)) {
        least = passed;
        at = point;
      }
      return sign * (passed.*number);
    };
    least_between(value, back, on, within);
    widen(at, least);
  };
  look(1, &Transmitting::angle, found_.least_angle.value);
  look(-1, &Transmitting::angle, found_.largest_angle.value);
  look(1, &Transmitting::joint_force, found_.least_force.value);
  look(-1, &Transmitting::joint_force, found_.largest_force.value);
}

void PassedExtremes::widen(const CurvePoint& at, const Transmitting& passed) {
  const auto take = [&](double sign, double value, MoveResult::Extreme& most) {
    if (std::isnan(most.value) || sign * value > sign * most.value) most = {value, unit_ * at.s};
  };
  if (!std::isnan(passed.angle)) {
    take(-1, passed.angle, found_.least_angle);
    take(1, passed.angle, found_.largest_angle);
  }
  if (!std::isnan(passed.joint_force)) {
    take(-1, passed.joint_force, found_.least_force);
    take(1, passed.joint_force, found_.largest_force);
  }
}

}  // namespace momenta
