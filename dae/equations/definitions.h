#pragma once
// Formulas with a name, [dae.definitions], for what equations and later definitions take. They are
// no unknowns: where a formula names one, the instructions of its formula are put in, each once, so
// that derivatives, structure and Jacobians see variables alone.

#include <momenta/core/expression/expression.h>

#include <string>
#include <vector>

namespace momenta {

class Definitions {
 public:
  /// Of `arguments`, which formulas take by their place.
  explicit Definitions(std::vector<std::string> arguments);

  /// What formulas may name: the arguments, then what is defined so far.
  const std::vector<std::string>& names() const { return names_; }
  /// One more. @pre its formula is of names()
  void add(const std::string& name, const Expression& formula);
  /// A formula of names() as one of the arguments alone. O(its tape and those it names)
  Expression in_place(const Expression& formula) const;

 private:
  std::size_t arguments_;
  std::vector<std::string> names_;
  std::vector<Expression> formulas_;  ///< of the arguments alone
};

}  // namespace momenta
