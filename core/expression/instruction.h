#pragma once
// One instruction of a formula's tape.

#include <cstdint>

namespace momenta {
class CubicSpline;  // core/expression/spline.h
}

namespace momenta::formula {

enum class Operation : std::uint8_t {
  number,
  variable,
  negative,
  add,
  subtract,
  multiply,
  divide,
  power,
  whole_power,
  less,
  less_equal,
  equal,
  unequal,
  both,
  either,
  opposite,
  choice,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  sinh,
  cosh,
  tanh,
  exp,
  log,
  sqrt,
  abs,
  sign,
  floor,
  atan2,
  hypot,
  min,
  max,
  spline
};
struct Instruction {
  Operation operation = Operation::number;
  int a = -1, b = -1, c = -1;  ///< instructions before; a of a variable is its number
  double number = 0;           ///< exponent of a whole power, order of a spline's derivative
  const CubicSpline* spline = nullptr;  ///< kept by the formula
};

}  // namespace momenta::formula
