#include "cpu_limit.h"

#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>

namespace momenta::program {
namespace {

char notice[160];  // text for a signal handler

extern "C" void end_here(int) {
  const auto length = std::strlen(notice);
  const auto written = write(STDERR_FILENO, notice, length);
  _exit(written < 0 ? 2 : 1);
}

void set_timer(double seconds) {
  itimerval timer{};
  timer.it_value.tv_sec = static_cast<time_t>(seconds);
  timer.it_value.tv_usec = static_cast<suseconds_t>((seconds - std::floor(seconds)) * 1e6);
  setitimer(ITIMER_PROF, &timer, nullptr);
}

}  // namespace

CpuLimit::CpuLimit(double seconds, double spent) {
  lift();
  if (!(seconds > 0)) return;
  std::snprintf(notice, sizeof notice,
                "momenta: stopped after %.3g s of CPU time, with no result; expected it within "
                "--cpu-limit\n",
                spent + seconds);
  std::signal(SIGPROF, end_here);
  set_timer(std::clamp(seconds, 1e-6, 1e9));
}

void CpuLimit::lift() {
  set_timer(0);
}

}  // namespace momenta::program
