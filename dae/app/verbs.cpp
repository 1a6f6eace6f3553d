// The list of verbs. momenta_main_job has `main` ones alone, to halve its compile time; asked for
// another, it says how to build that.

#include <cstdio>

#include "equation_verbs.h"
#include "verb.h"

// clang-format off
/// In listing order.
#define MOMENTA_VERBS(main, other) \
  other(check)                     \
  other(assemble)                  \
  main(run)                        \
  main(drift)                      \
  other(work)                      \
  other(bench)                     \
  other(evaluate)                  \
  other(index)                     \
  other(modes)                     \
  other(linearise)                 \
  other(move)                      \
  other(effort)                    \
  other(fit)                       \
  other(gradient)                  \
  main(view)                       \
  other(stress)                    \
  other(sweep)                     \
  other(section)                   \
  other(convert)                   \
  main(make)                       \
  main(completion)                 \
  main(manual)
// clang-format on

namespace momenta::program {

#define MOMENTA_DECLARED(name) Verb declare_##name(CLI::App& app, Options& o);
#define MOMENTA_ADDED(name) verbs.push_back(declare_##name(app, o));
MOMENTA_VERBS(MOMENTA_DECLARED, MOMENTA_DECLARED)

#ifdef MOMENTA_MAIN_JOB

namespace {

int left_out(const char* verb) {
  std::fprintf(
      stderr,
      "momenta: this program has run, view, drift and make alone; for '%s' build all verbs:"
      " cmake --build --preset release --target momenta\n",
      verb);
  return bad_input;
}

/// A verb that takes whatever is typed behind it.
Verb left_out_verb(CLI::App& app, const char* name) {
  CLI::App* verb = app.add_subcommand(name)->group("")->allow_extras();
  verb->set_help_flag();
  return {verb, [name] { return left_out(name); }};
}

}  // namespace

int run_equation_file(const Options&) {
  return left_out("run of equations");
}

#define MOMENTA_OTHER(name) verbs.push_back(left_out_verb(app, #name));
#else
#define MOMENTA_OTHER MOMENTA_ADDED
#endif

std::vector<Verb> all_verbs(CLI::App& app, Options& o) {
  std::vector<Verb> verbs;
  MOMENTA_VERBS(MOMENTA_ADDED, MOMENTA_OTHER)
  return verbs;
}

}  // namespace momenta::program
