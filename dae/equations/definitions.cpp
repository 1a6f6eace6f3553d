#include <momenta/core/expression/simplify.h>
#include <momenta/core/expression/tape.h>
#include <momenta/dae/equations/definitions.h>

#include <utility>

namespace momenta {

Definitions::Definitions(std::vector<std::string> arguments)
    : arguments_(arguments.size()), names_(std::move(arguments)) {}

void Definitions::add(const std::string& name, const Expression& formula) {
  formulas_.push_back(in_place(formula));
  names_.push_back(name);
}

Expression Definitions::in_place(const Expression& formula) const {
  const auto value_of = [](const std::vector<int>& places, const Expression& e) {
    return places[static_cast<std::size_t>(e.outputs().front())];
  };
  formula::Tape tape;
  std::vector<int> stands_for(names_.size(), -1);
  bool any = false;
  for (const int v : formula.variables()) {
    const auto at = static_cast<std::size_t>(v);
    if (at < arguments_) continue;
    const Expression& defined = formulas_[at - arguments_];
    stands_for[at] = value_of(add_simplified(tape, defined.tape(), {}), defined);
    any = true;
  }
  if (!any) return formula;
  const int value = value_of(add_simplified(tape, formula.tape(), stands_for), formula);
  return Expression(tape, std::vector<int>{value});
}

}  // namespace momenta
