#include <momenta/dae/gradient/recorded_run.h>

#include <cstdio>

namespace momenta {
namespace {

/// States of all steps together: 4 GB.
constexpr std::size_t most_numbers = std::size_t{1} << 29;

}  // namespace

bool RecordedRun::keep(double t0, double t1) {
  if (starts_.size() + start_.size() > most_numbers) {
    lost_ = "the states of " + std::to_string(steps_.size()) +
            " steps take 4 GB of memory; expected a shorter run, or the mode 'forward'";
    return false;
  }
  // On a fixed grid all steps but the one to the end are alike, and t1 - t0 is rounded.
  steps_.push_back({t0, t1, fixed_step_ > 0 && t1 != end_ ? fixed_step_ : t1 - t0});
  starts_.insert(starts_.end(), start_.begin(), start_.end());
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
  const LoopSolver::Pivots pivots = form_.pivots();
  passages_.take(t, pivots);
  if (faded_ < 0) faded_ = pivots.faded;
  return pivots.faded == faded_ || lost_at(t, dependent_loops);
}

}  // namespace momenta
