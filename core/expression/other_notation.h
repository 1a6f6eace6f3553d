#pragma once
// Words and signs that other notations have for what formulas write otherwise: "ln" is log, "²" is
// ^2. For error sentences alone.

#include <string>
#include <string_view>

namespace momenta::formula {

/// What formulas write for a function of that name, "log(x)"; empty: none is known.
std::string function_elsewhere(std::string_view name);
/// The same for a name that is a number, "pi".
std::string number_elsewhere(std::string_view name);
/// The same for the sign that a text begins with, "'^2'".
std::string sign_elsewhere(std::string_view text);

}  // namespace momenta::formula
