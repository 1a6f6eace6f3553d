#pragma once
// Progress of a verb on a terminal, its interruption, and its limit of CPU time.

#include <string>

namespace momenta::program {

/// Notes SIGINT and SIGTERM for interrupted(); a second one ends the program at once.
void watch_signals();
/// Whether a signal came: runs stop at their next step and keep results.
bool interrupted();

/// One line on standard error, rewritten on a terminal, silent elsewhere.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine();
  void show(const std::string& text);
  /// False once interrupted.
  bool going(int number, int total, const std::string& label, double fraction);

 private:
  bool active_;
};

/// --cpu-limit of verbs without runs: at the limit the program ends with a sentence and status 1,
/// before it writes anything.
class CpuLimit {
 public:
  /// Limit [s] from now, after `spent`; 0: none. The last object counts.
  explicit CpuLimit(double seconds, double spent = 0);
  ~CpuLimit() { lift(); }
  CpuLimit(const CpuLimit&) = delete;
  CpuLimit& operator=(const CpuLimit&) = delete;
  /// Ends the limit, for write_results().
  static void lift();
};

}  // namespace momenta::program
