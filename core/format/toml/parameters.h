#pragma once
// [parameters]: named numbers. A value is a number, or a formula (core/expression/expression.h) of
// others, in any order; such formulas may replace any number of the scene.

#include <momenta/core/expression/expression.h>
#include <momenta/core/format/toml/toml_values.h>

#include <string>
#include <string_view>
#include <vector>

namespace momenta::reading {

class Parameters {
 public:
  Parameters() = default;
  /// Reads the root table of a scene. @throws SceneError, one sentence: a faulty formula, a value
  /// that is no number, parameters that depend on each other in a circle
  Parameters(const Value& root, const std::string& file);

  bool empty() const { return names_.empty(); }
  const std::vector<std::string>& names() const { return names_; }
  /// Value of parameter i.
  double operator[](std::size_t i) const { return values_[i]; }
  /// Whether a formula read so far uses parameter i.
  bool used(std::size_t i) const { return used_[i] != 0; }

  /// Reads a formula of parameters. @throws ExpressionError
  Expression formula(std::string_view text) const;
  /// Value of such a formula.
  double value(const Expression& formula) const { return formula(values_); }

 private:
  std::vector<std::string> names_;
  std::vector<double> values_;
  mutable std::vector<char> used_;
};

/// Place in the file of a character of a text value.
Location place_in(const Value& text, std::size_t character);

/// [[require]]: conditions on parameters. @throws SceneError: one sentence with the values of the
/// parameters it names, and the author's own
void check_requirements(const Value& root, const Parameters& parameters, const std::string& file);

}  // namespace momenta::reading
