#pragma once
// A tape as the text that is parsed to it.

#include <momenta/core/expression/instruction.h>

#include <span>
#include <string>
#include <vector>

namespace momenta::formula {

/// The formula of instruction `output`, with these names for its variables. A text that would be
/// long, since what is used twice stands twice, or deeper than the parser goes, has definitions
/// "s1 := …; " before it. @throws std::logic_error where a number is infinite or none. O(tape)
std::string text_of(const std::vector<Instruction>& tape, int output,
                    std::span<const std::string> names);

}  // namespace momenta::formula
