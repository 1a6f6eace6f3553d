#pragma once
// Survival tables of `momenta stress`. Keys of the JSON and columns of the CSV are public
// interface.

#include <momenta/dae/study/stress_study.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// For each ladder a table contestants × rungs, with the verdict and the largest of position drift,
/// energy and error in each cell; then survivals of each contestant; then the cause of every first
/// failure.
std::string stress_table(const StressResult&);
/// A row a run.
std::string stress_csv(const StressResult&);
nlohmann::ordered_json stress_json(const StressResult&);
/// index.html without script: the same tables, causes under each.
std::string stress_page(const StressResult&, const std::string& title);

/// Colour on white ground, for pages and figures: "#dcefe4" for survived, ….
const char* colour_of(Verdict);

/// Largest measured of position drift, energy and error; NaN: none.
double worst_measure(const StressRun&);

/// Results of a contestant over the ladders with all contestants, or over all ladders if there are
/// none such. Without loops only the forms momentum and acceleration take part: open chains would
/// make those two look hardier than they are.
struct Tally {
  int survived = 0, wrong = 0, stopped = 0, slow = 0;
  int rungs = 0;  ///< rungs of those ladders; not tried after a failure is not survived
  int tried() const { return survived + wrong + stopped + slow; }
};
Tally tally(const StressResult&, std::size_t contestant);

}  // namespace momenta
