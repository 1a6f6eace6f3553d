#include <momenta/core/expression/formula_text.h>
#include <momenta/core/expression/tape.h>
#include <momenta/core/expression/written.h>

#include <cmath>
#include <stdexcept>

namespace momenta {
namespace {

using formula::Instruction;
using formula::Operation;
using formula::Tape;

}  // namespace

std::vector<Written> Written::variables(int count) {
  const auto tape = std::make_shared<Tape>();
  std::vector<Written> all;
  for (int i = 0; i < count; ++i) all.push_back(Written(tape, tape->add(Operation::variable, i)));
  return all;
}

std::string Written::text(std::span<const std::string> names) const {
  Tape tape;
  int output = place_;
  if (!tape_) output = tape.number(number_);
  std::vector<int> at{output};
  const std::vector<Instruction> needed = (tape_ ? *tape_ : tape).needed_for(at);
  return formula::text_of(needed, at.front(), names);
}

Written Written::of(Operation o, const Written& a, const Written* b, const Written* c,
                    double number) {
  std::shared_ptr<Tape> tape;
  for (const Written* w : {&a, b, c}) {
    if (!w || !w->tape_) continue;
    if (tape && tape != w->tape_)
      throw std::logic_error(
          "a formula has variables of two calls of Written::variables in it, expected those of "
          "one: has a number been kept from another formula?");
    tape = w->tape_;
  }
  Tape numbers;  // turns an operation of numbers into a number
  Tape& all = tape ? *tape : numbers;
  const auto place = [&](const Written* w) {
    return !w ? -1 : w->tape_ ? w->place_ : all.number(w->number_);
  };
  const int left = place(&a), right = place(b), last = place(c);
  const int result = all.add({o, left, right, last, number});
  const Instruction& in = all[result];
  return in.operation == Operation::number ? Written(in.number) : Written(tape, result);
}

Written operator+(const Written& a, const Written& b) {
  return Written::of(Operation::add, a, &b);
}
Written operator-(const Written& a, const Written& b) {
  return Written::of(Operation::subtract, a, &b);
}
Written operator*(const Written& a, const Written& b) {
  return Written::of(Operation::multiply, a, &b);
}
Written operator/(const Written& a, const Written& b) {
  return Written::of(Operation::divide, a, &b);
}
Written operator-(const Written& a) {
  return Written::of(Operation::negative, a);
}

WrittenTruth operator<(const Written& a, const Written& b) {
  return WrittenTruth(Written::of(Operation::less, a, &b));
}
WrittenTruth operator<=(const Written& a, const Written& b) {
  return WrittenTruth(Written::of(Operation::less_equal, a, &b));
}
WrittenTruth operator>(const Written& a, const Written& b) {
  return b < a;
}
WrittenTruth operator>=(const Written& a, const Written& b) {
  return b <= a;
}
WrittenTruth operator==(const Written& a, const Written& b) {
  return WrittenTruth(Written::of(Operation::equal, a, &b));
}
WrittenTruth operator!=(const Written& a, const Written& b) {
  return WrittenTruth(Written::of(Operation::unequal, a, &b));
}
WrittenTruth operator&&(const WrittenTruth& a, const WrittenTruth& b) {
  return WrittenTruth(Written::of(Operation::both, a.value_, &b.value_));
}
WrittenTruth operator||(const WrittenTruth& a, const WrittenTruth& b) {
  return WrittenTruth(Written::of(Operation::either, a.value_, &b.value_));
}
WrittenTruth operator!(const WrittenTruth& a) {
  return WrittenTruth(Written::of(Operation::opposite, a.value_));
}
Written choose(const WrittenTruth& c, const Written& a, const Written& b) {
  if (!c.value_.tape_) return c.value_.number_ != 0 ? a : b;
  return Written::of(Operation::choice, c.value_, &a, &b);
}

Written sin(const Written& a) {
  return Written::of(Operation::sin, a);
}
Written cos(const Written& a) {
  return Written::of(Operation::cos, a);
}
Written tan(const Written& a) {
  return Written::of(Operation::tan, a);
}
Written asin(const Written& a) {
  return Written::of(Operation::asin, a);
}
Written acos(const Written& a) {
  return Written::of(Operation::acos, a);
}
Written atan(const Written& a) {
  return Written::of(Operation::atan, a);
}
Written sinh(const Written& a) {
  return Written::of(Operation::sinh, a);
}
Written cosh(const Written& a) {
  return Written::of(Operation::cosh, a);
}
Written tanh(const Written& a) {
  return Written::of(Operation::tanh, a);
}
Written exp(const Written& a) {
  return Written::of(Operation::exp, a);
}
Written log(const Written& a) {
  return Written::of(Operation::log, a);
}
Written sqrt(const Written& a) {
  return Written::of(Operation::sqrt, a);
}
Written abs(const Written& a) {
  return Written::of(Operation::abs, a);
}
Written floor(const Written& a) {
  return Written::of(Operation::floor, a);
}
Written atan2(const Written& y, const Written& x) {
  return Written::of(Operation::atan2, y, &x);
}
Written hypot(const Written& a, const Written& b) {
  return Written::of(Operation::hypot, a, &b);
}
Written min(const Written& a, const Written& b) {
  return Written::of(Operation::min, a, &b);
}
Written max(const Written& a, const Written& b) {
  return Written::of(Operation::max, a, &b);
}
Written pow(const Written& base, const Written& exponent) {
  const double e = exponent.number_;
  if (!exponent.tape_ && e == std::floor(e) && std::abs(e) <= 1000)
    return Written::of(Operation::whole_power, base, nullptr, nullptr, e);
  return Written::of(Operation::power, base, &exponent);
}

}  // namespace momenta
