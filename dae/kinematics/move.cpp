#include <momenta/core/text/near_name.h>
#include <momenta/dae/kinematics/coordinate_named.h>
#include <momenta/dae/kinematics/least_pivot.h>
#include <momenta/dae/kinematics/move_rows.h>
#include <momenta/dae/kinematics/zero_between.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace momenta {
namespace {

using Eigen::VectorXd;
constexpr double turn = 2 * std::numbers::pi;
constexpr double longest_step = 0.1, shortest_step = 1e-9;  // in units
// From here on s is given, not the distance: no step that bends by so little turns s round.
constexpr double steep = 0.3;

class Follower {
 public:
  Follower(const Mechanism& mechanism, double t, const MoveRequest& request)
      : mechanism_(mechanism), request_(request), t_(t), angles_(angles()) {
    const LoopUnits units(mechanism);
    std::vector<int> inputs;
    const double first = request.sweep.front().second;
    for (const auto& [name, amount] : request.sweep) {
      if (!std::isfinite(amount / first) || amount == 0)
        throw SceneError("coordinate '" + name + "' is swept by " + reading::digits(amount) +
                         "; expected amounts other than zero");
      const auto [q, u] = coordinate_named(mechanism_, name);
      if (swept_.empty()) unit_ = units.rates[u];
      swept_.push_back({q, u, amount / first * unit_});
      inputs.push_back(u);
    }
    for (const std::string& name : request.hold) {
      held_.push_back(coordinate_named(mechanism_, name));
      inputs.push_back(held_.back().second);
    }
    result_.swept = static_cast<std::size_t>(swept_.front().q);
    rows_.emplace(mechanism, t, request, inputs, unit_, result_);
  }

  MoveResult follow(const VectorXd& q) {
    PoseCurve curve(mechanism_, t_, swept_, held_);
    curve_ = &curve;
    begin(q);
    const double end = request_.to ? (*request_.to - result_.start) / unit_ : NAN;
    while (result_.end == MoveResult::End::stopped && result_.why.empty()) {
      if (static_cast<long>(result_.poses.size()) >= request_.most_rows)
        result_.why = "after " + std::to_string(result_.poses.size()) + " rows";
      else if (!advance(end))
        result_.why = "the curve could not be followed beyond " +
                      result_.coordinates[result_.swept].name + " = " +
                      reading::digits(result_.start + unit_ * here_.s);
    }
    return std::move(result_);
  }

 private:
  /// Of each coordinate whether a full turn brings the pose back.
  std::vector<bool> angles() const {
    std::vector<bool> result(static_cast<std::size_t>(mechanism_.nq()), false);
    for (const auto& body : mechanism_.tree().bodies)
      for (int i = 0; i < body.nq; ++i)
        result[static_cast<std::size_t>(body.q + i)] =
            body.kind == JointKind::revolute || body.kind == JointKind::universal ||
            (body.kind == JointKind::cylindrical && i == 0);
    return result;
  }

  void begin(const VectorXd& q) {
    const std::string& first = request_.sweep.front().first;
    result_.start = q[swept_.front().q];
    result_.reach.resize(static_cast<std::size_t>(q.size()));
    for (Eigen::Index i = 0; i < q.size(); ++i)
      result_.reach[static_cast<std::size_t>(i)] = {q[i], q[i], 0};
    if (!curve_->start(q, here_)) {
      if (curve_->freedoms() == 0)
        throw SceneError("coordinate '" + first +
                         "' cannot be swept: what is held and the loops leave no motion, expected "
                         "a mechanism that "
                         "moves");
      std::vector<std::string> names;
      for (const int u : curve_->free_rates())
        names.push_back(result_.rates[static_cast<std::size_t>(u)].name);
      const int more = curve_->freedoms() - 1;
      throw SceneError("sweeping '" + first + "' leaves " + std::to_string(more) +
                       (more == 1 ? " more degree" : " more degrees") +
                       " of freedom; expected as many coordinates held or swept, such as " +
                       reading::all_in_quotes(names));
    }
    if (stays())
      throw SceneError("coordinate '" + first +
                       "' cannot be swept: the loops hold it where it is, whatever else moves; "
                       "expected one that "
                       "moves");
    if (request_.to && *request_.to < result_.start) {
      here_.tangent = -here_.tangent;
      here_.orientation = -here_.orientation;
    }
    by_ = request_.by > 0 ? request_.by / unit_ : angles_[result_.swept] ? turn / 360 : 0.01;
    beginning_ = here_;
    rows_->take(*curve_, here_, MovedPose::Kind::sample);
    if (request_.to && *request_.to == result_.start) result_.end = MoveResult::End::reached;
  }

