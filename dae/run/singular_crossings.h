#pragma once
// Singular crossings: where a run passes poses at which its loop equations lose rank. A crossing is
// a least pivot w below 1e-2 of its scale and below 1e-2 of the largest pivot of the run; there is
// one for each passage, with a mark where the motion may have changed to another one. A pivot is
// proportional to the square of the distance to the singular pose. Loops that are weak during the
// whole run have no crossing.
//
// Inside a step that may have come near such a pose, eighths of it are looked at by halving. √w is
// that distance, up to a factor, and a distance changes no faster than what moves: between two
// looks Δt apart
//
//   √w ≥ ½ (√w₁ + √w₂ − v Δt),     v twice the largest |Δ√w|/Δt seen on the run until then
//
// and where that is above √1e-2, and above the least of the run, nothing is looked for.

#include <momenta/dae/form/ode_form.h>
#include <momenta/dae/kkt/loop_units.h>
#include <momenta/dae/run/run_form.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace momenta {

class SingularCrossings {
 public:
  /// Writes `least_pivot` and `singular_crossings` of `result`. @pre the solver's pivots are those
  /// of rows
  SingularCrossings(const Mechanism& mechanism, Form& form, Evaluation<double>& e,
                    LoopSolver& solver, RunResult& result)
      : form_(form),
        e_(e),
        solver_(solver),
        result_(result),
        phi_(mechanism.m()),
        q_(mechanism.nq()),
        at_rest_(Eigen::VectorXd::Zero(mechanism.nv())),
        unused_(mechanism.nv()),
        way_(Eigen::VectorXd::Zero(mechanism.nv())),
        rates_(rate_units(mechanism)),
        length_(length_of(mechanism.scene())) {}

  /// Looks at the step just taken; `state`: work space of the form's size.
  void step(double t0, double t1, const Interpolant& between, std::vector<double>& state) {
    const double end = pivot_at(t1, between, state);
    const bool handled =
        !form_.is_dae() && form_.ode()->wanted_handling() != SingularityHandling::none;
    if (passing_ || handled || end < 10 * near_singular)
      look_inside(t0, t1, end, between, state);
    else
      note_speed(before_, end, t1 - t0);
    note(t1, end, between, state);
    before_ = end;
  }

  /// Saves or restores, between steps, what is not in the result.
  void carry(Memory& memory) {
    memory(always_faded_), memory(largest_), memory(passing_);
    memory(before_), memory(fastest_);
    memory(has_way_), memory(way_.data(), static_cast<std::size_t>(way_.size()));
  }

  /// Drops crossings of loops that are weak throughout.
  void finish() {
    std::erase_if(result_.singular_crossings, [&](const RunResult::SingularCrossing& crossing) {
      return !(crossing.pivot < near_singular * largest_);
    });
  }

 private:
  static constexpr double near_singular = 1e-2;
  static constexpr std::size_t eighths = 8;

  /// Pivots at the eighths of a step; NaN: not measured.
  struct Looks {
    double t0, eighth;
    std::array<double, eighths + 1> pivot;
    std::array<bool, eighths + 1> looked_at;
  };

  void look_inside(double t0, double t1, double end, const Interpolant& between,
                   std::vector<double>& state) {
    Looks looks{t0, (t1 - t0) / eighths, {}, {}};
    looks.pivot.front() = before_;
    looks.pivot.back() = end;
    const auto look_at = [&](std::size_t i) {
      looks.pivot[i] = pivot_at(time_of(looks, i, t1), between, state);
      looks.looked_at[i] = true;
    };
    const auto halve = [&](const auto& self, std::size_t first, std::size_t last) -> void {
      const std::size_t middle = (first + last) / 2;
      const bool whole = last - first == eighths;
      if (middle == first || (!whole && keeps_clear(looks, first, last))) return;
      look_at(middle);
      note_speed(looks.pivot[first], looks.pivot[middle],
                 static_cast<double>(middle - first) * looks.eighth);
      note_speed(looks.pivot[middle], looks.pivot[last],
                 static_cast<double>(last - middle) * looks.eighth);
      self(self, first, middle);
      self(self, middle, last);
    };
    halve(halve, 0, eighths);
    for (std::size_t i = 1; i < eighths; ++i)
      if (looks.looked_at[i])
        note(time_of(looks, i, t1), looks.pivot[i], between, state);
      else
        passing_ = false;
  }
  static double time_of(const Looks& looks, std::size_t i, double t1) {
    return looks.t0 + (t1 - looks.t0) * static_cast<double>(i) / eighths;
  }
  void note_speed(double w1, double w2, double apart) {
    const double speed = std::abs(std::sqrt(w2) - std::sqrt(w1)) / apart;
    if (speed > fastest_ && std::isfinite(speed)) fastest_ = speed;
  }
  /// Whether the pivot between two looks is of no interest. False: a look was not measured.
  bool keeps_clear(const Looks& looks, std::size_t first, std::size_t last) const {
    const double moved = 2 * fastest_ * static_cast<double>(last - first) * looks.eighth;
    const double least =
        0.5 * (std::sqrt(looks.pivot[first]) + std::sqrt(looks.pivot[last]) - moved);
    return least > std::sqrt(near_singular) && least > std::sqrt(result_.least_pivot);
  }

