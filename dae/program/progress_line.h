#pragma once
// Where a study is, for who waits at a terminal; and that it was interrupted.

#include <string>

namespace momenta::program {

/// From now on SIGINT and SIGTERM are noted, for verbs that look whether one came; a second one of
/// its kind ends the program where it stands.
void watch_signals();
/// True once one came: runs stop at their next step and keep what they have.
bool interrupted();

/// One line on standard error that rewrites itself on a terminal, and stays silent elsewhere.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine();
  void show(const std::string& text);
  /// Shows where a study is; false once it is interrupted.
  bool going(int number, int total, const std::string& label, double fraction);

 private:
  bool active_;
};

}  // namespace momenta::program
