#pragma once
// Help for a screen of 80 columns, the man page and completions, all made from the options
// themselves: they cannot differ from what the program accepts.

#include <CLI/CLI.hpp>
#include <string>

namespace momenta::program {

inline constexpr std::size_t screen_width = 80;
inline constexpr const char* exit_status =
    "Exit status: 0 done, 1 the run failed, 2 wrong usage or bad input.";

std::string screen_help(const CLI::App& app);
/// momenta(1), in roff.
std::string man_page(const CLI::App& program);
/// Script for "bash", "zsh" or "fish": completes verbs, options and values.
std::string completion_script(const CLI::App& program, const std::string& shell);

/// Columns on a terminal: marks above letters, as in Φ̇, take none.
std::size_t columns_of(std::string_view text);

}  // namespace momenta::program
