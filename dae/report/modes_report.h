#pragma once
// Equilibrium and modes as text, CSV and JSON; keys and columns are public interface:
// docs/reference/modes.md.

#include <momenta/dae/study/modes_study.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// "A stable equilibrium …; the lowest of 3 modes swings at 0.50 Hz": what there is to know first.
std::string modes_in_words(const ModesResult& result);

/// The table of modes, with those words above it.
std::string modes_table(const ModesResult& result);

/// A line a mode: number, kind, s, frequency, damping ratio, then the shape by rate; imaginary
/// parts of shapes where any mode has them.
std::string modes_csv(const ModesResult& result);

nlohmann::ordered_json modes_json(const ModesResult& result);

/// "hip.q 1, knee.q −0.41": what moves most, the largest entry as 1.
std::string largest_entries(const ModesResult& result, const Mode& mode, std::size_t most = 3);

}  // namespace momenta
