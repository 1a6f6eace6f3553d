#include <momenta/core/expression/simplify.h>
#include <momenta/core/expression/tape.h>
#include <momenta/dae/analysis/equations/equation_system.h>

#include <algorithm>
#include <cmath>
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

namespace {
constexpr int largest_dense = 40;
/// Absolute tolerance of Newton's corrections of variables of index 2 without a derivative, in
/// their scales. Rounding moves them by ε/h; without a tolerance they would drift from step to
/// step.
constexpr double loosely = 1e-3;

std::vector<char> tested_variables(const EquationStart& start) {
  const std::size_t n = start.index_of.size();
  if (start.point.found.index <= 1) return std::vector<char>(n, 1);
  std::vector<char> tested(n), some(n);
  for (std::size_t j = 0; j < n; ++j) {
    tested[j] = (start.appears[j] || start.prescribed[j]) && start.index_of[j] == 1;
    some[static_cast<std::size_t>(start.part[j])] |= tested[j];
  }
  for (std::size_t j = 0; j < n; ++j)
    if (!some[static_cast<std::size_t>(start.part[j])]) tested[j] = start.appears[j];
  return tested;
}
}  // namespace

EquationSystem::EquationSystem(const EquationFile& file, const EquationStart& start, double atol)
    : file_(file),
      start_(start),
      atol_(atol),
      residual_(file),
      slopes_(file),
      tested_(tested_variables(start)) {
  const auto n = static_cast<std::size_t>(file.size());
  const auto& entries = slopes_.entries();
  place_.resize(entries.size());
  if (file.size() <= largest_dense) {
    stored_ = n * n;
    for (std::size_t k = 0; k < entries.size(); ++k)
      place_[k] = static_cast<std::size_t>(entries[k].variable) * n +
                  static_cast<std::size_t>(entries[k].equation);
    return;
  }
  std::vector<std::vector<long>> rows(n);
  for (const auto& e : entries) rows[static_cast<std::size_t>(e.variable)].push_back(e.equation);
  pattern_.column_start.push_back(0);
  for (auto& column : rows) {
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
    pattern_.row.insert(pattern_.row.end(), column.begin(), column.end());
    pattern_.column_start.push_back(static_cast<long>(pattern_.row.size()));
  }
  stored_ = pattern_.row.size();
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const auto j = static_cast<std::size_t>(entries[k].variable);
    const auto begin = pattern_.row.begin() + pattern_.column_start[j],
               end = pattern_.row.begin() + pattern_.column_start[j + 1];
    place_[k] = static_cast<std::size_t>(std::lower_bound(begin, end, entries[k].equation) -
                                         pattern_.row.begin());
  }
}

bool EquationSystem::residual(double t, const double* y, const double* ydot, double* r) {
  residual_(t, y, ydot, r);
  for (int i = 0; i < size(); ++i)
    if (!std::isfinite(r[i]))
      return fail(file_.name_of(i) + ", line " +
                  std::to_string(file_.equations[static_cast<std::size_t>(i)].at.line) +
                  ", is not a finite number");
  return true;
}

bool EquationSystem::jacobian(double t, const double* y, const double* ydot, double c,
                              double* values) {
  std::fill_n(values, stored_, 0.0);
  slopes_.evaluate_at(t, y, ydot);
  const auto& entries = slopes_.entries();
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const double slope = slopes_.values()[k];
    if (!std::isfinite(slope))
      return fail("a derivative of " + file_.name_of(entries[k].equation) +
                  ", is not a finite number");
    values[place_[k]] += entries[k].of_rate ? c * slope : slope;
  }
  return true;
}

bool EquationSystem::start(double /*t*/, double* y, double* ydot) {
  std::copy_n(start_.point.y.data(), size(), y);
  std::copy_n(start_.point.ydot.data(), size(), ydot);
  return true;
}

double EquationSystem::scale(int i) const {
  const auto k = static_cast<std::size_t>(i);
  const bool loose = start_.index_of[k] > 1 && !start_.appears[k];
  return file_.scales[k] * (loose ? std::max(1.0, loosely / atol_) : 1);
}

DaeSystem::Weight EquationSystem::weight(int i) const {
  const auto k = static_cast<std::size_t>(i);
  return {start_.index_of[k] - 1, file_.scales[k]};
}

}  // namespace momenta
