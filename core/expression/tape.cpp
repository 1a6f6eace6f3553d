#include <momenta/core/expression/evaluate.h>
#include <momenta/core/expression/tape.h>

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

Tape::Tape(const std::vector<Instruction>& written) {
  for (const Instruction& in : written) add(in);
}

std::size_t Tape::Hash::operator()(const Instruction& in) const {
  std::size_t h = static_cast<std::size_t>(in.operation);
  for (const int i : {in.a, in.b, in.c}) h = h * 1'000'003 + static_cast<std::size_t>(i + 2);
  h = h * 1'000'003 + reinterpret_cast<std::uintptr_t>(in.spline);
  return h * 1'000'003 + std::bit_cast<std::uint64_t>(in.number);
}

bool Tape::Equal::operator()(const Instruction& x, const Instruction& y) const {
  const auto bits = [](double number) { return std::bit_cast<std::uint64_t>(number); };
  return x.operation == y.operation && x.a == y.a && x.b == y.b && x.c == y.c &&
         bits(x.number) == bits(y.number) && x.spline == y.spline;
}

int Tape::add(Instruction in) {
  if (in.operation != Operation::number && in.operation != Operation::variable && is_number(in.a) &&
      is_number(in.b) && is_number(in.c)) {
    const auto at = [&](int i) { return i < 0 ? 0 : (*this)[i].number; };
    double line[]{at(in.a), at(in.b), at(in.c), 0};
    in.a = 0, in.b = 1, in.c = 2;
    execute(in, static_cast<const double*>(nullptr), line, line[3]);
    return number(line[3]);
  }
  const auto [known, fresh] = known_.try_emplace(in, static_cast<int>(all_.size()));
  if (fresh) all_.push_back(in);
  return known->second;
}

std::vector<Instruction> Tape::needed_for(std::vector<int>& at) const {
  const auto index = [](int i) { return static_cast<std::size_t>(i); };
  std::vector<int> place(all_.size(), -1);
  std::vector<char> needed(all_.size(), 0);
  for (const int i : at) needed[index(i)] = 1;
  const auto operands = [](auto& in, auto&& act) {
    const int count = operands_of(in.operation);
    if (count > 0) act(in.a);
    if (count > 1) act(in.b);
    if (count > 2) act(in.c);
  };
  for (std::size_t i = all_.size(); i-- > 0;)
    if (needed[i]) operands(all_[i], [&](int k) { needed[index(k)] = 1; });
  std::vector<Instruction> kept;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (!needed[i]) continue;
    place[i] = static_cast<int>(kept.size());
    Instruction in = all_[i];
    operands(in, [&](int& k) { k = place[index(k)]; });
    kept.push_back(in);
  }
  for (int& i : at) i = place[index(i)];
  return kept;
}

}  // namespace momenta::formula
