#pragma once
// Remarks of a reader on what it leaves out or interprets: one counted sentence a kind, in order of
// occurrence.

#include <exception>
#include <string>
#include <utility>
#include <vector>

namespace momenta::reading {

class Remarks {
 public:
  void count(const std::string& sentence);
  /// Adds a sentence without a count.
  void say(const std::string& sentence) { counts_.emplace_back(sentence, 0); }
  /// Counts a shape or colour with a fault. It has no effect on motion: it is left out of pictures.
  void not_drawn(const std::exception& wrong);
  /// `kind` is a plural: "joint limits".
  void left_out(const std::string& kind) { count("left out: " + kind); }
  /// "left out: joint limits (12)".
  std::vector<std::string> sentences() const;

 private:
  std::vector<std::pair<std::string, int>> counts_;
};

}  // namespace momenta::reading
