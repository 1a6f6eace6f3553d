#pragma once
// Limits on steps and time, and the one sentence on why a run stops before its end.

#include <cstdio>
#include <ctime>
#include <string>

#ifndef CLOCK_THREAD_CPUTIME_ID
#include <chrono>
#endif

namespace momenta {

struct IntegrationOptions;  // integration.h

/// @throws std::invalid_argument for tolerances of `method` that are not positive.
void expect_tolerances(const IntegrationOptions& options, const std::string& method);
/// @throws std::invalid_argument where `method`, which has no other, has no step > 0.
void expect_fixed_step(const IntegrationOptions& options, const std::string& method);

/// Short decimal form for sentences; results are never printed with it.
inline std::string in_words(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", x);
  return text;
}

/// "dp5 stopped at t = 0.5 s: cause"; a cause that begins with its own time keeps that one.
inline std::string stop_sentence(const std::string& method, double t, const std::string& cause) {
  if (cause.rfind("at t = ", 0) == 0) return method + " stopped " + cause;
  return method + " stopped at t = " + in_words(t) + " s: " + cause;
}

/// The system's sentence on its failing evaluation, or that it failed.
inline std::string evaluation_cause(const std::string& failure) {
  return failure.empty() ? "an evaluation of the equations failed" : failure;
}

inline std::string time_limit_sentence(const std::string& method, double limit, double t) {
  return "time limit of " + in_words(limit) + " s of CPU time reached by " + method +
         " at t = " + in_words(t) + " s";
}

/// CPU time of the calling thread [s].
inline double thread_seconds() {
#ifdef CLOCK_THREAD_CPUTIME_ID
  std::timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
#else
  using std::chrono::steady_clock;
  return std::chrono::duration<double>(steady_clock::now().time_since_epoch()).count();
#endif
}

/// CPU time of the calling thread since construction against a limit. Reads the clock about every
/// hundredth of a second, after 64 calls at the latest: a read takes 0.2-1 us.
class CpuLimit {
 public:
  /// `spent`: part of the limit used before.
  explicit CpuLimit(double seconds, double spent = 0)
      : limit_(seconds), start_(seconds > 0 ? thread_seconds() - spent : 0) {}
  double seconds() const { return limit_; }
  bool exceeded() {
    if (!(limit_ > 0) || ++calls_ < between_) return false;
    const double now = thread_seconds() - start_;
    between_ = now - last_ > 0.01 ? (between_ + 1) / 2 : between_ < 64 ? 2 * between_ : 64;
    calls_ = 0;
    last_ = now;
    return now > limit_;
  }

 private:
  double limit_, start_;
  double last_ = 0;               ///< last look [s]
  long calls_ = 0, between_ = 1;  ///< since the last look; until the next
};

/// A run without a limit of time against that of its steps: once thirty thousand were so short that
/// the limit would be reached before the end, it stops.
class Pace {
 public:
  /// `count`: steps before t0.
  Pace(long count, double t0, double end, long limit)
      : at_(t0), end_(end), limit_(limit), next_(count + looked_at) {}
  bool is_hopeless(long count, double t) {
    if (count < next_) return false;
    per_step_ = (t - at_) / static_cast<double>(looked_at);
    at_ = t;
    next_ = count + looked_at;
    return static_cast<double>(limit_ - count) * per_step_ < end_ - t;
  }
  std::string in_words() const {
    return "its last " + std::to_string(looked_at) + " steps took " + in_seconds(per_step_) +
           " each, and at that pace the limit of " + std::to_string(limit_) +
           " steps is reached before the end; expected equations without jumps and poles there, "
           "a method for stiff ones, or a larger tolerance";
  }

 private:
  static constexpr long looked_at = 30'000;
  static std::string in_seconds(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1e s", x);
    return text;
  }

  double at_, end_, per_step_ = 0;
  long limit_, next_;
};

}  // namespace momenta
