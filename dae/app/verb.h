#pragma once
// A verb of the command line. The file named after it declares it, with its options and an example,
// and has its function; help, the man page, completions and sentences about what was typed wrong
// follow from the declaration. verbs.cpp lists all verbs.

#include <functional>
#include <memory>
#include <vector>

#include "options.h"

namespace momenta::program {

/// A verb, and what it does with a scene and, if it takes them, with a file of equations.
struct Verb {
  CLI::App* app;
  std::function<int()> answer, of_equations = {};
};

/// The verb `name`, described by `what`, a sentence without its full stop. `example`: a command.
inline CLI::App& add_verb(CLI::App& app, const char* name, const char* what, const char* example) {
  CLI::App& verb = *app.add_subcommand(name, what);
  verb.footer(std::string("Example: ") + example);
  return verb;
}

/// All verbs of this program, in listing order. `app` and `o` must outlive them.
std::vector<Verb> all_verbs(CLI::App& app, Options& o);

}  // namespace momenta::program
