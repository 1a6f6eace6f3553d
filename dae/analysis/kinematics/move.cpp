#include <momenta/core/text/quoting.h>
#include <momenta/dae/analysis/kinematics/change_point.h>
#include <momenta/dae/analysis/kinematics/held_coordinate.h>
#include <momenta/dae/analysis/kinematics/idle_turns.h>
#include <momenta/dae/analysis/kinematics/move_rows.h>
#include <momenta/dae/run/event/bracketed_root.h>
#include <momenta/dae/run/measure/rank.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace momenta {
namespace {

using Eigen::VectorXd;
constexpr double whole_turn = 2 * std::numbers::pi;
constexpr double longest_step = 0.1, shortest_step = 1e-9;  // in units
// Least |τ_s| at which s is given, not the distance: s does not turn back in a step of so little
// bend.
constexpr double steep = 0.3;
constexpr int most_ranked = 200;          // loop equations whose rank is judged beside the start
constexpr double nearly_singular = 1e-6;  // pivot of B where a crossing curve is as near
constexpr double at_rest = 1e-7;          // τ_s of a dead point that a file gives

class Follower {
 public:
  Follower(const Mechanism& mechanism, double t, const VectorXd& start, const MoveRequest& request)
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
    for (const std::string& name : request.hold)
      held_.push_back(held_coordinate(mechanism_, name, start));
    result_.swept = static_cast<std::size_t>(swept_.front().q);
    rows_.emplace(mechanism, t, request, inputs, held_, unit_, result_);
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
  /// Whether a full turn brings the pose back, for each coordinate.
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
    if (!start_without_idle_turns(*curve_, t_, q, here_, result_.idle)) {
      if (curve_->freedoms() == 0)
        throw SceneError("coordinate '" + first +
                         "' cannot be swept: what is held and the loops leave no motion, expected "
                         "a mechanism that moves");
      if (mechanism_.m() > 0 && mechanism_.m() <= most_ranked) refuse_change_point(q);
      std::vector<std::string> names;
      for (const int u : curve_->free_rates()) names.push_back(name_to_hold(mechanism_, u));
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
    by_ = request_.by > 0 ? request_.by / unit_ : angles_[result_.swept] ? whole_turn / 360 : 0.01;
    const bool dead = std::abs(here_.s_rate()) < at_rest;
    if (dead) here_.tangent[here_.tangent.size() - 1] = 0;
    beginning_ = here_;
    rows_->take(*curve_, here_, dead ? MovedPose::Kind::dead_point : MovedPose::Kind::sample);
    if (request_.to && *request_.to == result_.start) result_.end = MoveResult::End::reached;
  }

  void refuse_change_point(const VectorXd& q) const {
    Start here;
    here.t = t_;
    here.q = q;
    here.u = VectorXd::Zero(mechanism_.nv());
    const RankReport rank = rank_report(mechanism_, here);
    if (rank.singular_here())
      throw SceneError("the start is a change point: the loop equations have rank " +
                       std::to_string(rank.rank) + " there and " +
                       std::to_string(rank.rank_nearby) +
                       " beside it, so that curves of poses cross; expected a start beside it");
  }

  /// Whether the first coordinate has no rate along the curve, not only at a dead point.
  bool stays() {
    constexpr double no_rate = 1e-11;
    CurvePoint to = here_;
    for (const double h : {0.0, 0.03, 0.07})
      if ((h > 0 && !curve_->step(here_, h, to)) || std::abs(to.s_rate()) > no_rate) return false;
    return true;
  }

