#pragma once
// Named formulas, [dae.definitions], for equations and later definitions. They are no unknowns:
// where a formula names one, its instructions are put in, each once, so that derivatives, structure
// and Jacobians see variables alone.

#include <momenta/core/expression/expression.h>
#include <momenta/dae/analysis/equations/equation_start.h>
#include <momenta/dae/integrator/system.h>

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

// A file of equations as a system for integrators of DAEs.

/// F(t, y, y') = 0 with its exact Jacobian, dense up to 40 unknowns, from the start found before.
/// Errors of variables of index k are weighed by h^(k−1), as implicit Runge-Kutta methods need. BDF
/// of index 2 tests variables of index 1 that have a derivative or are prescribed by equations
/// without a freedom; in a connected part that has none, the variables with a derivative. Variables
/// of index 2 without a derivative have a loose tolerance in Newton's norm.
class EquationSystem final : public DaeSystem, public StructuredSystem {
 public:
  /// File and start must outlive the system. `atol`: the run's. @pre start.point.why is empty
  EquationSystem(const EquationFile& file, const EquationStart& start, double atol);

  int size() const override { return file_.size(); }
  bool residual(double t, const double* y, const double* ydot, double* r) override;
  bool jacobian(double t, const double* y, const double* ydot, double c, double* values) override;
  const JacobianPattern& pattern() const override { return pattern_; }
  bool start(double t, double* y, double* ydot) override;
  bool differential(int i) const override { return tested_[static_cast<std::size_t>(i)]; }
  int index() const override { return start_.point.found.index; }
  bool is_regular() const override { return start_.jacobian.regular(size()); }
  double scale(int i) const override;
  Weight weight(int i) const override;
  double unfiltered_part(int i) const override {
    return start_.prescribed[static_cast<std::size_t>(i)] ? 1 : 0.01;
  }

 private:
  const EquationFile& file_;
  const EquationStart& start_;
  double atol_;
  Residual<double> residual_;
  Slopes<double> slopes_;
  JacobianPattern pattern_;         ///< empty: dense
  std::vector<std::size_t> place_;  ///< by entry of slopes_: place among the values
  std::size_t stored_ = 0;
  std::vector<char> tested_;
};

}  // namespace momenta