  /// Whether the first coordinate has no rate along the curve, not at a dead point alone.
  bool stays() {
    constexpr double no_rate = 1e-11;
    CurvePoint to = here_;
    for (const double h : {0.0, 0.03, 0.07})
      if ((h > 0 && !curve_->step(here_, h, to)) || std::abs(to.s_rate()) > no_rate) return false;
    return true;
  }

  /// The next s that is a row: of the grid, where the start comes round again, or the end.
  double next_s(double way, double end) const {
    const double s = here_.s, near = 1e-9 * by_;
    const auto after = [&](double spacing) {
      double k = way > 0 ? std::floor(s / spacing) + 1 : std::ceil(s / spacing) - 1;
      if (std::abs(k * spacing - s) <= near) k += way > 0 ? 1 : -1;
      return k * spacing;
    };
    double next = after(by_);
    const auto sooner = [&](double other) {
      if ((other - s) * way > near && (other - next) * way < -near) next = other;
    };
    if (angles_[result_.swept]) sooner(after(turn));
    if (std::isfinite(end)) sooner(end);
    if (std::abs(s) > near) sooner(0);
    return next;
  }

  bool advance(double end) {
    CurvePoint to;
    const double way = here_.s_rate();
    if (std::abs(way) >= steep) {
      const double s = next_s(way, end);
      if (std::abs((s - here_.s) / way) <= longest_step && curve_->step_to(here_, s, to)) {
        arrive(to, end);
        return true;
      }
    }
    for (double h = step_; h > shortest_step; h *= 0.5) {
      if (!curve_->step(here_, h, to)) continue;
      step_ = std::min(longest_step, 1.5 * h);
      cross(to, h, end);
      return true;
    }
    return false;
  }

  /// The point at a distance h from here where `value` of it is zero.
  template <class Value>
  std::optional<CurvePoint> found(double h, double at_start, double at_end, Value value) {
    CurvePoint point;
    const double zero =
        zero_between([&](double x) { return curve_->step(here_, x, point) ? value(point) : NAN; },
                     0, at_start, h, at_end);
    if (!std::isfinite(zero) || !curve_->step(here_, zero, point)) return std::nullopt;
    return point;
  }

  /// A step by its length, which may pass rows or a dead point: there it ends.
  void cross(const CurvePoint& to, double h, double end) {
    const double way = here_.s_rate();
    if (way != 0 && way * to.s_rate() < 0) {
      const auto at = found(h, way, to.s_rate(), [](const CurvePoint& p) { return p.s_rate(); });
      if (at) {
        rows_before(*at, way, end);
        if (result_.end != MoveResult::End::stopped) return;
        rows_->take(*curve_, *at, MovedPose::Kind::dead_point);
        move_on(*at);
        here_.tangent[here_.tangent.size() - 1] = 0;
        return;
      }
    }
    rows_before(to, to.s_rate(), end);
    if (result_.end == MoveResult::End::stopped) move_on(to);
  }

  /// The rows between here and a point, s on one way.
  void rows_before(const CurvePoint& to, double way, double end) {
    while (result_.end == MoveResult::End::stopped) {
      const double s = next_s(way, end);
      if (!((to.s - s) * way > 0)) return;
      const auto at = found(distance(here_, to), here_.s - s, to.s - s,
                            [&](const CurvePoint& p) { return p.s - s; });
      if (!at) return;
      CurvePoint there = *at;
      there.s = s;
      arrive(there, end);
    }
  }

  /// How far along τ of one point another is.
  double distance(const CurvePoint& from, const CurvePoint& to) {
    VectorXd rates(mechanism_.nv()), qdot = to.q - from.q;
    Evaluation<double>& e = curve_->loops().evaluation();
    e.place(t_, from.q.data());
    e.joint_rates(from.q.data(), qdot.data(), rates.data());
    const VectorXd step = rates.cwiseQuotient(curve_->loops().units().rates);
    return step.dot(from.tangent.head(mechanism_.nv())) + (to.s - from.s) * from.s_rate();
  }

