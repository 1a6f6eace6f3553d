#pragma once
// Help for a screen of 80 columns, made, like the man page and completions, from the options
// themselves: it cannot differ from what the program accepts.

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace momenta::program {

inline constexpr std::size_t screen_width = 80;
inline constexpr const char* exit_status =
    "Exit status: 0 done, 1 the run failed, 2 wrong usage or bad input.";

std::string screen_help(const CLI::App& app);
/// CLI11's error in `typed`, the words behind the program's name, in one sentence: what was found,
/// and what was expected.
std::string typed_wrong(const CLI::App& app, const CLI::ParseError& error,
                        const std::vector<std::string>& typed);

/// Columns on a terminal: marks above letters, as in Φ̇, take none.
std::size_t columns_of(std::string_view text);

// The values of an option, described by its type name, for help, the man page and completion:
//
//   a|b|c      one of these words
//   FORM       names that the program knows: FORM, INTEGRATOR, FAMILY; or a path: SCENE, FILE, DIR,
//              STATE; or values without a list: S (seconds), N, X
//   FORM,...   several, with commas between

struct Values {
  enum class Paths { none, scenes, files, directories };

  std::vector<std::string> words;
  Paths paths = Paths::none;
  bool several = false;  ///< values with commas between
};

Values values_of(std::string type_name);

/// Documented verbs, in listing order.
std::vector<const CLI::App*> verbs_of(const CLI::App& program);
/// "--rtol"; for positional options "SCENE", or their words.
std::string shown_name(const CLI::Option& option);
bool is_flag(const CLI::Option& option);
/// Text with its default.
std::string shown_text(const CLI::Option& option);
/// "run SCENE [OPTIONS]"
std::string synopsis_of(const CLI::App& verb);
/// Whether one of these options takes `word`, or several.
bool any_takes(const std::vector<const CLI::Option*>& options, const std::string& word);
/// Lists of forms and integrators, if these options take them.
std::vector<std::string> names_behind(const std::vector<const CLI::Option*>& options);

}  // namespace momenta::program
