#pragma once
// What a library of benchmark problems asks for beside a result, as the IFToMM library does: of
// each problem, for each error that its source accepts, the run of fewest evaluations within it.

#include <momenta/dae/study/run_result.h>
#include <momenta/dae/study/scene_suite.h>

#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// Names of files, "submission-1-a01-pendulum-0.1.txt", and their texts: accuracy, processor time,
/// machine, operating system, method, and the command that makes the solution. Authors are left to
/// be filled in. Nothing of errors that no run meets.
std::vector<std::pair<std::string, std::string>> submissions(const SceneSuiteResult& suite,
                                                             const Environment& environment);

}  // namespace momenta
