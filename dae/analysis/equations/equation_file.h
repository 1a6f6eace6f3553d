#pragma once

#include <momenta/core/expression/expression.h>
#include <momenta/core/format/toml/setting.h>
#include <momenta/core/scene/location.h>
#include <momenta/dae/algebra/structure/sigma_method.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace momenta {

/// Whether a text is a file of equations and no scene: a line of it opens the table [dae]. O(size)
inline bool holds_equations(std::string_view text) {
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line = text.substr(begin, end - begin);
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    if (line.starts_with("[dae]")) return true;
    begin = end + 1;
  }
  return false;
}

// A file of equations F(t, y, y') = 0, read and checked.
//
//   [dae]
//   name = "pendulum"
//   variables = ["x", "y", "u", "v", "lambda"]
//   equations = ["der(x) = u", "der(y) = v", "der(u) = -x*lambda", "der(v) = -y*lambda - g",
//                "x^2 + y^2 = 1"]
//   values = { x = 1 }           # a guess of the start; 0 where none is given
//   [parameters]
//   g = 9.81
//
// An equation is two formulas (core/expression/expression.h) with = between, or one that is to be
// zero, of t, variables, der() of variables and parameters.

struct EquationFile {
  struct Equation {
    std::string text;
    Location at;
    Expression formula;  ///< left side less right side
  };
  /// Known values of the solution at one time.
  struct Reference {
    double t = 0;
    std::vector<double> values;  ///< by variable; NaN: not given
    std::vector<char> judged;    ///< variables whose errors count
  };

  std::string file, name;
  std::vector<std::string> variables;
  std::vector<Equation> equations;    ///< as many as variables
  std::vector<double> parameters;     ///< values
  std::vector<double> values, rates;  ///< the guess of the start, by variable
  std::vector<double> scales;         ///< typical sizes, by variable
  std::vector<char> held;             ///< whether the start value is kept
  double start = 0, end = 1;
  int samples = 1000;
  std::string integrator;  ///< empty: by the index
  std::optional<Reference> reference;

  int size() const { return static_cast<int>(variables.size()); }
  /// Count of what formulas take: t, then y, y', parameters.
  std::size_t arguments() const { return 1 + 2 * variables.size() + parameters.size(); }
  /// σ_ij: 1 where der(x_j) stands in equation i, 0 where x_j does.
  structure::Signature signature() const;
  /// "equation 3, 'x^2 + y^2 = 1'".
  std::string name_of(int equation) const;
  /// "file:line: ".
  std::string where(Location at) const;
};

/// @throws SceneError: file, line, what was found and expected; for structurally singular systems
/// the equations and variables to blame
EquationFile parse_equations(std::string_view text, const std::string& file,
                             const std::vector<Setting>& settings = {});
EquationFile read_equations(const std::filesystem::path& file,
                            const std::vector<Setting>& settings = {});

}  // namespace momenta
