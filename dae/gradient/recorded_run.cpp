#include <momenta/dae/gradient/recorded_run.h>

#include <cstdio>

namespace momenta {
namespace {

/// States of all steps together: 4 GB, with those of stages 1 GB.
constexpr std::size_t most_numbers = std::size_t{1} << 29, most_with_stages = most_numbers / 4;

}  // namespace

bool RecordedRun::keep(double t0, double t1) {
  if (numbers_ + width() > most_numbers) {
    lost_ = "the states of " + std::to_string(steps_.size()) +
            " steps take 4 GB of memory; expected a shorter run, or the mode 'forward'";
    return false;
  }
  // On a fixed grid all steps but the one to the end are alike, and t1 - t0 is rounded.
  steps_.push_back({t0, t1, fixed_step_ > 0 && t1 != end_ ? fixed_step_ : t1 - t0});
  std::vector<double>& states = states_.emplace_back();
  const std::size_t all = (c_.size() + form_.has_after_step()) * width();
  if (numbers_ + all > most_with_stages) {
    states = start_;
  } else {
    states.reserve(all);
    states = start_;
    keep_stages(steps_.back(), states);
  }
  numbers_ += states.size();
  return true;
}

/// Those of the step just taken, if they are the last evaluations, or the last but for f at its
/// end.
void RecordedRun::keep_stages(const Step& step, std::vector<double>& states) {
  const std::size_t later = c_.size() - 1, places = last_.size();
  for (std::size_t behind = 0; behind < 2 && later + behind <= evaluated_; ++behind) {
    const auto at = [&](std::size_t i) -> const Evaluated& {
      return last_[(next_ + 2 * places - behind - later + i) % places];
    };
    bool these = true;
    for (std::size_t i = 0; i < later; ++i)
      these = these && at(i).t == (c_[i + 1] == 1 ? step.t1 : step.t0 + c_[i + 1] * step.h);
    if (!these) continue;
    for (std::size_t i = 0; i < later; ++i)
      states.insert(states.end(), at(i).y.begin(), at(i).y.end());
    return;
  }
}

bool RecordedRun::after_step(double t, double* y, bool& changed) {
  if (const std::size_t before = states_.size(); before > 0 && has_stages(before - 1)) {
    states_.back().insert(states_.back().end(), y, y + width());
    numbers_ += width();
  }
  if (!form_.after_step(t, y, changed)) return fail(form_.failure());
  if (!steps_.empty()) steps_.back().altered = changed;
  return true;
}

bool RecordedRun::lost_at(double t, const char* why) {
  char text[48];
  std::snprintf(text, sizeof text, "at t = %.9g s: ", t);
  lost_ = std::string(text) + why;
  return fail(lost_);
}

bool RecordedRun::rhs(double t, const double* y, double* ydot) {
  lost_.clear();
  if (!form_.rhs(t, y, ydot)) return fail(form_.failure());
  if (corrected_stages_) return lost_at(t, too_near_to_pose);
  if (looking_ > 0) return true;
  last_[next_].t = t;
  last_[next_].y.assign(y, y + width());
  next_ = (next_ + 1) % last_.size();
  ++evaluated_;
  const LoopSolver::Pivots pivots = form_.pivots();
  passages_.take(t, pivots);
  if (faded_ < 0) faded_ = pivots.faded;
  return pivots.faded == faded_ || lost_at(t, dependent_loops);
}

}  // namespace momenta
