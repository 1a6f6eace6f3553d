#pragma once
// Functions of formulas by the names users type.

#include <momenta/core/expression/instruction.h>

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace momenta::formula {

/// The operation of the function of this name; nothing: unknown.
std::optional<Operation> function_of_name(std::string_view name);
/// The name of a function; empty for signs and words.
std::string_view function_name(Operation operation);

/// Hint on an unknown function: its name here, one that may be meant, or all there are, `of_scene`
/// among them.
std::string unknown_function(std::string_view name, std::span<const std::string_view> of_scene);

// Words and signs of other notations, and what formulas write instead: "ln" is log, "²" is ^2. For
// error sentences alone.

/// The form that formulas have for a function of that name, "log(x)"; empty: unknown.
std::string function_elsewhere(std::string_view name);
/// The same for a name that is a number, "pi".
std::string number_elsewhere(std::string_view name);
/// The same for a sign at the start of a text, "'^2'".
std::string sign_elsewhere(std::string_view text);

}  // namespace momenta::formula
