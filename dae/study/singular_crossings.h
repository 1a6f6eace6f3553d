#pragma once
// Singular crossings: where a run passes poses at which its loop equations lose rank. A crossing is
// a least pivot below 1e-2 of its scale and below 1e-2 of the largest pivot of the run; there is
// one for each passage, with a mark where the motion may have changed to another one. A pivot is
// proportional to the square of the distance to the singular pose. Loops that are weak during the
// whole run have no crossing.

#include <momenta/dae/form/ode_form.h>
#include <momenta/dae/study/run_form.h>

#include <algorithm>
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
        length_(length_of(mechanism.scene())) {}

  /// Of the step just taken; `state`: work space of the form's size.
  void step(double t0, double t1, const Interpolant& between, std::vector<double>& state) {
    constexpr int closer_looks = 8;
    const double end = pivot_at(t1, between, state);
    const bool handled =
        !form_.is_dae() && form_.ode()->wanted_handling() != SingularityHandling::none;
    if (passing_ || handled || end < 10 * near_singular)
      for (int i = 1; i < closer_looks; ++i) {
        const double t = t0 + (t1 - t0) * i / closer_looks;
        note(t, pivot_at(t, between, state), between, state);
      }
    note(t1, end, between, state);
  }

  /// Between two steps; beside what is in the result.
  void carry(Memory& memory) { memory(always_faded_), memory(largest_), memory(passing_); }

  /// After the last step.
  void finish() {
    std::erase_if(result_.singular_crossings, [&](const RunResult::SingularCrossing& crossing) {
      return !(crossing.pivot < near_singular * largest_);
    });
  }

 private:
  static constexpr double near_singular = 1e-2;

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
    if (!passing_) result_.singular_crossings.push_back({t, pivot});
    passing_ = true;
    RunResult::SingularCrossing& last = result_.singular_crossings.back();
    last.ambiguous = last.ambiguous || is_ambiguous(t, pivot, between, state);
    if (!(pivot < last.pivot)) return;
    last.t = t;
    last.pivot = pivot;
  }

  /// Two motions that meet where a pivot vanishes with the square of the distance, Φ = x y = 0,
  /// keep clear of each other off the constraints, Φ = x y = η: no nearer than √η, where the pivot
  /// is about η, and there either leads into the other.
  bool is_ambiguous(double t, double pivot, const Interpolant& between,
                    std::vector<double>& state) {
    constexpr double apart = 10;
    between(t, state.data());
    if (!form_.read(t, state.data(), nullptr, here_)) return false;
    e_.place(t, here_.q.data());
    e_.positions(phi_.data());
    const double gap = phi_.norm() / length_;
    return gap > rounding_level && pivot < apart * gap;
  }

  Form& form_;
  Evaluation<double>& e_;
  LoopSolver& solver_;
  RunResult& result_;
  Eigen::VectorXd phi_, q_, at_rest_, unused_;
  Snapshot here_;
  double length_;  ///< of the scene [m]
  int always_faded_ = std::numeric_limits<int>::max();
  double largest_ = 0;  ///< pivot on the run
  bool passing_ = false;
};

}  // namespace momenta