  /// Next s of a row: on the grid, at the start again, or the end.
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
    if (angles_[result_.swept]) sooner(after(whole_turn));
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
        const Ahead ahead = look_ahead(to);
        if (ahead == Ahead::free) arrive(to, end);
        if (ahead == Ahead::crossed) pass(end);
        if (ahead != Ahead::lost) return true;
      }
    }
    for (double h = step_; h > shortest_step; h *= 0.5) {
      if (!curve_->step(here_, h, to)) continue;
      const Ahead ahead = look_ahead(to);
      if (ahead == Ahead::lost) continue;
      if (ahead == Ahead::free) {
        step_ = std::min(longest_step, 1.5 * h);
        cross(to, h, end);
      } else {
        pass(end);
      }
      return true;
    }
    if (!change_at(here_, longest_step)) return false;
    pass(end);
    return true;
  }

  enum class Ahead {
    free,     ///< the curve goes there
    crossed,  ///< another curve crosses before it, at change_
    lost      ///< the point is on another curve
  };

  /// Obstacles up to a point of Newton's method. det B(τ) keeps its sign along a curve; it changes
  /// where another one crosses, and towards it.
  Ahead look_ahead(CurvePoint& to) {
    const auto flips = [&] { return here_.orientation * to.orientation < 0; };
    if (!flips() && to.pivot > nearly_singular) return Ahead::free;
    // The rows may be at fault if others do not depend on each other.
    if (curve_->has_spare_rows() && here_.orientation != 0 && curve_->choose_rows(to.q, here_) &&
        curve_->orient(to) && !flips() && to.pivot > nearly_singular)
      return Ahead::free;
    const double length = distance(here_, to);
    if (change_at(here_.pivot > 0 && here_.pivot < to.pivot ? here_ : to, length) ||
        change_at(here_, length))
      return Ahead::crossed;
    return flips() ? Ahead::lost : Ahead::free;
  }

  /// Finds a change point near `near`, ahead by up to `length`: change_.
  bool change_at(const CurvePoint& near, double length) {
    constexpr double least = 1e-9;
    if (!change_point_near(*curve_, near, change_)) return false;
    const VectorXd way = curve_->way(here_, change_);
    const double along = way.dot(here_.tangent);
    if (!(along > least && along < 1.001 * length + least) ||
        !((way - along * here_.tangent).norm() < 0.5 * along + least))
      return false;
    go_straight_across(*curve_, here_, change_);
    double& s_rate = change_.tangent[change_.tangent.size() - 1];
    if (std::abs(s_rate) < 1e-6) s_rate = 0;
    return !(s_rate * here_.s_rate() < 0);  // a dead point comes first
  }

  void pass(double end) {
    const CurvePoint at = change_;
    rows_before(at, here_.s_rate(), end);
    if (result_.end != MoveResult::End::stopped) return;
    rows_->take(*curve_, at, MovedPose::Kind::change_point);
    if (std::isfinite(end) && std::abs(at.s - end) <= 1e-9 * by_)
      result_.end = MoveResult::End::reached;
    move_on(at);
  }

  /// Point at a distance h from here where `value` is zero.
  template <class Value>
  std::optional<CurvePoint> found(double h, double at_start, double at_end, Value value) {
    CurvePoint point;
    const double zero =
        bracketed_root([&](double x) { return curve_->step(here_, x, point) ? value(point) : NAN; },
                       0, at_start, h, at_end, 1e-15)
            .at;
    if (!std::isfinite(zero) || !curve_->step(here_, zero, point)) return std::nullopt;
    return point;
  }

  /// Takes a step by length, up to a row or dead point.
  void cross(const CurvePoint& to, double h, double end) {
    const double way = here_.s_rate();
    if (way != 0 && way * to.s_rate() < 0) {
      const auto at = found(h, way, to.s_rate(), [](const CurvePoint& p) { return p.s_rate(); });
      if ((!at || at->pivot < 1e-3) && change_at(at ? *at : here_, h)) return pass(end);
      if (at) return turn_back(*at, way, end);
    } else if (const double rest = rests_between(to, h); rest > 0) {
      CurvePoint between;
      if (curve_->step(here_, rest, between) && way * between.s_rate() < 0)
        return cross(between, rest, end);
    }
    rows_before(to, to.s_rate(), end);
    if (result_.end != MoveResult::End::stopped) return;
    // The next row may be at the step's end.
    const double s = next_s(to.s_rate(), end);
    if (std::abs(to.s - s) <= 1e-9 * by_) {
      CurvePoint there;
      if (!curve_->step_to(to, s, there)) there = to;
      there.s = s;
      return arrive(there, end);
    }
    rows_->pass(*curve_, to);
    move_on(to);
  }

  void turn_back(CurvePoint at, double way, double end) {
    rows_before(at, way, end);
    if (result_.end != MoveResult::End::stopped) return;
    at.tangent[at.tangent.size() - 1] = 0;
    close(at);
    rows_->take(*curve_, at,
                result_.end == MoveResult::End::closed ? MovedPose::Kind::sample
                                                       : MovedPose::Kind::dead_point);
    move_on(at);
  }

  /// Distance of the least |τ_s|, of one sign at both ends, by Hermite's cubic: two dead points may
  /// lie between. 0: least at an end.
  double rests_between(const CurvePoint& to, double h) const {
    const double first = here_.s_rate(), last = to.s_rate(),
                 bend = 6 * ((to.s - here_.s) / h - 0.5 * (first + last));
    if (!(bend * first < 0)) return 0;
    const double x = 0.5 * (1 + (last - first) / bend);
    if (!(x > 0 && x < 1)) return 0;
    const double least = first + (last - first) * x + bend * x * (1 - x);
    return std::abs(least) < 0.5 * std::abs(first) || least * first < 0 ? x * h : 0;
  }

  /// Takes rows before a point; s does not turn.
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

  /// Distance of `to` along τ of `from`.
  double distance(const CurvePoint& from, const CurvePoint& to) {
    return curve_->way(from, to).dot(from.tangent);
  }

  /// Arrives at a row whose s was asked for.
  void arrive(const CurvePoint& to, double end) {
    rows_->take(*curve_, to, MovedPose::Kind::sample);
    if (std::isfinite(end) && std::abs(to.s - end) <= 1e-9 * by_)
      result_.end = MoveResult::End::reached;
    else
      close(to);
    move_on(to);
  }

  /// Ends a closed curve.
  void close(const CurvePoint& to) {
    if (!has_left_ || !is_beginning(to)) return;
    if (!request_.to)
      result_.end = MoveResult::End::closed;
    else if (std::abs(to.s) < 1e-9)
      result_.why = result_.coordinates[result_.swept].name + " does not come to " +
                    reading::digits(*request_.to) + ": it is back at the start";
  }

  /// Whether the start is passed the same way.
  bool is_beginning(const CurvePoint& to) const {
    return is_there(to) && to.tangent.dot(beginning_.tangent) > 0;
  }

  /// Whether the pose is the start's.
  bool is_there(CurvePoint to) const {
    constexpr double same = 1e-7;
    for (const auto& body : mechanism_.tree().bodies)  // −q is the same turn
      if (const int at = body.q + body.nq - 4;
          body.has_quaternion() && to.q.segment<4>(at).dot(beginning_.q.segment<4>(at)) < 0)
        to.q.segment<4>(at) *= -1;
    for (Eigen::Index i = 0; i < to.q.size(); ++i) {
      double apart = to.q[i] - beginning_.q[i];
      if (angles_[static_cast<std::size_t>(i)]) apart = std::remainder(apart, whole_turn);
      if (std::abs(apart) > same * std::max(1.0, std::abs(beginning_.q[i]))) return false;
    }
    return true;
  }

  /// Locates limits of coordinates on the way, and moves.
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
    look_back(to);
    has_left_ = has_left_ || !is_there(to);
    before_ = here_;
    here_ = to;
  }

  /// Where an even number of ranks is lost, det B keeps its sign, and its smallest pivot goes down
  /// to zero and up again.
  void look_back(const CurvePoint& to) {
    if (!before_ || !(before_->pivot > here_.pivot && here_.pivot <= to.pivot)) return;
    const double first = distance(*before_, here_), second = distance(here_, to),
                 down = here_.pivot * first / (before_->pivot - here_.pivot),
                 up = here_.pivot * second / (to.pivot - here_.pivot);
    if (here_.pivot == 0 || !(std::min(down, up) < std::max(first, second))) return;
    CurvePoint at;
    if (!change_point_near(*curve_, here_, at)) return;
    const double along = distance(*before_, at);
    if (!(along > 0 && along < first + second)) return;
    go_straight_across(*curve_, *before_, at);
    rows_->take(*curve_, at, MovedPose::Kind::change_point);
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
  std::vector<HeldCoordinate> held_;
  std::optional<MoveRows> rows_;
  PoseCurve* curve_ = nullptr;
  CurvePoint here_, beginning_, change_;
  std::optional<CurvePoint> before_;
  bool has_left_ = false;
  // s of the curve in units: pose.s = unit_ s.
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
  return Follower(mechanism, t, q, request).follow(q);
}

}  // namespace momenta
