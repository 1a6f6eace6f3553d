// The verb `manual`: the man page momenta(1) in roff, made from the options themselves. An option
// shared by several verbs is listed once, with their names.

#include <algorithm>
#include <cstdio>

#include "families.h"
#include "help.h"
#include "verb.h"

namespace momenta::program {
namespace {

/// Text for roff, printed unchanged.
std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else if (c == '\'')
      out += "\\(aq";
    else if (c == '^')
      out += "\\(ha";
    else if (c == '~')
      out += "\\(ti";
    else if (c == '"')
      out += "\\(dq";
    else
      out += c;
  }
  return (out.starts_with('.') ? "\\&" : "") + out;
}

std::string bold(const std::string& text) {
  return "\\fB" + plain(text) + "\\fR";
}

/// "--step S" with bold name and italic value.
std::string tag(const CLI::Option& o) {
  if (!o.nonpositional()) return "\\fI" + plain(shown_name(o)) + "\\fR";
  return bold(shown_name(o)) + (is_flag(o) ? "" : " \\fI" + plain(o.get_type_name()) + "\\fR");
}

std::string paragraph(const std::string& head, const std::string& text) {
  return ".TP\n" + head + "\n" + text + "\n";
}

struct Entry {
  std::string head, text;
  std::vector<std::string> verbs;
};

std::vector<Entry> entries_of(const std::vector<const CLI::App*>& verbs, bool options) {
  std::vector<Entry> entries;
  for (const CLI::App* verb : verbs)
    for (const CLI::Option* o : verb->get_options()) {
      if (o->nonpositional() != options || o == verb->get_help_ptr()) continue;
      const std::string head = tag(*o), text = plain(shown_text(*o));
      auto known = std::find_if(entries.begin(), entries.end(),
                                [&](const Entry& e) { return e.head == head && e.text == text; });
      if (known == entries.end()) known = entries.insert(entries.end(), {head, text, {}});
      known->verbs.push_back(verb->get_name());
    }
  return entries;
}

std::string section_of(const std::vector<Entry>& entries, std::size_t verbs) {
  std::string out;
  for (const Entry& e : entries) {
    std::string of;
    for (const std::string& verb : e.verbs) of += (of.empty() ? "" : ", ") + bold(verb);
    out +=
        paragraph(e.head, e.text + "." + (e.verbs.size() == verbs ? "" : "\n.br\nOf " + of + "."));
  }
  return out;
}

std::string man_page(const CLI::App& program) {
  const auto verbs = verbs_of(program);
  std::string out = ".TH MOMENTA 1 \"\" \"" + plain(program.version()) + "\" \"User Commands\"\n";
  out += ".SH NAME\nmomenta \\- constrained multibody systems on canonical momenta\n";
  out += ".SH SYNOPSIS\n" + bold("momenta") + " \\fIVERB\\fR [\\fIOPTIONS\\fR]\n";
  out += ".SH DESCRIPTION\n" + plain(program.get_description()) + "\n";
  out += ".SH VERBS\n";
  std::vector<const CLI::Option*> all;
  for (const CLI::App* verb : verbs) {
    std::string head = bold(verb->get_name());
    for (const CLI::Option* o : verb->get_options())
      if (!o->nonpositional())
        head += (o->get_required() ? " " : " [") + tag(*o) + (o->get_required() ? "" : "]");
    out += paragraph(head, plain(verb->get_description()) + ".");
    for (const CLI::Option* o : verb->get_options()) all.push_back(o);
  }
  out += ".SH ARGUMENTS\n" + section_of(entries_of(verbs, false), verbs.size());
  out += ".SH OPTIONS\n" + section_of(entries_of(verbs, true), verbs.size());
  for (const CLI::Option* o : program.get_options())
    out += paragraph(tag(*o), plain(shown_text(*o)) + ".");
  out += ".SH NAMES\n";
  for (const std::string& sentence : names_behind(all)) out += ".PP\n" + plain(sentence) + "\n";
  if (any_takes(all, "FAMILY")) {
    out += ".PP\nFAMILY:\n";
    for (const Family& f : families()) out += paragraph(bold(f.name), plain(f.what) + ".");
  }
  out += ".SH EXIT STATUS\n" + plain(exit_status) + "\n";
  out += ".SH EXAMPLES\n.EX\n";
  for (const CLI::App* verb : verbs) {
    const std::string footer = verb->get_footer();
    out += plain(footer.substr(footer.find(": ") + 2)) + "\n";
  }
  return out + ".EE\n";
}

}  // namespace

Verb declare_manual(CLI::App& app, Options&) {
  CLI::App* verb = app.add_subcommand("manual", "Prints momenta(1) in roff")->group("");
  return {verb, [&app] { return std::fputs(man_page(app).c_str(), stdout), done; }};
}

}  // namespace momenta::program
