#include <momenta/core/expression/formula_text.h>
#include <momenta/core/expression/tape.h>
#include <momenta/core/expression/traced.h>

#include <cmath>
#include <stdexcept>

namespace momenta {
namespace {

using formula::Instruction;
using formula::Operation;
using formula::Tape;

}  // namespace

std::vector<Traced> Traced::variables(int count) {
  const auto tape = std::make_shared<Tape>();
  std::vector<Traced> all;
  for (int i = 0; i < count; ++i) all.push_back(Traced(tape, tape->add(Operation::variable, i)));
  return all;
}

std::string Traced::text(std::span<const std::string> names) const {
  Tape tape;
  int output = place_;
  if (!tape_) output = tape.number(number_);
  std::vector<int> at{output};
  const std::vector<Instruction> needed = (tape_ ? *tape_ : tape).needed_for(at);
  return formula::text_of(needed, at.front(), names);
}

Traced Traced::of(Operation o, const Traced& a, const Traced* b, const Traced* c, double number) {
  std::shared_ptr<Tape> tape;
  for (const Traced* w : {&a, b, c}) {
    if (!w || !w->tape_) continue;
    if (tape && tape != w->tape_)
      throw std::logic_error(
          "a formula has variables of two calls of Traced::variables in it, expected those of "
          "one: has a number been kept from another formula?");
    tape = w->tape_;
  }
  Tape numbers;  // turns an operation of numbers into a number
  Tape& all = tape ? *tape : numbers;
  const auto place = [&](const Traced* w) {
    return !w ? -1 : w->tape_ ? w->place_ : all.number(w->number_);
  };
  const int left = place(&a), right = place(b), last = place(c);
  const int result = all.add({o, left, right, last, number});
  const Instruction& in = all[result];
  return in.operation == Operation::number ? Traced(in.number) : Traced(tape, result);
}

Traced operator+(const Traced& a, const Traced& b) {
  return Traced::of(Operation::add, a, &b);
}
Traced operator-(const Traced& a, const Traced& b) {
  return Traced::of(Operation::subtract, a, &b);
}
Traced operator*(const Traced& a, const Traced& b) {
  return Traced::of(Operation::multiply, a, &b);
}
Traced operator/(const Traced& a, const Traced& b) {
  return Traced::of(Operation::divide, a, &b);
}
Traced operator-(const Traced& a) {
  return Traced::of(Operation::negative, a);
}

TracedTruth operator<(const Traced& a, const Traced& b) {
  return TracedTruth(Traced::of(Operation::less, a, &b));
}
TracedTruth operator<=(const Traced& a, const Traced& b) {
  return TracedTruth(Traced::of(Operation::less_equal, a, &b));
}
TracedTruth operator>(const Traced& a, const Traced& b) {
  return b < a;
}
TracedTruth operator>=(const Traced& a, const Traced& b) {
  return b <= a;
}
TracedTruth operator==(const Traced& a, const Traced& b) {
  return TracedTruth(Traced::of(Operation::equal, a, &b));
}
TracedTruth operator!=(const Traced& a, const Traced& b) {
  return TracedTruth(Traced::of(Operation::unequal, a, &b));
}
TracedTruth operator&&(const TracedTruth& a, const TracedTruth& b) {
  return TracedTruth(Traced::of(Operation::both, a.value_, &b.value_));
}
TracedTruth operator||(const TracedTruth& a, const TracedTruth& b) {
  return TracedTruth(Traced::of(Operation::either, a.value_, &b.value_));
}
TracedTruth operator!(const TracedTruth& a) {
  return TracedTruth(Traced::of(Operation::opposite, a.value_));
}
Traced choose(const TracedTruth& c, const Traced& a, const Traced& b) {
  if (!c.value_.tape_) return c.value_.number_ != 0 ? a : b;
  return Traced::of(Operation::choice, c.value_, &a, &b);
}

Traced sin(const Traced& a) {
  return Traced::of(Operation::sin, a);
}
Traced cos(const Traced& a) {
  return Traced::of(Operation::cos, a);
}
Traced tan(const Traced& a) {
  return Traced::of(Operation::tan, a);
}
Traced asin(const Traced& a) {
  return Traced::of(Operation::asin, a);
}
Traced acos(const Traced& a) {
  return Traced::of(Operation::acos, a);
}
Traced atan(const Traced& a) {
  return Traced::of(Operation::atan, a);
}
Traced sinh(const Traced& a) {
  return Traced::of(Operation::sinh, a);
}
Traced cosh(const Traced& a) {
  return Traced::of(Operation::cosh, a);
}
Traced tanh(const Traced& a) {
  return Traced::of(Operation::tanh, a);
}
Traced exp(const Traced& a) {
  return Traced::of(Operation::exp, a);
}
Traced log(const Traced& a) {
  return Traced::of(Operation::log, a);
}
Traced sqrt(const Traced& a) {
  return Traced::of(Operation::sqrt, a);
}
Traced abs(const Traced& a) {
  return Traced::of(Operation::abs, a);
}
Traced floor(const Traced& a) {
  return Traced::of(Operation::floor, a);
}
Traced atan2(const Traced& y, const Traced& x) {
  return Traced::of(Operation::atan2, y, &x);
}
Traced hypot(const Traced& a, const Traced& b) {
  return Traced::of(Operation::hypot, a, &b);
}
Traced min(const Traced& a, const Traced& b) {
  return Traced::of(Operation::min, a, &b);
}
Traced max(const Traced& a, const Traced& b) {
  return Traced::of(Operation::max, a, &b);
}
Traced pow(const Traced& base, const Traced& exponent) {
  const double e = exponent.number_;
  if (!exponent.tape_ && e == std::floor(e) && std::abs(e) <= 1000)
    return Traced::of(Operation::whole_power, base, nullptr, nullptr, e);
  return Traced::of(Operation::power, base, &exponent);
}

}  // namespace momenta
