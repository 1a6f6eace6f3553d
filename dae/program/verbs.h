#pragma once
// The verbs of the command line: what each takes, and what answers it.

#include <functional>

#include "answers.h"

namespace momenta::program {

/// A verb with its options; `of_equations`: where it takes files of equations, what answers them.
struct Verb {
  CLI::App* app;
  std::function<int()> answer, of_equations = {};
};

/// Each adds its verb to the program; `app` and the options must outlive it.
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
