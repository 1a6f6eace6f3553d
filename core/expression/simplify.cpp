#include <momenta/core/expression/simplify.h>

namespace momenta::formula {

int add_simplified(Tape& tape, Instruction in) {
  using O = Operation;
  const int a = in.a, b = in.b;
  const auto is = [&](int i, double x) {
    return tape[i].operation == O::number && tape[i].number == x;
  };
  switch (in.operation) {
    case O::negative:
      if (tape[a].operation == O::negative) return tape[a].a;
      if (is(a, 0)) return tape.number(0);
      break;
    case O::add:
      if (is(a, 0)) return b;
      if (is(b, 0)) return a;
      break;
    case O::subtract:
      if (is(b, 0)) return a;
      if (is(a, 0)) return add_simplified(tape, {O::negative, b, -1, -1, 0});
      break;
    case O::multiply:
      if (is(a, 0) || is(b, 0)) return tape.number(0);
      if (is(a, 1)) return b;
      if (is(b, 1)) return a;
      break;
    case O::divide:
      if (is(a, 0) && !is(b, 0)) return tape.number(0);
      if (is(b, 1)) return a;
      break;
    case O::whole_power:
      if (in.number == 1) return a;
      if (in.number == 0) return tape.number(1);
      break;
    case O::choice:
      if (in.b == in.c) return in.b;
      break;
    default:
      break;
  }
  return tape.add(in);
}

std::vector<int> add_simplified(Tape& tape, std::span<const Instruction> written,
                                std::span<const int> variables) {
  std::vector<int> place;
  place.reserve(written.size());
  const auto moved = [&](int& i) { i = place[static_cast<std::size_t>(i)]; };
  for (Instruction in : written) {
    if (in.operation == Operation::variable) {
      const auto v = static_cast<std::size_t>(in.a);
      const int known = v < variables.size() ? variables[v] : -1;
      place.push_back(known >= 0 ? known : tape.add(in));
      continue;
    }
    const int operands = operands_of(in.operation);
    if (operands > 0) moved(in.a);
    if (operands > 1) moved(in.b);
    if (operands > 2) moved(in.c);
    place.push_back(add_simplified(tape, in));
  }
  return place;
}

}  // namespace momenta::formula
