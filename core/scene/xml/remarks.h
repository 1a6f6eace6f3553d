#pragma once
// What a reader leaves out or takes in a way to be known, counted: one sentence a kind, in the
// order in which they were met.

#include <exception>
#include <string>
#include <utility>
#include <vector>

namespace momenta::reading {

class Remarks {
 public:
  void count(const std::string& sentence);
  /// A sentence of its own, without a count.
  void say(const std::string& sentence) { counts_.emplace_back(sentence, 0); }
  /// A shape or a colour that is wrong in the file. Nothing moves by it: it is left out of
  /// pictures.
  void not_drawn(const std::exception& wrong);
  /// `kind` is a plural: "joint limits".
  void left_out(const std::string& kind) { count("left out: " + kind); }
  /// "left out: joint limits (12)".
  std::vector<std::string> sentences() const;

 private:
  std::vector<std::pair<std::string, int>> counts_;
};

}  // namespace momenta::reading
