#pragma once
// From the text of a formula to its tape.

#include <momenta/core/expression/tape.h>

#include <memory>
#include <string_view>
#include <vector>

namespace momenta::formula {

struct Parsed {
  Tape tape;
  std::vector<std::shared_ptr<const CubicSpline>> splines;  ///< that the tape points to
  int at = 0;                                               ///< the formula's instruction
  bool truth = false;                                       ///< whether it is a comparison
};
/// @throws ExpressionError. O(length) and lookups of names
Parsed parse(std::string_view text, FormulaNames& names);

}  // namespace momenta::formula
