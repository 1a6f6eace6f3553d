#pragma once
// Verbs of the command line, with their options and functions.

#include <functional>

#include "answers.h"

namespace momenta::program {

/// A verb with its options; `of_equations`: its function for files of equations, if any.
struct Verb {
  CLI::App* app;
  std::function<int()> answer, of_equations = {};
};

/// `app` and the options must outlive the verb.
Verb add_check(CLI::App& app, Options& o);
Verb add_assemble(CLI::App& app, Options& o);
Verb add_run(CLI::App& app, Options& o);
Verb add_drift(CLI::App& app, Options& o);
Verb add_work(CLI::App& app, Options& o);
Verb add_bench(CLI::App& app, Options& o);
Verb add_evaluate(CLI::App& app, Options& o);
Verb add_index(CLI::App& app, Options& o);
Verb add_modes(CLI::App& app, Options& o);
Verb add_linearise(CLI::App& app, Options& o);
Verb add_move(CLI::App& app, Options& o);
Verb add_effort(CLI::App& app, Options& o);
Verb add_fit(CLI::App& app, Options& o);
Verb add_gradient(CLI::App& app, Options& o);
Verb add_view(CLI::App& app, Options& o);
Verb add_stress(CLI::App& app, Options& o);
Verb add_sweep(CLI::App& app, Options& o);
Verb add_section(CLI::App& app, Options& o);
Verb add_convert(CLI::App& app, Options& o);
Verb add_make(CLI::App& app, Options& o);
Verb add_completion(CLI::App& app, Options& o);
Verb add_manual(CLI::App& app, Options& o);

}  // namespace momenta::program
