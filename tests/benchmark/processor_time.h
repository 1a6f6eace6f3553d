#pragma once
// Processor time of this process, and the least a call takes.

#include <algorithm>
#include <cmath>
#include <ctime>

namespace momenta {

/// [s]
inline double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Least of five or more calls, fewer if they take seconds [ms].
template <class F>
double least_ms(F&& f) {
  constexpr double enough = 0.2, too_much = 5;
  double least = HUGE_VAL, spent = 0;
  for (int i = 0; (i < 5 || (spent < enough && i < 1000)) && spent < too_much; ++i) {
    const double from = processor_seconds();
    f();
    const double took = processor_seconds() - from;
    least = std::min(least, took);
    spent += took;
  }
  return 1e3 * least;
}

}  // namespace momenta