  /// A row whose s was asked for.
  void arrive(const CurvePoint& to, double end) {
    rows_->take(*curve_, to, MovedPose::Kind::sample);
    if (std::isfinite(end) && std::abs(to.s - end) <= 1e-9 * by_)
      result_.end = MoveResult::End::reached;
    else if (!std::isfinite(end) && is_beginning(to))
      result_.end = MoveResult::End::closed;
    move_on(to);
  }

  /// The same pose, passed the same way.
  bool is_beginning(const CurvePoint& to) const {
    constexpr double same = 1e-7;
    for (Eigen::Index i = 0; i < to.q.size(); ++i) {
      double apart = to.q[i] - beginning_.q[i];
      if (angles_[static_cast<std::size_t>(i)]) apart = std::remainder(apart, turn);
      if (std::abs(apart) > same * std::max(1.0, std::abs(beginning_.q[i]))) return false;
    }
    return to.tangent.dot(beginning_.tangent) > 0;
  }

  /// Limits of coordinates on the way; then from there.
  void move_on(const CurvePoint& to) {
    for (const auto& body : mechanism_.tree().bodies)
      for (int i = 0; i < body.nq; ++i) {
        Reach& reach = result_.reach[static_cast<std::size_t>(body.q + i)];
        if (body.nq == body.nv && here_.tangent[body.u + i] * to.tangent[body.u + i] < 0) {
          ++reach.turns_back;
          const double h = distance(here_, to);
          const auto at = found(h, here_.tangent[body.u + i], to.tangent[body.u + i],
                                [&](const CurvePoint& p) { return p.tangent[body.u + i]; });
          if (at) widen(reach, at->q[body.q + i]);
        }
        widen(reach, to.q[body.q + i]);
      }
    if (before_ && before_->pivot > here_.pivot && here_.pivot <= to.pivot) look_for_change(to);
    before_ = here_;
    here_ = to;
    if (recalled_) here_ = *std::exchange(recalled_, std::nullopt);
  }

  /// The smallest pivot has passed a least value between the point before here and `to`: a change
  /// point if it is zero, and that of all rows.
  void look_for_change(const CurvePoint& to) {
    constexpr double lost = 1e-7;
    const CurvePoint from = *before_;
    const CurvePoint least =
        least_pivot(*curve_, from, distance(from, here_) + distance(here_, to), here_);
    if (!(least.pivot < lost)) return;
    if (curve_->reciprocal_condition(least.q) < lost) {
      rows_->take(*curve_, least, MovedPose::Kind::change_point);
      return;
    }
    CurvePoint known = from, again;  // the rows were at fault
    if (!curve_->choose_rows(least.q, known) || !curve_->step(known, distance(known, to), again))
      return;
    recalled_ = to;
    recalled_->orientation = again.orientation;
    recalled_->pivot = again.pivot;
  }

  static void widen(Reach& reach, double value) {
    reach.least = std::min(reach.least, value);
    reach.most = std::max(reach.most, value);
  }

  const Mechanism& mechanism_;
  const MoveRequest& request_;
  double t_;  ///< [s]
  std::vector<bool> angles_;
  std::vector<SweptCoordinate> swept_;
  std::vector<std::pair<int, int>> held_;
  std::optional<MoveRows> rows_;
  PoseCurve* curve_ = nullptr;
  CurvePoint here_, beginning_;
  std::optional<CurvePoint> before_, recalled_;
  // s of the curve is in units: pose.s = unit_ s.
  double step_ = longest_step, by_ = 0, unit_ = 1;
  MoveResult result_;
};

}  // namespace

MoveResult move(const Mechanism& mechanism, double t, const VectorXd& q,
                const MoveRequest& request) {
  constexpr int most_rates = 2000;
  if (request.sweep.empty())
    throw SceneError("found no coordinate to sweep, expected the name of one");
  if (mechanism.nv() > most_rates)
    throw SceneError("the mechanism has " + std::to_string(mechanism.nv()) +
                     " rates; its curve of poses is followed by dense matrices, expected up to " +
                     std::to_string(most_rates));
  const auto expect_finite = [](const char* option, double x, bool good, const char* expected) {
    if (!good)
      throw SceneError(std::string(option) + " is " + reading::digits(x) + ", expected " +
                       expected);
  };
  expect_finite("--by", request.by, request.by >= 0 && std::isfinite(request.by),
                "a finite number >= 0");
  if (request.to)
    expect_finite("--to", *request.to, std::isfinite(*request.to),
                  "a finite coordinate [rad or m]");
  return Follower(mechanism, t, request).follow(q);
}

}  // namespace momenta
