#include <momenta/core/expression/tape.h>

#include <algorithm>
#include <bit>

namespace momenta::formula {

int operands_of(Operation operation) {
  switch (operation) {
    case Operation::number:
    case Operation::variable:
      return 0;
    case Operation::choice:
      return 3;
    case Operation::add:
    case Operation::subtract:
    case Operation::multiply:
    case Operation::divide:
    case Operation::power:
    case Operation::less:
    case Operation::less_equal:
    case Operation::equal:
    case Operation::unequal:
    case Operation::both:
    case Operation::either:
    case Operation::atan2:
    case Operation::hypot:
    case Operation::min:
    case Operation::max:
      return 2;
    default:
      return 1;
  }
}

namespace {

/// xⁿ by squaring.
double whole_power(double x, int n) {
  double result = 1, square = x;
  for (unsigned k = static_cast<unsigned>(std::abs(n)); k > 0; k >>= 1) {
    if (k & 1) result *= square;
    square *= square;
  }
  return n < 0 ? 1 / result : result;
}

double of_one(Operation operation, double a) {
  switch (operation) {
    case Operation::negative:
      return -a;
    case Operation::opposite:
      return a == 0 ? 1 : 0;
    case Operation::sin:
      return std::sin(a);
    case Operation::cos:
      return std::cos(a);
    case Operation::tan:
      return std::tan(a);
    case Operation::asin:
      return std::asin(a);
    case Operation::acos:
      return std::acos(a);
    case Operation::atan:
      return std::atan(a);
    case Operation::sinh:
      return std::sinh(a);
    case Operation::cosh:
      return std::cosh(a);
    case Operation::tanh:
      return std::tanh(a);
    case Operation::exp:
      return std::exp(a);
    case Operation::log:
      return std::log(a);
    case Operation::sqrt:
      return std::sqrt(a);
    case Operation::abs:
      return std::abs(a);
    case Operation::sign:
      return a > 0 ? 1 : a < 0 ? -1 : a;
    default:
      return std::floor(a);
  }
}

double of_two(Operation operation, double a, double b) {
  switch (operation) {
    case Operation::add:
      return a + b;
    case Operation::subtract:
      return a - b;
    case Operation::multiply:
      return a * b;
    case Operation::divide:
      return a / b;
    case Operation::power:
      return std::pow(a, b);
    case Operation::less:
      return a < b;
    case Operation::less_equal:
      return a <= b;
    case Operation::equal:
      return a == b;
    case Operation::unequal:
      return a != b;
    case Operation::both:
      return a != 0 && b != 0;
    case Operation::either:
      return a != 0 || b != 0;
    case Operation::atan2:
      return std::atan2(a, b);
    case Operation::hypot:
      return std::hypot(a, b);
    case Operation::min:
      return std::isnan(a) || std::isnan(b) ? a + b : std::min(a, b);
    default:
      return std::isnan(a) || std::isnan(b) ? a + b : std::max(a, b);
  }
}

}  // namespace

double value_of(const Instruction& in, double a, double b, double c) {
  switch (in.operation) {
    case Operation::whole_power:
      return whole_power(a, static_cast<int>(in.number));
    case Operation::choice:
      return a != 0 ? b : c;
    default:
      return operands_of(in.operation) == 1 ? of_one(in.operation, a) : of_two(in.operation, a, b);
  }
}

std::size_t Tape::Hash::operator()(const Instruction& in) const {
  std::size_t h = static_cast<std::size_t>(in.operation);
  for (const int i : {in.a, in.b, in.c}) h = h * 1'000'003 + static_cast<std::size_t>(i + 2);
  return h * 1'000'003 + std::bit_cast<std::uint64_t>(in.number);
}

bool Tape::Equal::operator()(const Instruction& x, const Instruction& y) const {
  const auto bits = [](double number) { return std::bit_cast<std::uint64_t>(number); };
  return x.operation == y.operation && x.a == y.a && x.b == y.b && x.c == y.c &&
         bits(x.number) == bits(y.number);
}

int Tape::add(Instruction in) {
  if (in.operation != Operation::number && in.operation != Operation::variable && is_number(in.a) &&
      is_number(in.b) && is_number(in.c)) {
    const auto at = [&](int i) { return i < 0 ? 0 : (*this)[i].number; };
    return number(value_of(in, at(in.a), at(in.b), at(in.c)));
  }
  const auto [known, fresh] = known_.try_emplace(in, static_cast<int>(all_.size()));
  if (fresh) all_.push_back(in);
  return known->second;
}

std::vector<Instruction> Tape::for_value(int last) const {
  std::vector<int> place(all_.size(), -1);
  std::vector<char> needed(all_.size(), 0);
  needed[static_cast<std::size_t>(last)] = 1;
  const auto operands = [](const Instruction& in, auto&& act) {
    const int count = operands_of(in.operation);
    if (count > 0) act(in.a);
    if (count > 1) act(in.b);
    if (count > 2) act(in.c);
  };
  for (auto i = static_cast<std::size_t>(last) + 1; i-- > 0;)
    if (needed[i]) operands(all_[i], [&](int k) { needed[static_cast<std::size_t>(k)] = 1; });
  std::vector<Instruction> kept;
  for (std::size_t i = 0; i <= static_cast<std::size_t>(last); ++i) {
    if (!needed[i]) continue;
    place[i] = static_cast<int>(kept.size());
    Instruction in = all_[i];
    const int count = operands_of(in.operation);
    if (count > 0) in.a = place[static_cast<std::size_t>(in.a)];
    if (count > 1) in.b = place[static_cast<std::size_t>(in.b)];
    if (count > 2) in.c = place[static_cast<std::size_t>(in.c)];
    kept.push_back(in);
  }
  return kept;
}

}  // namespace momenta::formula
