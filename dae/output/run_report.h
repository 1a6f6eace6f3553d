#pragma once
// What a single run tells on the terminal.

#include <momenta/dae/run/run_result.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <string>

namespace momenta {

/// Reservations, the row of drift_table(), and a paragraph for each thing there is to tell: what
/// was integrated in its place, ranks, singular poses, columns that are not unique, events, rigid
/// stops, stiffness, the branch of its start. `study` has one run, of the mechanism assembled.
std::string run_report(const StudyResult& study, const Mechanism& mechanism,
                       const Assembly& assembly);

/// Sentence about the mechanism that runs integrated in place of the one written; empty: that one.
std::string integrated_in_words(const StudyResult& study);

}  // namespace momenta
