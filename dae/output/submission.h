#pragma once
// Submissions to a library of benchmark problems, as the IFToMM library wants them: for each
// problem and each error that its source accepts, the run of fewest evaluations.

#include <momenta/dae/run/run_result.h>
#include <momenta/dae/study/scene_suite.h>

#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// Names of files, "submission-1-a01-pendulum-0.1.txt", and their texts: accuracy, processor time,
/// machine, operating system, method, and command. Authors have to be filled in. No file for errors
/// that no run meets.
std::vector<std::pair<std::string, std::string>> submissions(const SceneSuiteResult& suite,
                                                             const Environment& environment);

}  // namespace momenta
