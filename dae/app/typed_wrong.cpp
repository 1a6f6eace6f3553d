// A wrong command line in one sentence.

#include <momenta/core/text/quoting.h>
#include <momenta/dae/integrator/integrators.h>

#include <algorithm>

#include "help.h"

namespace momenta::program {
namespace {

using Names = std::vector<std::string>;

std::string near(const std::string& word, const Names& names) {
  const std::vector<std::string_view> known(names.begin(), names.end());
  return reading::did_you_mean(word, known);
}

std::string behind(const std::string& text, const std::string& mark) {
  const std::size_t at = text.find(mark);
  return at == std::string::npos ? text : text.substr(at + mark.size());
}

/// The verb that was typed; null: none.
const CLI::App* verb_of(const CLI::App& app) {
  const auto all = app.get_subcommands();
  return all.empty() ? nullptr : all.front();
}

std::string unknown_verb(const CLI::App& app, const std::string& word) {
  Names known;
  for (const CLI::App* verb : verbs_of(app)) known.push_back(verb->get_name());
  return "verb " + reading::in_quotes(word) + " is not known; expected " + listed(known) +
         near(word, known);
}

/// A word that no option of a verb takes.
std::string left_over(const CLI::App& verb, const std::string& word) {
  const std::string of = verb.get_name();
  if (!word.starts_with('-'))
    return of + ": " + reading::in_quotes(word) + " is one word too many, expected " +
           synopsis_of(verb);
  Names known;
  for (const CLI::Option* option : verb.get_options())
    if (option->nonpositional()) known.push_back(shown_name(*option));
  const std::string name = word.substr(0, word.find('='));
  return of + ": option " + reading::in_quotes(name) + " is not known, expected one of momenta " +
         of + " --help" + near(name, known);
}

/// Values of an option, in words.
std::string taken_by(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  if (type == "N") return "a whole number";
  if (type == "X" || type == "S") return "a number";
  return type;
}

const CLI::Option* option_named(const CLI::App& verb, const std::string& name) {
  for (const CLI::Option* option : verb.get_options())
    if (option->check_name(name)) return option;
  return nullptr;
}

}  // namespace

std::string typed_wrong(const CLI::App& app, const CLI::ParseError& error,
                        const std::vector<std::string>& typed) {
  const std::string said = error.what();
  const auto is = [&](CLI::ExitCodes code) {
    return error.get_exit_code() == static_cast<int>(code);
  };
  const CLI::App* verb = verb_of(app);
  if (verb == nullptr && !typed.empty() && !typed.front().starts_with('-'))
    return unknown_verb(app, typed.front());
  if (verb == nullptr)
    return "found " + (typed.empty() ? std::string("nothing") : reading::in_quotes(typed.front())) +
           ", expected a verb, or --help";
  if (is(CLI::ExitCodes::ExtrasError)) {
    // CLI11 has them in reverse order; options come with values.
    const std::string words = " " + behind(said, "expected: ") + " ";
    const auto is_left = [&](const std::string& word) {
      return words.find(" " + word + " ") != std::string::npos;
    };
    const auto is_option = [&](const std::string& word) {
      return word.starts_with('-') && is_left(word);
    };
    auto word = std::find_if(typed.begin(), typed.end(), is_option);
    if (word == typed.end()) word = std::find_if(typed.begin(), typed.end(), is_left);
    return left_over(*verb, word == typed.end() ? words : *word);
  }
  if (is(CLI::ExitCodes::ConversionError)) {
    const std::string pair = behind(said, "convert: ");
    const std::string name = pair.substr(0, pair.find(" = "));
    if (const CLI::Option* option = option_named(*verb, name); option && name != pair)
      return name + " is " + reading::in_quotes(behind(pair, " = ")) + ", expected " +
             taken_by(*option);
  }
  if (is(CLI::ExitCodes::RequiredError)) {
    const std::string name = said.substr(0, said.find(" is required"));
    if (const CLI::Option* option = option_named(*verb, name))
      return verb->get_name() + ": " + shown_name(*option) + " is missing, expected " +
             synopsis_of(*verb) +
             (option->nonpositional() ? " with " + name + " " + option->get_type_name() : "");
  }
  if (is(CLI::ExitCodes::ArgumentMismatch)) {
    const std::string name = said.substr(0, said.find_first_of(": "));
    if (const CLI::Option* option = option_named(*verb, name))
      return name + (is_flag(*option) ? " has a value, expected none"
                                      : " has no value, expected " + taken_by(*option));
  }
  if (is(CLI::ExitCodes::RequiresError))
    return said + ", which is missing; expected both or neither";
  if (is(CLI::ExitCodes::ExcludesError)) return said + ", expected one of them";
  if (said.find("expected") != std::string::npos) return said;
  return verb->get_name() + ": " + reading::on_one_line(said) + ", expected " + synopsis_of(*verb) +
         " as momenta " + verb->get_name() + " --help has them";
}

}  // namespace momenta::program
