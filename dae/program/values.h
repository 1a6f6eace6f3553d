#pragma once
// The values of an option, described by its type name, for help, the man page and completion:
//
//   a|b|c      one of these words
//   FORM       names that the program knows: FORM, INTEGRATOR, FAMILY; or a path: SCENE, FILE, DIR,
//              STATE; or values without a list: S (seconds), N, X
//   FORM,...   several, with commas between

#include <momenta/core/text/near_name.h>

#include <CLI/CLI.hpp>
#include <string>
#include <type_traits>
#include <vector>

namespace momenta::program {

struct Values {
  enum class Paths { none, scenes, files, directories };

  std::vector<std::string> words;
  Paths paths = Paths::none;
  bool several = false;  ///< values with commas between
};

Values values_of(std::string type_name);

/// One of these words, shown as type name.
CLI::Option* one_of(CLI::Option* option, const std::vector<std::string>& words);
/// Greater than 0, shown as `type_name`.
CLI::Option* positive(CLI::Option* option, const std::string& type_name);
/// The option takes a number from `least` to `most`, shown as `type_name`.
template <class Number>
CLI::Option* within(CLI::Option* option, const std::string& type_name, Number least, Number most) {
  const auto check = [=](const std::string& text) -> std::string {
    Number x{};
    if (CLI::detail::lexical_cast(text, x) && least <= x && x <= most) return {};
    const auto digits = [](Number n) {
      if constexpr (std::is_integral_v<Number>) return std::to_string(n);
      return reading::digits(static_cast<double>(n));
    };
    return "found " + reading::in_quotes(text) + ", expected a " +
           (std::is_integral_v<Number> ? "whole number" : "number") + " from " + digits(least) +
           " to " + digits(most);
  };
  return option->check(check)->type_name(type_name);
}

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
