#pragma once
// Survival tables: what `momenta stress` prints and writes. Keys of the JSON and columns of the CSV
// are public interface.

#include <momenta/dae/study/stress_study.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// Per ladder a table contestants × rungs, the verdict and the largest of position drift, energy
/// and error in each cell; then how often each contestant survived; then the cause of every first
/// failure.
std::string stress_table(const StressResult&);
/// One row per run.
std::string stress_csv(const StressResult&);
nlohmann::ordered_json stress_json(const StressResult&);
/// index.html: the same tables, causes under each; needs no script.
std::string stress_page(const StressResult&, const std::string& title);

/// "#dcefe4" for survived, …: pages on white ground, and figures.
const char* colour_of(Verdict);

/// The largest of position drift, energy and error that was measured; NaN for none.
double worst_measure(const StressRun&);

/// How a contestant fared over the ladders that all took part in; of all ladders where there is no
/// such one. Without loops forms other than momentum and acceleration do not take part: open chains
/// would make those two look hardier than they are.
struct Tally {
  int survived = 0, wrong = 0, stopped = 0, slow = 0;
  int rungs = 0;  ///< of those ladders: what was not tried after a failure was not survived
  int tried() const { return survived + wrong + stopped + slow; }
};
Tally tally(const StressResult&, std::size_t contestant);

}  // namespace momenta
