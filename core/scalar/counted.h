#pragma once
// A number that counts the operations done with it, in two ways:
//   executed  every addition, multiplication and division the code performs
//   needed    the same after constants are folded: an operation of two constants costs nothing, nor
//             does one with a constant 0 or ±1; what straight-line code for this very model would
//             do
// Changes of sign are free, subtractions count as additions; sines and cosines count separately.
// One count a thread.

#include <cmath>

namespace momenta {

/// Operations by kind.
struct Operations {
  long adds = 0;             ///< subtractions included
  long multiplications = 0;  ///< products of two numbers
  long divisions = 0;        ///< quotients of two numbers
  long angles = 0;           ///< one for each pair of sine and cosine
  /// The sum without angles.
  long total() const { return adds + multiplications + divisions; }
};

/// The two counts.
struct OperationCount {
  Operations executed;  ///< what the code performs
  Operations needed;    ///< what is left once constants are folded
};

/// A double that counts its operations; a constant unless made by variable().
class Counted {
 public:
  Counted() = default;
  /// A constant.
  Counted(double value) : value_(value) {}  // NOLINT: a constant of the model
  /// A number that changes from state to state.
  static Counted variable(double value) {
    Counted x(value);
    x.constant_ = false;
    return x;
  }

  double value() const { return value_; }  ///< the number itself

  friend Counted operator+(const Counted& a, const Counted& b) {
    ++count.executed.adds;
    if (!free(a, b) && !zero(a) && !zero(b)) ++count.needed.adds;
    return result(a.value_ + b.value_, a, b);
  }
  friend Counted operator-(const Counted& a, const Counted& b) {
    ++count.executed.adds;
    if (!free(a, b) && !zero(a) && !zero(b)) ++count.needed.adds;
    return result(a.value_ - b.value_, a, b);
  }
  friend Counted operator-(const Counted& a) {
    Counted r = a;
    r.value_ = -a.value_;
    return r;
  }
  friend Counted operator*(const Counted& a, const Counted& b) {
    ++count.executed.multiplications;
    if (!free(a, b) && !zero(a) && !zero(b) && !unit(a) && !unit(b)) ++count.needed.multiplications;
    if (zero(a) || zero(b)) return Counted(0.0);
    return result(a.value_ * b.value_, a, b);
  }
  friend Counted operator/(const Counted& a, const Counted& b) {
    ++count.executed.divisions;
    if (!free(a, b) && !zero(a) && !unit(b)) ++count.needed.divisions;
    return result(a.value_ / b.value_, a, b);
  }
  /// Counted as a sum.
  Counted& operator+=(const Counted& b) { return *this = *this + b; }
  /// Counted as a sum.
  Counted& operator-=(const Counted& b) { return *this = *this - b; }
  friend bool operator<(const Counted& a, const Counted& b) { return a.value_ < b.value_; }
  friend bool operator>(const Counted& a, const Counted& b) { return a.value_ > b.value_; }
  /// A sine and cosine of one angle count once, with the sine.
  friend Counted sin(const Counted& a) {
    ++count.executed.angles;
    if (!a.constant_) ++count.needed.angles;
    return result(std::sin(a.value_), a, a);
  }
  friend Counted cos(const Counted& a) { return result(std::cos(a.value_), a, a); }
  friend Counted sqrt(const Counted& a) { return result(std::sqrt(a.value_), a, a); }

  /// The count of this thread since it was last set to {}.
  static inline thread_local OperationCount count;

 private:
  static bool free(const Counted& a, const Counted& b) { return a.constant_ && b.constant_; }
  static bool zero(const Counted& a) { return a.constant_ && a.value_ == 0; }
  static bool unit(const Counted& a) { return a.constant_ && std::abs(a.value_) == 1; }
  static Counted result(double value, const Counted& a, const Counted& b) {
    Counted r(value);
    r.constant_ = free(a, b);
    return r;
  }

  double value_ = 0;
  bool constant_ = true;
};

/// The number itself, by the name that dual numbers use.
inline double value_of(const Counted& x) {
  return x.value();
}

}  // namespace momenta
