#include <momenta/core/text/quoting.h>
#include <momenta/dae/analysis/kinematics/held_coordinate.h>
#include <momenta/dae/analysis/kinematics/idle_turns.h>
#include <momenta/dae/study/fit/swept_poses.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace momenta {
namespace {

constexpr double longest_step = 0.1, shortest_step = 1e-9;  // in units

}  // namespace

SweptPoses::SweptPoses(const Mechanism& mechanism, const std::string& sweep)
    : mechanism_(mechanism) {
  std::tie(coordinate_, rate_) = coordinate_named(mechanism, sweep);
  const Column column = mechanism.coordinate_columns()[static_cast<std::size_t>(coordinate_)];
  name_ = column.name;
  angle_ = column.unit == "rad";
  const Assembly assembly = assemble(mechanism, Assembled::rates);
  start_ = assembly.start.q[coordinate_];
  unit_ = LoopUnits(mechanism).rates[rate_];
  curve_ = std::make_unique<PoseCurve>(mechanism, assembly.start.t,
                                       std::vector<SweptCoordinate>{{coordinate_, rate_, unit_}},
                                       std::vector<HeldCoordinate>{});
  std::vector<std::string> idle;
  if (!start_without_idle_turns(*curve_, assembly.start.t, assembly.start.q, beginning_, idle))
    throw SceneError(curve_->freedoms() == 0
                         ? "coordinate '" + sweep + "' cannot be swept: the loops leave no motion"
                         : "sweeping '" + sweep + "' leaves " +
                               std::to_string(curve_->freedoms() - 1) +
                               " more degrees of freedom; expected a mechanism with one alone");
}

/// Moves `here` to s [units]; steps are halved where Newton's method fails.
bool SweptPoses::walk(CurvePoint& here, double s) {
  double step = longest_step;
  CurvePoint to;
  while (here.s != s) {
    const double left = s - here.s,
                 next = std::abs(left) <= step ? s : here.s + std::copysign(step, left);
    if (curve_->step_to(here, next, to)) {
      here = to;
      step = std::min(longest_step, 2 * step);
    } else {
      step = 0.5 * std::min(step, std::abs(left));
      if (step < shortest_step) {
        why_ = name_ + " = " + reading::digits(start_ + unit_ * s) +
               " is not reached: from its start, " + reading::digits(start_) +
               ", it goes as far as " + reading::digits(start_ + unit_ * here.s);
        return false;
      }
    }
  }
  return true;
}

bool SweptPoses::reach(const std::vector<double>& places, std::vector<Eigen::VectorXd>& q) {
  std::vector<CurvePoint> points;
  if (!reach(places, points)) return false;
  q.clear();
  for (CurvePoint& point : points) q.push_back(std::move(point.q));
  return true;
}

bool SweptPoses::reach(const std::vector<double>& places, std::vector<CurvePoint>& points) {
  points.resize(places.size());
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return places[a] < places[b]; });
  const auto first_above = std::partition_point(order.begin(), order.end(),
                                                [&](std::size_t i) { return places[i] < start_; });
  const auto go = [&, here = beginning_](std::size_t i) mutable {
    if (!walk(here, (places[i] - start_) / unit_)) return false;
    points[i] = here;
    return true;
  };
  // Each way has a point of its own that walks from the start.
  auto up = go, down = go;
  return std::all_of(first_above, order.end(), [&](std::size_t i) { return up(i); }) &&
         std::all_of(std::make_reverse_iterator(first_above), order.rend(),
                     [&](std::size_t i) { return down(i); });
}

bool SweptPoses::rates(const CurvePoint& at, double rate, Eigen::VectorXd& u,
                       Eigen::VectorXd& udot) {
  if (!curve_->derivatives(at, u, udot)) {
    why_ = name_ + " = " + reading::digits(start_ + unit_ * at.s) +
           " is a dead point, where other coordinates have no rates";
    return false;
  }
  u *= rate / unit_;
  udot *= (rate / unit_) * (rate / unit_);
  return true;
}

void SweptPoses::sample(double by, int most, std::vector<double>& places,
                        std::vector<Eigen::VectorXd>& q) {
  places = {start_};
  q = {beginning_.q};
  const int each_way = most / 2;
  for (const double way : {-1.0, 1.0}) {
    CurvePoint here = beginning_;
    for (int k = 1; k <= each_way; ++k) {
      const double place = way * k * by;
      if ((angle_ && std::abs(place) > std::numbers::pi) || !walk(here, place / unit_)) break;
      places.push_back(start_ + place);
      q.push_back(here.q);
    }
    if (way < 0) {
      std::reverse(places.begin(), places.end());
      std::reverse(q.begin(), q.end());
    }
  }
  why_.clear();
}

}  // namespace momenta
