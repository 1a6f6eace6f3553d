#pragma once
// Named formulas, [dae.definitions], for equations and later definitions. They are no unknowns:
// where a formula names one, its instructions are put in, each once, so that derivatives, structure
// and Jacobians see variables alone.

#include <momenta/core/expression/expression.h>

#include <string>
#include <vector>

namespace momenta {

class Definitions {
 public:
  /// `arguments`: names of the numbers that formulas take, by place.
  explicit Definitions(std::vector<std::string> arguments);

  /// Names open to formulas: the arguments, then the definitions so far.
  const std::vector<std::string>& names() const { return names_; }
  /// @pre `formula` is of names()
  void add(const std::string& name, const Expression& formula);
  /// A formula of names(), in the arguments alone. O(its tape and those it names)
  Expression in_place(const Expression& formula) const;

 private:
  std::size_t arguments_;
  std::vector<std::string> names_;
  std::vector<Expression> formulas_;  ///< in the arguments alone
};

}  // namespace momenta
