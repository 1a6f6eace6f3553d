#include <momenta/core/expression/function_names.h>
#include <momenta/core/expression/jumps.h>
#include <momenta/core/expression/switches.h>

#include <cmath>

namespace momenta {

using formula::Operation;

Expression Switches::held(const Expression& formula) {
  const auto& tape = formula.tape();
  std::vector<bool> turns(tape.size());  // whether it is in the argument of a jump
  for (std::size_t k = tape.size(); k-- > 0;)
    if (turns[k] || formula::jumps(tape[k].operation))
      if (tape[k].operation != Operation::variable)
        for (const int of : {tape[k].a, tape[k].b, tape[k].c})
          if (of >= 0) turns[static_cast<std::size_t>(of)] = true;
  std::vector<int> place;
  for (formula::Instruction in : tape) {
    const bool held = formula::jumps(in.operation) || turns[place.size()];
    for (int* of : {&in.a, &in.b, &in.c})
      if (in.operation != Operation::variable && *of >= 0)
        *of = place[static_cast<std::size_t>(*of)];
    switch (held ? in.operation : Operation::number) {
      case Operation::less:
      case Operation::less_equal:
      case Operation::sign:
      case Operation::floor:
        place.push_back(mode_of(in.operation, in.a, in.b));
        break;
      case Operation::abs:
        place.push_back(tape_.add(Operation::multiply, mode_of(in.operation, in.a, in.b), in.a));
        break;
      case Operation::min:
      case Operation::max:
        place.push_back(
            tape_.add(Operation::choice, mode_of(in.operation, in.a, in.b), in.b, in.a));
        break;
      default:
        place.push_back(tape_.add(in));
    }
  }
  return {tape_, std::vector<int>{place[static_cast<std::size_t>(formula.outputs().front())]}};
}

int Switches::mode_of(Operation operation, int a, int b) {
  std::size_t k = 0;
  while (k < all_.size() && (all_[k].operation != operation || all_[k].a != a || all_[k].b != b))
    ++k;
  const int mode = tape_.add(Operation::variable, variables_ + static_cast<int>(k));
  if (k == all_.size()) {
    const int argument = b < 0 ? a : tape_.add(Operation::subtract, a, b);
    all_.push_back({operation, a, b, Expression(tape_, std::vector<int>{argument})});
  }
  return mode;
}

std::string_view Switches::name(std::size_t k) const {
  const std::string_view name = formula::function_name(all_[k].operation);
  return name.empty() ? formula::function_name(Operation::choice) : name;
}

double Switches::mode(std::size_t k, double argument) const {
  switch (all_[k].operation) {
    case Operation::less:
    case Operation::max:
      return argument < 0 ? 1 : 0;
    case Operation::less_equal:
      return argument <= 0 ? 1 : 0;
    case Operation::min:
      return argument > 0 ? 1 : 0;
    case Operation::abs:
      return std::signbit(argument) ? -1 : 1;
    case Operation::floor:
      return std::floor(argument);
    default:
      return argument > 0 ? 1 : argument < 0 ? -1 : 0;
  }
}

double Switches::margin(std::size_t k, double mode, double argument) const {
  switch (all_[k].operation) {
    case Operation::less:
    case Operation::less_equal:
    case Operation::max:
      return mode != 0 ? -argument : argument;
    case Operation::min:
      return mode != 0 ? argument : -argument;
    case Operation::floor:
      return (argument - mode) * (mode + 1 - argument);
    default:
      return mode != 0 ? mode * argument : -std::abs(argument);
  }
}

double Switches::turned(std::size_t k, double mode, double argument) const {
  switch (all_[k].operation) {
    case Operation::abs:
      return -mode;
    case Operation::sign:
      return mode != 0 ? -mode : this->mode(k, argument);
    case Operation::floor:
      return std::round(argument) > mode ? mode + 1 : mode - 1;
    default:
      return 1 - mode;
  }
}

}  // namespace momenta
