#pragma once
// The functions that formulas have, by the names users type.

#include <momenta/core/expression/instruction.h>

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace momenta::formula {

/// The operation of a function of this name; nothing: there is none.
std::optional<Operation> function_of_name(std::string_view name);
/// The name of a function; empty: another operation, of signs or words.
std::string_view function_name(Operation operation);

/// What to tell of a function that there is not: how formulas write it, which one may be meant, or
/// all there are, `of_scene` among them.
std::string unknown_function(std::string_view name, std::span<const std::string_view> of_scene);

}  // namespace momenta::formula
