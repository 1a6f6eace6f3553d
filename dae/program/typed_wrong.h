#pragma once
// A wrong command line in one sentence: what was found, and what was expected.

#include <CLI/CLI.hpp>
#include <string>

namespace momenta::program {

/// CLI11's error in `typed`, the words behind the program's name.
std::string typed_wrong(const CLI::App& app, const CLI::ParseError& error,
                        const std::vector<std::string>& typed);

}  // namespace momenta::program
