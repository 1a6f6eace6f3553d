#pragma once
// Whether runs of one motion ended on different branches of it. Where reliable runs end in
// different poses behind a singular pose, chance chose which of the motions that meet there each
// followed, whatever a single run saw of it: none is the motion.

#include <momenta/dae/study/run_result.h>

#include <string>
#include <vector>

namespace momenta {

struct Ambiguity {
  bool differ = false;
  double from = not_measured;  ///< the first singular pose [s]
  double apart = 0;            ///< largest difference of end poses [rad or lengths of the scene]
};

/// Compares the runs of the tightest tolerance that reached the end.
Ambiguity ambiguity_of(const std::vector<RunResult>& runs);

/// One clause. @pre they differ
std::string in_words(const Ambiguity& ambiguity);

}  // namespace momenta
