#pragma once
// Progress of a study on a terminal, and its interruption.

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

}  // namespace momenta::program
