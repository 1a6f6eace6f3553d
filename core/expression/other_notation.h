#pragma once
// Words and signs of other notations, and what formulas write instead: "ln" is log, "²" is ^2. For
// error sentences alone.

#include <string>
#include <string_view>

namespace momenta::formula {

/// The form that formulas have for a function of that name, "log(x)"; empty: unknown.
std::string function_elsewhere(std::string_view name);
/// The same for a name that is a number, "pi".
std::string number_elsewhere(std::string_view name);
/// The same for a sign at the start of a text, "'^2'".
std::string sign_elsewhere(std::string_view text);

}  // namespace momenta::formula
