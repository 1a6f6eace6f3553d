#pragma once
#include <momenta/dae/equations/suite.h>

#include <functional>

namespace momenta::program {

struct Options;

/// `run` fills the result, prints it and writes its files to --out. Returns the exit status.
int publish_suite(const Options& o, SuiteResult& result, bool own_references,
                  const std::function<void(const SuiteRequest&)>& run);

}  // namespace momenta::program
