#include "progress.h"

#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>

namespace momenta::program {
namespace {

volatile std::sig_atomic_t signal_came = 0;
extern "C" void take_signal(int) {
  signal_came = 1;
}

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

bool interrupted() {
  return signal_came != 0;
}

void watch_signals() {
  struct sigaction once {};
  once.sa_handler = take_signal;
  once.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  for (const int number : {SIGINT, SIGTERM}) ::sigaction(number, &once, nullptr);
}

ProgressLine::ProgressLine(bool quiet) : active_(!quiet && isatty(STDERR_FILENO) != 0) {}
ProgressLine::~ProgressLine() {
  if (active_) std::fputs("\r\x1b[K", stderr);
}
bool ProgressLine::going(int number, int total, const std::string& label, double fraction) {
  show("[" + std::to_string(number) + "/" + std::to_string(total) + "] " + label + "  " +
       std::to_string(static_cast<int>(100 * fraction)) + " %");
  return !interrupted();
}
void ProgressLine::show(const std::string& text) {
  if (active_) std::fprintf(stderr, "\r%.100s\x1b[K", text.c_str());
}

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
