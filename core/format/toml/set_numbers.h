#pragma once
#include <momenta/core/format/toml/setting.h>
#include <momenta/core/format/toml/toml_values.h>

namespace momenta::reading {

/// Puts numbers in their places. Missing keys are added, for the reader to judge. @throws
/// std::invalid_argument
void set_numbers(Value& root, const std::vector<Setting>& settings);

}  // namespace momenta::reading
