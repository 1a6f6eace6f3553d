#include <momenta/dae/gradient/recorded_run.h>

#include <algorithm>
#include <cstdio>

namespace momenta {
namespace {

/// States of all steps: 4 GB, with those of stages 1 GB.
constexpr std::size_t most_numbers = std::size_t{1} << 29, most_with_stages = most_numbers / 4;

}  // namespace

bool RecordedRun::keep(double t0, double t1) {
  if (count_ + width() > most_numbers) {
    lost_ = "the states of " + std::to_string(steps_.size()) +
            " steps take 4 GB of memory; expected a shorter run, or the mode 'forward'";
    return false;
  }
  // On a fixed grid all steps but the one to the end are alike, and t1 - t0 is rounded.
  steps_.push_back({t0, t1, fixed_step_ > 0 && t1 != end_ ? fixed_step_ : t1 - t0});
  const std::size_t states = (c_.size() + form_.has_after_step()) * width(),
                    rates = with_rates_ ? c_.size() * form_.rates().size() : 0;
  const int ago = count_ + states + rates > most_with_stages ? -1 : stages_ago(steps_.back());
  const std::size_t count = ago < 0 ? width() : states;
  double* to = numbers_.next(count);
  kept_.push_back({to, ago >= 0, nullptr});
  count_ += count;
  to = std::copy(start_.begin(), start_.end(), to);
  if (ago < 0) return true;
  for (std::size_t i = 1; i < c_.size(); ++i) {
    const std::vector<double>& y = evaluated(static_cast<std::size_t>(ago) + c_.size() - 1 - i).y;
    to = std::copy(y.begin(), y.end(), to);
  }
  if (with_rates_) keep_rates(static_cast<std::size_t>(ago));
  return true;
}

/// Keeps u of all stages, the last `ago` evaluations ago.
void RecordedRun::keep_rates(std::size_t ago) {
  if (first_rates_.empty()) return;
  const std::size_t count = c_.size() * first_rates_.size();
  double* to = kept_.back().rates = numbers_.next(count);
  count_ += count;
  to = std::copy(first_rates_.begin(), first_rates_.end(), to);
  for (std::size_t i = 1; i < c_.size(); ++i) {
    const std::vector<double>& u = evaluated(ago + c_.size() - 1 - i).u;
    to = std::copy(u.begin(), u.end(), to);
  }
}

/// u at the start of a step where known before f is evaluated: after a reset, which does not change
/// it, or where f at the end of the step before is kept.
void RecordedRun::find_first_rates() {
  first_rates_.clear();
  if (reset_) {
    first_rates_ = form_.rates();
    return;
  }
  for (const Evaluated& e : last_)
    if (e.y == start_) first_rates_ = e.u;
}

int RecordedRun::stages_ago(const Step& step) const {
  const std::size_t later = c_.size() - 1;
  for (std::size_t behind = 0; behind < 2 && later + behind <= evaluated_; ++behind) {
    bool these = true;
    for (std::size_t i = 1; i <= later; ++i)
      these = these &&
              evaluated(behind + later - i).t == (c_[i] == 1 ? step.t1 : step.t0 + c_[i] * step.h);
    if (these) return static_cast<int>(behind);
  }
  return -1;
}

bool RecordedRun::after_step(double t, double* y, bool& changed) {
  if (!kept_.empty() && kept_.back().has_stages)
    std::copy(y, y + width(), kept_.back().states + c_.size() * width());
  if (!system_.after_step(t, y, changed)) return fail(system_.failure());
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
  if (!system_.rhs(t, y, ydot)) return fail(system_.failure());
  if (corrected_stages_) return lost_at(t, too_near_to_pose);
  if (looking_ > 0) return true;
  last_[next_].t = t;
  last_[next_].y.assign(y, y + width());
  if (with_rates_) {
    last_[next_].u = form_.rates();
    if (first_rates_.empty() && last_[next_].y == start_) first_rates_ = form_.rates();
  }
  next_ = (next_ + 1) % last_.size();
  ++evaluated_;
  const LoopSolver::Pivots pivots = form_.pivots();
  passages_.take(t, pivots);
  if (faded_ < 0) faded_ = pivots.faded;
  return pivots.faded == faded_ || lost_at(t, dependent_loops);
}

}  // namespace momenta
