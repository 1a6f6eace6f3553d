#include "help.h"

#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/integrators.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>
#include <string_view>
#include <utility>

#include "families.h"

namespace momenta::program {
namespace {

constexpr std::string_view and_so_on = ",...";

bool has_capitals(const std::string& word) {
  return std::any_of(word.begin(), word.end(),
                     [](unsigned char c) { return std::isupper(c) != 0; });
}

constexpr std::size_t text_column = 26;

/// Words of `text` after `line`, further lines indented; line breaks stay.
std::string wrapped(std::string line, const std::string& text, std::size_t indent) {
  std::string out;
  std::istringstream lines(text);
  bool first = true;
  for (std::string part; std::getline(lines, part); first = false) {
    if (!first) {
      out += line + "\n";
      line.assign(indent, ' ');
    }
    std::istringstream words(part);
    bool spaced = true;  // nothing or blanks before the next word
    for (std::string word; words >> word; spaced = false) {
      if (!spaced && columns_of(line) + 1 + columns_of(word) > screen_width) {
        out += line + "\n";
        line.assign(indent, ' ');
        spaced = true;
      }
      line += (spaced ? "" : " ") + word;
    }
  }
  return out + line + "\n";
}

std::string row(const std::string& name, const std::string& text) {
  std::string line = "  " + name + "  ";
  if (line.size() < text_column) line.resize(text_column, ' ');
  return wrapped(line, text, text_column);
}

std::string name_and_type(const CLI::Option& o) {
  return shown_name(o) + (is_flag(o) || !o.nonpositional() ? "" : " " + o.get_type_name());
}

/// Options in one row, with the first one's text.
constexpr std::array<std::pair<std::string_view, std::string_view>, 12> one_row{{
    {"--project", "--no-project"},
    {"--baumgarte-alpha", "--baumgarte-beta"},
    {"--rtol", "--atol"},
    {"--out", "--mesh-bytes"},
    {"--control", "--key"},
    {"--json", "--quiet"},
    {"--data", "--reactions"},
    {"--end", "--samples"},
    {"--no-reference", "--orders"},
    {"--sample", "--points"},
    {"--seed", "--indices"},
    {"--threads", "--task"},
}};

/// The second option in this row; null: none.
const CLI::Option* beside(const CLI::App& verb, const CLI::Option& option) {
  for (const auto& [first, second] : one_row)
    if (shown_name(option) == first) return verb.get_option_no_throw(std::string(second));
  return nullptr;
}
bool is_beside(const CLI::App& verb, const CLI::Option& option) {
  return std::any_of(one_row.begin(), one_row.end(), [&](const auto& pair) {
    return shown_name(option) == pair.second &&
           verb.get_option_no_throw(std::string(pair.first)) != nullptr;
  });
}

std::string help_of_verb(const CLI::App& verb) {
  std::string out = wrapped("Usage: ", "momenta " + synopsis_of(verb), 7) +
                    wrapped("", verb.get_description() + ".", 0) + "\n";
  for (const CLI::Option* o : verb.get_options()) {
    if (o == verb.get_help_ptr() || is_beside(verb, *o)) continue;
    const CLI::Option* other = beside(verb, *o);
    out += row(name_and_type(*o) + (other ? ", " + name_and_type(*other) : ""), shown_text(*o));
  }
  for (const std::string& sentence : names_behind(verb.get_options()))
    out += wrapped("", sentence, 2);
  if (any_takes(verb.get_options(), "FAMILY")) {
    out += "\nFAMILY:\n";
    for (const Family& f : families()) out += row(f.name, f.what);
  }
  return out + "\n" + verb.get_footer() + "\n";
}

std::string help_of_program(const CLI::App& program) {
  std::string out = wrapped("", program.get_description(), 0);
  out += "\nUsage: momenta VERB [OPTIONS]\n       momenta VERB --help\n\n";
  for (const CLI::App* verb : verbs_of(program))
    out += row(verb->get_name(), verb->get_description());
  out += "\n";
  for (const CLI::Option* o : program.get_options()) out += row(name_and_type(*o), shown_text(*o));
  return out + "\n" + wrapped("", program.get_footer(), 0);
}

}  // namespace

std::size_t columns_of(std::string_view text) {
  std::size_t columns = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool continued = (byte & 0xc0) == 0x80;
    const bool mark = byte == 0xcc || (byte == 0xcd && i + 1 < text.size() &&
                                       static_cast<unsigned char>(text[i + 1]) < 0xb0);
    if (!continued && !mark) ++columns;
  }
  return columns;
}

std::string screen_help(const CLI::App& app) {
  return app.get_parent() ? help_of_verb(app) : help_of_program(app);
}

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
