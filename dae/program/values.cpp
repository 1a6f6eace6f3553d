#include "values.h"

#include <momenta/core/text/near_name.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/solver/integrators.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>

#include "families.h"

namespace momenta::program {
namespace {

constexpr std::string_view and_so_on = ",...";

bool has_capitals(const std::string& word) {
  return std::any_of(word.begin(), word.end(),
                     [](unsigned char c) { return std::isupper(c) != 0; });
}

}  // namespace

Values values_of(std::string type_name) {
  Values values;
  if (type_name.ends_with(and_so_on)) {
    values.several = true;
    type_name.resize(type_name.size() - and_so_on.size());
  }
  if (type_name == "FORM") values.words = form_names();
  if (type_name == "INTEGRATOR")
    for (const Integrator& i : integrators()) values.words.push_back(i.name);
  if (type_name == "FAMILY")
    for (const Family& f : families()) values.words.emplace_back(f.name);
  if (type_name == "SCENE") values.paths = Values::Paths::scenes;
  if (type_name == "FILE" || type_name == "STATE") values.paths = Values::Paths::files;
  if (type_name == "DIR") values.paths = Values::Paths::directories;
  std::istringstream alternatives(type_name);
  for (std::string word; std::getline(alternatives, word, '|');)
    if (!has_capitals(word)) values.words.push_back(word);
  return values;
}

CLI::Option* one_of(CLI::Option* option, const std::vector<std::string>& words) {
  std::string type_name;
  for (const std::string& word : words) type_name += (type_name.empty() ? "" : "|") + word;
  const auto check = [words](const std::string& text) -> std::string {
    if (std::find(words.begin(), words.end(), text) != words.end()) return {};
    const std::vector<std::string_view> known(words.begin(), words.end());
    return "found " + reading::in_quotes(text) + ", expected one of: " + listed(words) +
           reading::did_you_mean(text, known);
  };
  return option->check(check)->type_name(type_name);
}

CLI::Option* positive(CLI::Option* option, const std::string& type_name) {
  const auto check = [](const std::string& text) -> std::string {
    double x = 0;
    const bool is_number = CLI::detail::lexical_cast(text, x);
    if (is_number && x > 0 && std::isfinite(x)) return {};
    return "found " + (is_number ? text : reading::in_quotes(text)) +
           ", expected a positive number";
  };
  return option->check(check)->type_name(type_name);
}

std::vector<const CLI::App*> verbs_of(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App* verb) { return !verb->get_group().empty(); });
}

bool is_flag(const CLI::Option& option) {
  return option.get_items_expected_max() == 0;
}

std::string shown_name(const CLI::Option& option) {
  if (option.nonpositional()) return "--" + option.get_lnames().front();
  const std::string type_name = option.get_type_name();
  if (type_name.find('|') != std::string::npos) return type_name;
  std::string name = option.get_name();
  for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return name;
}

std::string shown_text(const CLI::Option& option) {
  const std::string usual = option.get_default_str();
  return option.get_description() + (usual.empty() ? "" : " (default: " + usual + ")");
}

std::string synopsis_of(const CLI::App& verb) {
  std::string text = verb.get_name();
  for (const CLI::Option* o : verb.get_options())
    if (!o->nonpositional())
      text += o->get_required() ? " " + shown_name(*o) : " [" + shown_name(*o) + "]";
  return text + " [OPTIONS]";
}

bool any_takes(const std::vector<const CLI::Option*>& options, const std::string& word) {
  return std::any_of(options.begin(), options.end(), [&](const CLI::Option* o) {
    const std::string type_name = o->get_type_name();
    return type_name == word || type_name == word + std::string(and_so_on);
  });
}

std::vector<std::string> names_behind(const std::vector<const CLI::Option*>& options) {
  std::vector<std::string> sentences;
  if (any_takes(options, "FORM")) sentences.push_back("FORM: " + listed(form_names()) + ".");
  if (any_takes(options, "INTEGRATOR"))
    sentences.push_back("INTEGRATOR of ODE forms: " + integrator_names(Integrator::Takes::ode) +
                        "; of DAE forms: " + integrator_names(Integrator::Takes::dae) + ".");
  return sentences;
}

}  // namespace momenta::program
