#pragma once
// Equilibrium and modes as text, CSV and JSON; keys and columns are public interface:
// docs/reference/modes.md.

#include <momenta/dae/study/modes_study.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// Summary: "A stable equilibrium …; the lowest of 3 modes swings at 0.50 Hz".
std::string modes_in_words(const ModesResult& result);

/// Summary, and the table of modes.
std::string modes_table(const ModesResult& result);

/// A line a mode: number, kind, s, frequency, damping ratio, shape by rate, with imaginary parts if
/// any mode has them.
std::string modes_csv(const ModesResult& result);

nlohmann::ordered_json modes_json(const ModesResult& result);

/// "hip.q 1, knee.q −0.41": relative to the largest.
std::string largest_entries(const ModesResult& result, const Mode& mode, std::size_t most = 3);

}  // namespace momenta
