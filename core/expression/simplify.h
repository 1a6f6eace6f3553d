#pragma once
// Instructions added to a tape, simplified by what holds of all real numbers,
//
//   0 + x = x,   x − 0 = x,   0 x = 0,   1 x = x,   0 / x = 0,   x / 1 = x,   x¹ = x,   −(−x) = x,
//
// so that a derivative that vanishes for every x is visibly the number 0. (0 x = 0 holds for finite
// x: a formula without value there then has one.)

#include <momenta/core/expression/tape.h>

#include <span>
#include <vector>

namespace momenta::formula {

/// The place of an instruction, or of its equal.
int add_simplified(Tape& tape, Instruction in);

/// Adds all instructions of another tape, in order; its variable v stands for place variables[v] of
/// this one, or, where that is −1 or missing, for itself. Returns their places.
std::vector<int> add_simplified(Tape& tape, std::span<const Instruction> written,
                                std::span<const int> variables);

}  // namespace momenta::formula
