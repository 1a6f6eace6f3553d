#pragma once
// Text of a tape that parses to the same tape.

#include <momenta/core/expression/instruction.h>

#include <span>
#include <string>
#include <vector>

namespace momenta::formula {

/// The formula of instruction `output`, with these names for its variables. Where repeated parts
/// make it long, or depth exceeds the parser's, it begins with definitions "s1 := …; ". @throws
/// std::logic_error where a number is not finite. O(tape)
std::string text_of(const std::vector<Instruction>& tape, int output,
                    std::span<const std::string> names);

}  // namespace momenta::formula
