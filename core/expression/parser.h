#pragma once
// Parser of formulas: from text to tape.

#include <momenta/core/expression/tape.h>

#include <memory>
#include <string_view>
#include <vector>

namespace momenta::formula {

struct Parsed {
  Tape tape;
  std::vector<std::shared_ptr<const CubicSpline>> splines;  ///< functions by points on the tape
  int at = 0;                                               ///< instruction of the formula
  bool truth = false;                                       ///< whether it is a comparison
};
/// @throws ExpressionError. O(length) and lookups of names
Parsed parse(std::string_view text, FormulaNames& names);

}  // namespace momenta::formula
