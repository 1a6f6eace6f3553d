#pragma once
// Parameters for which a functional is least, as text, CSV and JSON; keys and columns are public
// interface: docs/reference/fit.md.

#include <momenta/dae/fit/least.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// "max(P.y) is 1.2; as the scene is, 3.4. A minimum, of one start.": what there is to know first.
std::string least_in_words(const LeastResult& result);

/// Parameters before and after as a table, with those words above it and conditions below.
std::string least_table(const LeastResult& result);

/// Of a swept motion, a line a pose: the swept coordinate, and of each formula of single poses what
/// it is before and after; the first line alone where there are none.
std::string least_csv(const LeastResult& result);

nlohmann::ordered_json least_json(const LeastResult& result);

/// Each formula of single poses, before and after, over the way of the swept coordinate from
/// `first`, as pages have them (dae/report/page/timeline.js).
nlohmann::ordered_json least_charts(const LeastResult& result, double first);

}  // namespace momenta
