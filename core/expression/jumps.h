#pragma once
// Operations of formulas that are not smooth.

#include <momenta/core/expression/instruction.h>

namespace momenta::formula {

/// Whether its value jumps where its argument, or the difference of its two, is zero or, for
/// `floor`, whole.
constexpr bool jumps(Operation o) {
  return o == Operation::less || o == Operation::less_equal || o == Operation::sign ||
         o == Operation::floor;
}
/// Whether its derivative jumps where its argument, or the difference of its two, is zero.
constexpr bool has_corner(Operation o) {
  return o == Operation::abs || o == Operation::min || o == Operation::max;
}

}  // namespace momenta::formula
