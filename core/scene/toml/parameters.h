#pragma once
// [parameters]: numbers with names, and what a scene makes of them. A value is a number, or a
// formula (core/expression/expression.h) of other parameters, in any order; wherever the scene has
// a number, it may have a formula of them in its place.

#include <momenta/core/expression/expression.h>
#include <momenta/core/scene/toml/toml_values.h>

#include <string>
#include <string_view>
#include <vector>

namespace momenta::reading {

class Parameters {
 public:
  Parameters() = default;
  /// Of the root table of a scene. @throws SceneError, one sentence: a formula that is none, a
  /// value that is no number, parameters that depend on each other in a circle
  Parameters(const Value& root, const std::string& file);

  bool empty() const { return names_.empty(); }
  const std::vector<std::string>& names() const { return names_; }
  /// Value of parameter i.
  double operator[](std::size_t i) const { return values_[i]; }
  /// Whether a formula read so far takes parameter i.
  bool used(std::size_t i) const { return used_[i] != 0; }

  /// Reads a formula of them. @throws ExpressionError
  Expression formula(std::string_view text) const;
  /// Its value.
  double value(const Expression& formula) const { return formula(values_); }

 private:
  std::vector<std::string> names_;
  std::vector<double> values_;
  mutable std::vector<char> used_;
};

/// The place in the file of a character of a text value.
Location place_in(const Value& text, std::size_t character);

/// [[require]]: what must hold among parameters. @throws SceneError: one sentence with the values
/// of the parameters it names, and the author's own
void check_requirements(const Value& root, const Parameters& parameters, const std::string& file);

}  // namespace momenta::reading
