#include "progress_line.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>

namespace momenta::program {
namespace {

volatile std::sig_atomic_t signal_came = 0;
extern "C" void take_signal(int) {
  signal_came = 1;
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

}  // namespace momenta::program