  /// The weakest pivot of the loops at a time within the last step; 0 where a row faded that is not
  /// redundant throughout.
  double pivot_at(double t, const Interpolant& between, std::vector<double>& state) {
    between(t, state.data());
    if (!form_.read_coordinates(t, state.data(), q_)) return not_measured;
    if (!solver_.free_velocity(t, q_.data(), at_rest_.data(), unused_.data())) return not_measured;
    const LoopSolver::Pivots pivots = solver_.pivots();
    always_faded_ = std::min(always_faded_, pivots.faded);
    return pivots.faded > always_faded_ ? 0 : pivots.weakest;
  }

  void note(double t, double pivot, const Interpolant& between, std::vector<double>& state) {
    if (std::isnan(pivot)) return;
    if (!(result_.least_pivot <= pivot)) result_.least_pivot = pivot;
    largest_ = std::max(largest_, pivot);
    if (pivot >= near_singular) {
      passing_ = false;
      return;
    }
    if (!passing_) {
      result_.singular_crossings.push_back({t, pivot});
      has_way_ = false;
    }
    passing_ = true;
    RunResult::SingularCrossing& last = result_.singular_crossings.back();
    last.ambiguous = last.ambiguous || is_ambiguous(t, pivot, between, state);
    if (!(pivot < last.pivot)) return;
    last.t = t;
    last.pivot = pivot;
  }

  /// Two motions that meet where a pivot vanishes with the square of the distance, Φ = x y = 0,
  /// keep clear of each other off the constraints, Φ = x y = η: no nearer than √η, where the pivot
  /// is about η, and there either leads into the other. Steps seldom end just there; where rates
  /// within some thirty √η turn onto another line, one did lead into the other.
  bool is_ambiguous(double t, double pivot, const Interpolant& between,
                    std::vector<double>& state) {
    constexpr double meeting = 10, near = 1000;
    const auto over_gap = [&](const Eigen::VectorXd& q) {
      e_.place(t, q.data());
      e_.positions(phi_.data());
      const double gap = phi_.norm() / length_;
      return gap > rounding_level ? pivot / gap : std::numeric_limits<double>::infinity();
    };
    between(t, state.data());
    // Corrections bring q nearer to the constraints: they are spared if it is near enough.
    if (!form_.read_coordinates(t, state.data(), q_)) return false;
    if (!has_way_ && !(over_gap(q_) < near)) return false;
    if (!form_.read(t, state.data(), nullptr, here_)) return false;
    const double ratio = over_gap(here_.q);
    if (ratio < meeting) return true;
    const bool turned = has_way_ && turns(here_.u);
    if (!has_way_) way_ = here_.u;
    has_way_ = ratio < near;
    return turned;
  }

  /// Whether u turns more than half a radian off way_, angles and lengths of the scene alike.
  bool turns(const Eigen::VectorXd& u) const {
    const auto before = way_.cwiseQuotient(rates_), now = u.cwiseQuotient(rates_);
    return std::abs(before.dot(now)) < std::cos(0.5) * before.norm() * now.norm();
  }

  Form& form_;
  Evaluation<double>& e_;
  LoopSolver& solver_;
  RunResult& result_;
  Eigen::VectorXd phi_, q_, at_rest_, unused_;
  Snapshot here_;
  Eigen::VectorXd way_;    ///< u where this crossing came near another motion
  Eigen::VectorXd rates_;  ///< units: a radian, or the length of the scene
  double length_;          ///< length of the scene [m]
  bool has_way_ = false;
  int always_faded_ = std::numeric_limits<int>::max();
  double largest_ = 0;            ///< largest pivot of the run
  double before_ = not_measured;  ///< pivot at the end of the step before
  double fastest_ = 0;            ///< largest |Δ√w|/Δt of the run [1/s]
  bool passing_ = false;
};

}  // namespace momenta
