#pragma once
// Steps: a tape for plain numbers. Their line holds the numbers of the formula, then its variables,
// then the results of steps. Up to three arithmetic operations whose results nothing else takes
// make one step,
//
//   (a ∘ b) ∘ (c ∘ d),   ((a ∘ b) ∘ c) ∘ d,   (a ∘ b) ∘ c,   a ∘ b,
//
// each rounded by itself, as on the tape; a sine and a cosine of one number make one too. A step
// costs one jump instead of two to four, and values within it stay in registers.

#include <momenta/core/expression/instruction.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace momenta::formula {

/// One step: line[to] from line[a], line[b], …
struct Step {
  std::uint16_t act = 0;  ///< an entry of the table of acts (run_steps.h)
  std::int16_t n = 0;     ///< whole exponent, or order of a spline's derivative
  std::int32_t to = 0;
  std::int32_t a = 0, b = 0, c = 0, d = 0;
  const CubicSpline* spline = nullptr;
};

/// Second and third operations may take the result before on either side.
enum class Arithmetic : std::uint8_t { add, subtract, multiply, divide, from, under };
constexpr int forward_arithmetic = 4;  ///< a ∘ b
constexpr int all_arithmetic = 6;      ///< also c − ab and c / ab

// The table of acts: functions and comparisons by their operation, powers by their exponent, then
// arithmetic.
constexpr int power_acts = 48;
constexpr int highest_power = 12;  ///< higher powers are computed by a loop
constexpr int single_acts = 64;
constexpr int pair_acts = single_acts + forward_arithmetic;
constexpr int chain_acts = pair_acts + forward_arithmetic * all_arithmetic;
constexpr int tree_acts = chain_acts + forward_arithmetic * all_arithmetic * all_arithmetic;
constexpr int sine_and_cosine =
    tree_acts + forward_arithmetic * forward_arithmetic * forward_arithmetic;
constexpr int acts = sine_and_cosine + 1;

struct Steps {
  std::vector<double> numbers;  ///< start of the line
  std::vector<int> variables;   ///< variables, behind the numbers
  std::vector<Step> all;
  std::vector<int> outputs;  ///< places on the line
  std::size_t line = 0;      ///< places on the line, never more than the tape has
};

/// @pre operands stand before what takes them. O(tape)
Steps steps_of(const std::vector<Instruction>& tape, const std::vector<int>& outputs);
/// Values of the outputs at x. `line` has room for `steps.line` numbers.
void run(const Steps& steps, const double* x, double* line, double* values);

}  // namespace momenta::formula
