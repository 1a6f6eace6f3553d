#include <momenta/dae/study/ambiguity.h>
#include <momenta/dae/text/number_text.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace momenta {

Ambiguity ambiguity_of(const std::vector<RunResult>& runs) {
  constexpr double another = 0.1;  // pose; no tolerance leaves as much where there is one motion
  double tightest = std::numeric_limits<double>::infinity();
  for (const RunResult& run : runs)
    if (!(run.settings.step > 0)) tightest = std::min(tightest, run.settings.rtol);
  Ambiguity found;
  const RunResult* first = nullptr;
  for (const RunResult& run : runs) {
    const bool rung = run.settings.step > 0 ? std::isinf(tightest) : run.settings.rtol == tightest;
    if (!rung || !reliable(run) || run.status != "done" || run.last_pose.empty()) continue;
    for (const auto& crossing : run.singular_crossings)
      found.from = std::fmin(found.from, crossing.t);
    if (first == nullptr) first = &run;
    for (std::size_t i = 0; i < std::min(run.last_pose.size(), first->last_pose.size()); ++i)
      found.apart = std::max(found.apart, std::abs(run.last_pose[i] - first->last_pose[i]));
  }
  found.differ = !std::isnan(found.from) && found.apart > another;
  return found;
}

std::string in_words(const Ambiguity& ambiguity) {
  return "the motion is ambiguous from t = " + compact(ambiguity.from, 4) +
         " s: past the singular pose there runs ended on different branches, in poses " +
         compact(ambiguity.apart, 2) +
         " rad or lengths of the scene apart, and none is compared with another";
}

}  // namespace momenta
