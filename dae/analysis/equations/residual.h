#pragma once
// F(t, y, y') of a file of equations, and its exact derivatives, in any scalar.

#include <momenta/core/expression/evaluate.h>
#include <momenta/core/scalar/power_series.h>
#include <momenta/dae/analysis/equations/equation_file.h>

#include <vector>

namespace momenta {

/// F in numbers of S, for one thread. No allocation after construction.
template <class S>
class Residual {
 public:
  explicit Residual(const EquationFile& file) : file_(file), x_(file.arguments()) {
    std::size_t longest = 0;
    for (const auto& e : file.equations) longest = std::max(longest, e.formula.tape().size());
    line_.resize(longest);
    for (std::size_t i = 0; i < file.parameters.size(); ++i)
      x_[1 + 2 * n() + i] = S(file.parameters[i]);
  }
  Residual(const Residual&) = delete;
  Residual& operator=(const Residual&) = delete;

  /// r = F(t, y, y'). O(sum of the tapes)
  void operator()(const S& t, const S* y, const S* ydot, S* r) {
    x_[0] = t;
    for (std::size_t i = 0; i < n(); ++i) x_[1 + i] = y[i], x_[1 + n() + i] = ydot[i];
    for (const auto& e : file_.equations) evaluate(e.formula, x_.data(), line_.data(), r++);
  }

 private:
  std::size_t n() const { return file_.variables.size(); }
  const EquationFile& file_;
  std::vector<S> x_, line_;
};

/// The entries of ∂F/∂y and ∂F/∂y' that may be other than zero, equation by equation.
template <class S>
class Slopes {
 public:
  struct Entry {
    int equation, variable;
    bool of_rate;
  };

  explicit Slopes(const EquationFile& file) : n_(file.variables.size()), x_(file.arguments()) {
    const int n = file.size();
    std::size_t longest = 0, outputs = 0;
    for (int i = 0; i < n; ++i) {
      std::vector<int> taken;
      for (const int v : file.equations[static_cast<std::size_t>(i)].formula.variables())
        if (v >= 1 && v <= 2 * n) taken.push_back(v);
      for (const int v : taken) entries_.push_back({i, (v - 1) % n, v > n});
      formulas_.push_back(
          file.equations[static_cast<std::size_t>(i)].formula.with_derivatives(taken));
      longest = std::max(longest, formulas_.back().tape().size());
      outputs = std::max(outputs, formulas_.back().outputs().size());
    }
    line_.resize(longest);
    row_.resize(outputs);
    values_.resize(entries_.size());
    for (std::size_t i = 0; i < file.parameters.size(); ++i)
      x_[1 + 2 * n_ + i] = S(file.parameters[i]);
  }

  const std::vector<Entry>& entries() const { return entries_; }
  /// Values of entries() at the last evaluate_at().
  const std::vector<S>& values() const { return values_; }
  /// O(sum of the tapes)
  void evaluate_at(const S& t, const S* y, const S* ydot) {
    x_[0] = t;
    for (std::size_t i = 0; i < n_; ++i) x_[1 + i] = y[i], x_[1 + n_ + i] = ydot[i];
    auto next = values_.begin();
    for (const Expression& f : formulas_) {
      evaluate(f, x_.data(), line_.data(), row_.data());
      next =
          std::copy(row_.begin() + 1, row_.begin() + static_cast<long>(f.outputs().size()), next);
    }
  }

 private:
  std::size_t n_;
  std::vector<Expression> formulas_;
  std::vector<Entry> entries_;
  std::vector<S> x_, line_, row_, values_;
};

}  // namespace momenta
