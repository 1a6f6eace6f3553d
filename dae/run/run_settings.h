#pragma once
// Settings of a run: the defaults, and the check that the settings are valid.

#include <momenta/dae/run/run_result.h>

#include <string>

namespace momenta {

/// @throws std::invalid_argument "rtol is -1, expected a tolerance, not negative" unless it `holds`
void expect(bool holds, const char* name, double found, const char* expected);
/// Checks the numbers of the settings. @throws std::invalid_argument
void expect_numbers(const RunSettings& s);

}  // namespace momenta
