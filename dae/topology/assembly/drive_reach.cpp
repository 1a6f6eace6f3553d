#include <momenta/dae/kkt/least_norm.h>
#include <momenta/dae/topology/assembly/drive_reach.h>
#include <momenta/dae/topology/assembly/scaled_loops.h>
#include <momenta/dae/topology/assembly/stalled_drive.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace momenta {
namespace {

constexpr double longest_step = 0.1;  // [rad or lengths] of any joint
/// Largest correction of a predictor's step. Next to a dead point, q ~ (t* − t)^(1/2), it keeps h
/// below 0.2 (t* − t): a gap behind which loops close again is not stepped over.
constexpr double most_correction = 0.05;
constexpr double closed = 1e-11;  // least tolerance of |Φ|∞, in the same units
constexpr int most_steps = 5000;
constexpr double resolution = 1e-9;  // share of the time in which drives move by one unit

class Continuation {
 public:
  Continuation(const Mechanism& mechanism, double t, Eigen::VectorXd q)
      : mechanism_(mechanism),
        loops_(mechanism),
        pattern_(loops_.pattern()),
        steps_(pattern_, mechanism.m(), mechanism.nv()),
        closed_(std::max(closed, 4 * loops_.units().rounding)),
        t_(t),
        q_(std::move(q)) {
    // Gaps of redundant equations at the start stay on the way.
    const double open = loops_.gap(t_, q_).cwiseAbs().maxCoeff();
    if (open > closed_ && open <= left_by_files &&
        steps_.judge(loops_.jacobian(), Judged::dependence).rank < mechanism.m())
      closed_ = 4 * open;
  }

  /// Leaves out joints that keep freedoms here, and the equations they move; false where none is
  /// left.
  bool leave_free_joints(bool& all_determined);
  DriveReach follow(double end);
  const Eigen::VectorXd& pose() const { return q_; }

 private:
  bool is_in(const KktPattern::Entry& entry) const {
    return loops_.rows[static_cast<std::size_t>(entry.row)] &&
           loops_.columns[static_cast<std::size_t>(entry.column)];
  }
  /// u in units at (t_, q_), and how fast drives alone open the loops there [1/s].
  Eigen::VectorXd rates() {
    loops_.gap(t_, q_);
    const std::vector<double> j = loops_.jacobian();
    Eigen::VectorXd given(mechanism_.m());
    loops_.evaluation().move(nullptr);
    loops_.evaluation().velocities(given.data());
    given = loops_.in_units(std::move(given));
    speed_ = std::max(speed_, given.cwiseAbs().maxCoeff());
    steps_.factor(j);
    return -steps_.solve(given);
  }
  /// Newton's method from q at t, of steps that add up to `most_way` at the most; damped: by the
  /// gap.
  std::optional<Eigen::VectorXd> corrected(double t, Eigen::VectorXd q, double most_way,
                                           bool damped);
  /// Goes on to where loops close a little later near by; false: they do not.
  bool passes(double step, double end);

