#pragma once
// Functions of formulas in quad precision.

#include <momenta/core/expression/functions.h>
#include <momenta/core/scalar/quad.h>

namespace momenta::formula {

template <>
struct Functions<Quad> {
  static bool is_zero(const Quad& x) { return x.v == 0; }
  static Quad of(Operation o, const Quad& a) {
    switch (o) {
      case Operation::sin:
        return sin(a);
      case Operation::cos:
        return cos(a);
      case Operation::tan:
        return Quad::of(tanq(a.v));
      case Operation::asin:
        return Quad::of(asinq(a.v));
      case Operation::acos:
        return Quad::of(acosq(a.v));
      case Operation::atan:
        return Quad::of(atanq(a.v));
      case Operation::sinh:
        return Quad::of(sinhq(a.v));
      case Operation::cosh:
        return Quad::of(coshq(a.v));
      case Operation::tanh:
        return Quad::of(tanhq(a.v));
      case Operation::exp:
        return Quad::of(expq(a.v));
      case Operation::log:
        return Quad::of(logq(a.v));
      default:
        return sqrt(a);
    }
  }
  static Quad of(Operation o, const Quad& a, const Quad& b) {
    switch (o) {
      case Operation::power:
        return Quad::of(powq(a.v, b.v));
      case Operation::atan2:
        return Quad::of(atan2q(a.v, b.v));
      default:
        return Quad::of(hypotq(a.v, b.v));
    }
  }
};

}  // namespace momenta::formula
