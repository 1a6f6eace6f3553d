#pragma once
// Runs of CVODE, IDA and our implicit methods: one internal step at a time up to a stop time, the
// observer after each, output times by the method's own dense output, limits, and where the run
// ended.

#include <momenta/dae/integrator/integration.h>
#include <momenta/dae/integrator/output_cursor.h>
#include <momenta/dae/integrator/stopping.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// `Method` provides
///   const char* name();  double* y();  double* ydot() (null for an ODE), both at the step's end;
///   bool step(double& t, double end, std::string& cause);   one accepted step, t becomes its end;
///   bool at(double t, double* y, double* ydot);             within the last step, ydot may be
///   null;
///   bool sample(double t, double* y, double* ydot);         the same for output times, where at()
///   is less accurate than the steps' ends; may be left out;
///   takes_start                                             where formulas are evaluated at a
///   step's start; may be left out.
template <class Method>
class MultistepRun {
 public:
  MultistepRun(Method& method, int size, double t0, const std::vector<double>& output_times,
               const IntegrationOptions& options, const Observer& observer)
      : method_(method),
        options_(options),
        observer_(observer),
        outputs_(t0, output_times),
        cpu_(options.max_cpu_seconds, options.spent_cpu_seconds),
        t_(t0),
        begun_(t0),
        y_(static_cast<std::size_t>(size)),
        ydot_(static_cast<std::size_t>(size)) {}

  double end() const { return outputs_.end(); }

  /// Steps to the end. Fills the result but for its counters.
  void run(IntegrationResult& result) {
    stop_time_ = t_;
    result.done = sample_start(result) && steps(result);
    result.end_time = stop_time_;
    if (result.y.empty()) result.y.assign(method_.y(), method_.y() + y_.size());
  }

 private:
  bool steps(IntegrationResult& result) {
    const Interpolant between = [this](double t, double* y) {
      if (!method_.at(t, y, nullptr)) interpolation_failed_ = true;
    };
    if (observer_.exact)
      observer_.exact([this](double t, double* y) {
        if (!dense_output(t, y, ydot_.data())) interpolation_failed_ = true;
      });
    Pace pace(0, t_, end(), options_.max_steps);
    for (long count = 0; t_ < end(); ++count) {
      if (count >= options_.max_steps)
        return stop(result,
                    "the limit of " + std::to_string(options_.max_steps) + " steps is reached");
      if (!(cpu_.seconds() > 0) && pace.is_hopeless(count, t_))
        return stop(result, pace.in_words());
      if (cpu_.exceeded()) {
        result.reason = time_limit_sentence(method_.name(), cpu_.seconds(), t_);
        return false;
      }
      const double t0 = t_;
      std::string cause;
      if (!method_.step(t_, options_.stop_behind(t_, end(), jump()), cause)) {
        t_ = t0;
        return stop(result, cause);
      }
      stop_time_ = t_;
      if (observer_.step) {
        const bool go_on = observer_.step(t0, t_, between);
        if (interpolation_failed_) return stop(result, "dense output of the last step failed");
        if (!go_on) return stop(result, "the observer ended the run");
      }
      for (; outputs_.due(t_); outputs_.advance())
        if (!sample(outputs_.time(), result)) return false;
    }
    return true;
  }

  /// Distance of stops before and behind a jump (core/expression/input_times.h). Methods that
  /// evaluate nothing at a step's start need no step across it, by whose length multipliers would
  /// be divided.
  double jump() const {
    if constexpr (requires { Method::takes_start; })
      return 0;
    else
      return 1e-11 * std::max(std::abs(begun_), std::abs(end()));
  }

  bool sample_start(IntegrationResult& result) {
    for (; outputs_.due(t_); outputs_.advance())
      if (observer_.sample && !observer_.sample(outputs_.time(), method_.y(), method_.ydot()))
        return stop(result, "the observer ended the run");
    return true;
  }

  bool sample(double t, IntegrationResult& result) {
    if (!observer_.sample) return true;
    const bool has_rates = method_.ydot() != nullptr;
    if (!dense_output(t, y_.data(), has_rates ? ydot_.data() : nullptr))
      return stop(result, "dense output of the last step failed");
    if (observer_.sample(t, y_.data(), has_rates ? ydot_.data() : nullptr)) return true;
    stop_time_ = t;
    result.y = y_;
    return stop(result, "the observer ended the run");
  }

  bool dense_output(double t, double* y, double* ydot) {
    if constexpr (requires { method_.sample(t, y, ydot); })
      return method_.sample(t, y, ydot);
    else
      return method_.at(t, y, ydot);
  }

  bool stop(IntegrationResult& result, const std::string& cause) {
    result.reason = stop_sentence(method_.name(), stop_time_, cause);
    return false;
  }

  Method& method_;
  const IntegrationOptions& options_;
  const Observer& observer_;
  OutputCursor outputs_;
  CpuLimit cpu_;
  double t_, begun_, stop_time_ = 0;
  bool interpolation_failed_ = false;
  std::vector<double> y_, ydot_;
};

}  // namespace momenta
