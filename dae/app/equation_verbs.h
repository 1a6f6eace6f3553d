#pragma once
// The verbs `run`, `index`, `work` and `bench` of files of equations.

#include <momenta/dae/analysis/equations/suite.h>

#include <functional>
#include <string>
#include <vector>

#include "options.h"

namespace momenta::program {

struct WorkOptions {
  std::string forms, integrators;  ///< comma-separated; empty: all forms, dop853
  double loosest = 1e-4, tightest = 1e-12;
  double per_decade = 1;
  int step_rungs = 6;         ///< fixed steps, each half of the last
  bool no_reference = false;  ///< judge by drift alone
  bool orders = false;        ///< print observed orders in place of the conclusion
};
/// 1e-4, 1e-5, … in the given range. @throws std::invalid_argument
std::vector<double> tolerance_rungs(const WorkOptions& w);

int run_equation_file(const Options& o);
int index_of_equations(const Options& o);
int work_on_equations(const Options& o, const WorkOptions& w);

/// `run` fills the result, prints it and writes its files to --out. Returns the exit status.
int publish_suite(const Options& o, SuiteResult& result, bool own_references,
                  const std::function<void(const SuiteRequest&)>& run);

}  // namespace momenta::program
