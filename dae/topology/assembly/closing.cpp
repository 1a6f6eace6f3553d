#include <momenta/dae/topology/assembly/bending.h>
#include <momenta/dae/topology/assembly/closing.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <random>

namespace momenta {
namespace {

constexpr double closed_gap = 1e-12;  // least tolerance of |Φ|∞, in units
constexpr int damped_iterations = 200;
constexpr double largest_step = 0.4;  // [rad or lengths]: stay on the branch of the guess
constexpr double far = 0.1;           // [rad or lengths]: Newton's steps may leave the branch
constexpr int undamped_iterations = 40;
constexpr double seed_distances[] = {0.3, 1, 3};
constexpr int most_seeds = 8;            // at each distance
constexpr double seed_entries = 100000;  // entries of Φ_q, all seeds of a distance together

double largest_of(const std::vector<double>& j) {
  double largest = 0;
  for (const double x : j) largest = std::max(largest, std::abs(x));
  return largest;
}
double largest_of(const Eigen::VectorXd& x) {
  return x.size() > 0 ? x.cwiseAbs().maxCoeff() : 0;
}

}  // namespace

Closing::Closing(ScaledLoops& loops, LeastNorm& steps, double t)
    : loops_(loops),
      steps_(steps),
      t_(t),
      tolerance_(std::max(closed_gap, loops.units().rounding)) {}

/// A step, shortened until the loops close further; near rounding level they do not, and the norm
/// stays infinite.
struct Closing::Trial {
  Eigen::VectorXd q;
  double norm = std::numeric_limits<double>::infinity();
  NewtonStep taken;
};

Closing::Trial Closing::along(const Eigen::VectorXd& q, double norm, Eigen::VectorXd step) {
  Trial best;
  if (!step.allFinite()) return best;
  const double length = largest_of(step);
  best.taken = {q, step, 1, length > largest_step};
  if (best.taken.is_cut) step *= (best.taken.part = largest_step) / length;
  for (int halving = 0; halving < 12; ++halving, step *= 0.5, best.taken.part *= 0.5) {
    Eigen::VectorXd next = loops_.moved(q, step);
    if (const double reached = gap(next).norm(); reached < norm) {
      best.q = std::move(next);
      best.norm = reached;
      break;
    }
  }
  return best;
}

/// Minimises |J δ + φ|² + λ² |δ|², λ = |φ|, but large enough that rows of rounding do not count.
Eigen::VectorXd Closing::damped_step(const std::vector<double>& j, const Eigen::VectorXd& phi) {
  steps_.factor(j, std::max(phi.norm(), rank_tolerance * largest_of(j)));
  return -steps_.solve(phi);
}

Closing::Pose Closing::damped(Eigen::VectorXd q, int most) {
  Eigen::VectorXd phi = gap(q);
  double norm = phi.norm();
  int stalled = 0;
  newton_.emplace();
  std::vector<double> j;
  // Factors stay once the loops are closed: J changes by rounding from there.
  bool settled = false;
  for (int count = 0; count < most && norm > 1e-16 && stalled < 2; ++count, ++iterations_) {
    if (!settled) steps_.factor(j = loops_.jacobian());
    settled = largest_of(phi) <= tolerance_;
    // A contradiction stays open: damped steps would follow the mechanism's own motion to where it
    // is a little less.
    const bool contradicts = !settled && largest_of(phi) <= left_by_files && is_redundant(j);
    Trial next = along(q, norm, -steps_.solve(phi));
    // Redundant rows are so only where the loops are closed: elsewhere they ask, through pivots as
    // small as the gap, for steps that lead nowhere. Damping by the gap is harmless near the end,
    // where it vanishes faster than the error.
    bool is_damped = false;
    if (!settled && !contradicts && !(next.norm < 0.5 * norm))
      if (Trial damped = along(q, norm, damped_step(j, phi)); damped.norm < next.norm) {
        next = std::move(damped);
        is_damped = true;
      }
    const double next_norm = next.norm;
    if (!(next_norm < norm)) break;
    if (is_damped) newton_.reset();
    if (newton_) newton_->push_back(std::move(next.taken));
    stalled = next_norm > 0.5 * norm && norm < tolerance_ ? stalled + 1 : 0;
    q = next.q;
    phi = gap(q);
    norm = next_norm;
    // Loops that close go on to rounding.
    if (const double open = largest_of(phi); contradicts && open > tolerance_ && is_least(q, open))
      break;
  }
  const double last = largest_of(phi);
  const bool least = last > tolerance_ && is_least(q, last);
  return {q, last, last <= tolerance_ || least, least};
}

bool Closing::is_redundant(const std::vector<double>& j) {
  return steps_.judge(j, Judged::dependence).rank <
         std::count(loops_.rows.begin(), loops_.rows.end(), true);
}

/// Whether redundant equations alone are open, by no more than a file's rounding.
bool Closing::is_least(const Eigen::VectorXd& q, double open) {
  if (!(open <= left_by_files)) return false;
  const Eigen::VectorXd phi = gap(q);
  const std::vector<double> j = loops_.jacobian();
  if (!is_redundant(j)) return false;
  steps_.factor(j);
  return largest_of(steps_.product(j, steps_.solve(phi))) <= tolerance_ &&
         !bending(loops_, steps_, t_, q, tolerance_).bends;
}

/// Whether loops that stay open at q do so because they are stretched, and no motion closes them.
bool Closing::is_stretched(const Eigen::VectorXd& q) {
  constexpr double flat = 0.03;  // |Jᵀ Φ| beside |J| |Φ|
  const Eigen::VectorXd phi = gap(q);
  const std::vector<double> j = loops_.jacobian();
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(loops_.mechanism().nv());
  for (std::size_t i = 0; i < j.size(); ++i)
    pull[loops_.pattern()[i].column] += j[i] * phi[loops_.pattern()[i].row];
  if (!(pull.norm() <= flat * largest_of(j) * phi.norm())) return false;
  const Bending found = bending(loops_, steps_, t_, q, tolerance_);
  return found.bends && !found.closes;
}

/// From a stretched pose to one beside it that closes.
Closing::Pose Closing::bent(const Pose& open) {
  if (open.gap <= left_by_files)
    for (const Eigen::VectorXd& start : bending(loops_, steps_, t_, open.q, tolerance_).nearer)
      if (Pose pose = damped(start, seed_iterations); pose.is_closed) return pose;
  return open;
}

/// Closes the gap continuously, down to a hundredth; false where it gets stuck.
bool Closing::follow(Eigen::VectorXd& q) {
  constexpr double longest = 0.05, bend = 0.3, least_part = 1e-4;
  constexpr int most_steps = 600;
  Eigen::VectorXd phi = gap(q);
  const double end = 0.01 * std::min(phi.norm(), 1.0);
  double part = longest;
  for (int count = 0; count < most_steps && phi.norm() > end; ++count) {
    const std::vector<double> j = loops_.jacobian();
    Eigen::VectorXd step = damped_step(j, phi);
    if (!step.allFinite()) return false;
    const double length = largest_of(step);
    step *= std::min(part, longest / std::max(length, longest * 1e-3));
    const Eigen::VectorXd expected = steps_.product(j, step);
    if (!(expected.norm() > 1e-6 * phi.norm())) return false;  // nowhere to go
    const Eigen::VectorXd next = loops_.moved(q, step);
    const Eigen::VectorXd reached = gap(next);
    if ((reached - phi - expected).norm() > bend * expected.norm()) {
      if ((part *= 0.5) < least_part) return false;
      gap(q);
      continue;
    }
    part = std::min(0.25, 1.5 * part);
    q = next;
    phi = reached;
  }
  return phi.norm() <= end;
}

Closing::Pose Closing::undamped(Eigen::VectorXd q) {
  for (int count = 0; count < undamped_iterations; ++count, ++iterations_) {
    const Eigen::VectorXd phi = gap(q);
    if (largest_of(phi) < 1e-6) return damped(std::move(q), seed_iterations);
    steps_.factor(loops_.jacobian());
    Eigen::VectorXd step = -steps_.solve(phi);
    if (!step.allFinite()) break;
    if (const double length = largest_of(step); length > std::numbers::pi)
      step *= std::numbers::pi / length;
    q = loops_.moved(q, step);
  }
  return {q, largest_of(gap(q)), false};
}

Closing::Pose Closing::from_seeds(const Eigen::VectorXd& guess,
                                  const std::function<bool(const Pose&)>& wanted) {
  Pose nearest{guess, std::numeric_limits<double>::infinity(), false};
  double least = std::numeric_limits<double>::infinity();
  const auto entries = static_cast<double>(loops_.pattern().size());
  const int seeds = std::clamp(static_cast<int>(seed_entries / (entries + 1)), 1, most_seeds);
  std::mt19937 random(1);  // the same seeds every time
  for (const double distance : seed_distances) {
    for (int i = 0; i < seeds; ++i) {
      Eigen::VectorXd step(guess.size() > 0 ? loops_.mechanism().nv() : 0);
      for (Eigen::Index k = 0; k < step.size(); ++k) {
        const double x =
            2 * (static_cast<double>(random()) / static_cast<double>(std::mt19937::max())) - 1;
        step[k] = loops_.columns[static_cast<std::size_t>(k)] ? distance * x : 0;
      }
      gap(guess);
      Pose pose = damped(loops_.moved(guess, step), seed_iterations);
      pose.is_closed = pose.is_closed && wanted(pose);
      const double way = loops_.apart(pose.q, guess);
      // Among closed ones the nearest, else the one that is open least.
      if (pose.is_closed ? way < least : !nearest.is_closed && pose.gap < nearest.gap) {
        if (pose.is_closed) least = way;
        nearest = std::move(pose);
      }
    }
    if (nearest.is_closed) break;
  }
  return nearest;
}

/// Ways for a guess near which the loops stay open.
Closing::Pose Closing::anywhere(const Eigen::VectorXd& guess, Pose open) {
  if (Pose beside = bent(open); beside.is_closed) {
    branch_ =
        "one of several assemblies, the guess does not tell which: it is stretched, and the loops "
        "close where it bends to one side or another";
    return beside;
  }
  const char* how = "by undamped steps from it";
  Pose found = undamped(guess);
  if (!found.is_closed) {
    how = "from one of several starts around it";
    found = from_seeds(guess, [](const Pose&) { return true; });
  }
  if (!found.is_closed) {
    if (found.gap < open.gap) open = std::move(found);
    open.is_stretched = is_stretched(open.q);
    return open;
  }
  char left[80] = "end where a loop has no value", text[240];
  if (std::isfinite(open.gap))
    std::snprintf(left, sizeof left, "leave the loops open by %.3g lengths or radians", open.gap);
  std::snprintf(text, sizeof text,
                "one of several assemblies perhaps: short steps from the guess %s, this one was "
                "found %s, joints moved by at most %.3g",
                left, how, loops_.apart(found.q, guess));
  branch_ = text;
  return found;
}

Closing::Pose Closing::close(const Eigen::VectorXd& guess) {
  iterations_ = 0;
  branch_.clear();
  Pose found = damped(guess, damped_iterations);
  const double way = loops_.apart(found.q, guess);
  if (found.is_closed && way <= far) return found;
  std::optional<std::vector<NewtonStep>> newton = std::move(newton_);
  Pose followed{guess, 0, false};
  const bool arrived = follow(followed.q);
  followed = damped(followed.q, damped_iterations);
  newton_.reset();
  const double other = loops_.apart(followed.q, guess);
  if (followed.is_closed && (!found.is_closed || other < 0.7 * way - far)) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "the assembly reached continuously from the guess, joints moved by at most "
                  "%.3g; Newton's steps lead to another, %.3g away",
                  other, way);
    if (found.is_closed) branch_ = text;
    return followed;
  }
  if (!found.is_closed) {
    found = anywhere(guess, followed.gap < found.gap ? followed : found);
    newton_.reset();
    return found;
  }
  newton_ = std::move(newton);
  if (!arrived)
    branch_ =
        "one of several assemblies, the guess does not tell which: on the way from there the "
        "loop equations lose rank before they close";
  return found;
}

}  // namespace momenta
