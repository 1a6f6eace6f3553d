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

}  // namespace momenta::formula