  const Mechanism& mechanism_;
  ScaledLoops loops_;
  const std::vector<KktPattern::Entry>& pattern_;
  LeastNorm steps_;
  double closed_;
  double t_;
  Eigen::VectorXd q_;
  double speed_ = 0;      ///< largest |Φ_t| met
  Eigen::VectorXd open_;  ///< what stayed open behind the obstacle
};

bool Continuation::leave_free_joints(bool& all_determined) {
  loops_.gap(t_, q_);
  const std::vector<double> all = loops_.jacobian();
  std::vector<bool> met(loops_.columns.size(), false), has_columns(loops_.rows.size(), false);
  for (const auto& [row, column] : pattern_) {
    met[static_cast<std::size_t>(column)] = true;
    has_columns[static_cast<std::size_t>(row)] = true;
  }
  loops_.columns = met;
  // A step of all joints, its entries of one size and in no ratio of small numbers: without its
  // part A x it moves no loop, and moves every joint that has a freedom.
  Eigen::VectorXd way(mechanism_.nv());
  for (Eigen::Index i = 0; i < way.size(); ++i)
    way[i] = 1 + std::fmod(std::numbers::phi * static_cast<double>(i + 1), 1);
  constexpr double rest = 1e-8;
  for (bool changed = true; changed;) {
    changed = false;
    std::vector<double> values = all;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (!is_in(pattern_[i])) values[i] = 0;
    steps_.factor(values);
    const Eigen::VectorXd free = way - steps_.solve(steps_.product(values, way));
    for (std::size_t c = 0; c < met.size(); ++c)
      if (loops_.columns[c] && !(std::abs(free[static_cast<Eigen::Index>(c)]) < rest)) {
        loops_.columns[c] = false;
        changed = true;
      }
    // Equations that such a joint moves tie nothing down.
    for (const auto& [row, column] : pattern_)
      if (!loops_.columns[static_cast<std::size_t>(column)])
        loops_.rows[static_cast<std::size_t>(row)] = false;
  }
  all_determined = loops_.columns == met;
  // Rows without columns tie drives to the ground: they hold or they do not.
  return std::find(loops_.columns.begin(), loops_.columns.end(), true) != loops_.columns.end() ||
         std::find(has_columns.begin(), has_columns.end(), false) != has_columns.end();
}

std::optional<Eigen::VectorXd> Continuation::corrected(double t, Eigen::VectorXd q, double most_way,
                                                       bool damped) {
  const int most_iterations = damped ? 60 : 12;
  double way = 0, last = std::numeric_limits<double>::infinity();
  int slow = 0;
  for (int i = 0; i < most_iterations; ++i) {
    const Eigen::VectorXd phi = loops_.gap(t, q);
    const double norm = phi.cwiseAbs().maxCoeff();
    if (!std::isfinite(norm)) return std::nullopt;
    if (norm <= closed_) return q;
    if (damped) open_ = phi;
    slow = norm > 0.5 * last ? slow + 1 : 0;
    if (!damped && slow > 1) return std::nullopt;
    last = norm;
    const std::vector<double> j = loops_.jacobian();
    steps_.factor(j, damped ? phi.norm() : 0);
    const Eigen::VectorXd step = -steps_.solve(phi);
    if (!step.allFinite()) return std::nullopt;
    way += step.size() > 0 ? step.cwiseAbs().maxCoeff() : 0;
    if (!(way <= most_way)) return std::nullopt;
    q = loops_.moved(q, step);
  }
  return std::nullopt;
}

bool Continuation::passes(double step, double end) {
  for (const double wider : {1e1, 1e3}) {
    const double t = t_ + wider * step;
    if (t >= end) break;
    if (const auto there = corrected(t, q_, longest_step, true)) {
      t_ = t;
      q_ = *there;
      return true;
    }
  }
  return false;
}

DriveReach Continuation::follow(double end) {
  DriveReach reach;
  double h = end - t_;
  int forks = 0;
  for (int count = 0; count < most_steps && t_ < end; ++count) {
    const Eigen::VectorXd u = rates();
    const double fastest = u.size() > 0 ? u.cwiseAbs().maxCoeff() : 0;
    if (!(speed_ > 0) && !(fastest > 0)) h = std::min(h, (end - t_) / 64);  // at rest, as yet
    const double least = resolution * std::min(end - t_, speed_ > 0 ? 1 / speed_ : end - t_);
    h = std::min(h, end - t_);
    if (fastest * h > longest_step) h = longest_step / fastest;
    for (;;) {
      loops_.gap(t_, q_);
      const double most_way = most_correction * h * fastest + 1e-9;
      if (const auto there = corrected(t_ + h, loops_.moved(q_, h * u), most_way, false)) {
        t_ = h < end - t_ ? t_ + h : end;
        q_ = *there;
        break;
      }
      h *= 0.5;
      if (h > least) continue;
      if (++forks <= 100 && passes(std::max(least, 1e-12 * std::abs(t_)), end)) break;
      reach.until = t_;
      reach.obstacle =
          stalled_drive(mechanism_, t_, open_.size() > 0 ? open_ : loops_.gap(t_ + h, q_));
      return reach;
    }
    h *= 2;
  }
  reach.until = t_;
  return reach;
}

}  // namespace

DriveReach drive_reach(const Mechanism& mechanism, double t, const Eigen::VectorXd& q, double end,
                       Followed followed) {
  DriveReach reach;
  reach.until = end;
  reach.q = q;
  if (mechanism.scene().drives.empty() || mechanism.m() == 0 || !(end > t)) return reach;
  Continuation way(mechanism, t, q);
  bool all_determined = true;
  if (followed == Followed::determined && !way.leave_free_joints(all_determined)) {
    reach.determined = false;
    return reach;
  }
  reach = way.follow(end);
  reach.q = way.pose();
  reach.determined = all_determined;
  return reach;
}

Assembly assemble_at(const Mechanism& mechanism, double t, Assembled what) {
  const Assembly start = assemble(mechanism, what);
  if (t == 0) return start;
  Eigen::VectorXd q = start.start.q;
  if (t > 0) {
    DriveReach reach = drive_reach(mechanism, 0, q, t, Followed::all);
    if (!reach.obstacle.empty()) throw SceneError(mechanism.scene().where({}) + reach.obstacle);
    q = std::move(reach.q);
  }
  return assemble(mechanism, t, q, mechanism.tree().u0, what);
}

}  // namespace momenta
