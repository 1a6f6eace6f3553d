#pragma once
// The scalars of a run's result, each declared once: its name, unit, place in summary.json, and
// meaning. study.csv, summary.json, the attributes of momenta.Run in Python and the tables of
// errors take them from here.

#include <momenta/dae/run/run_result.h>

#include <string>
#include <variant>
#include <vector>

namespace momenta {

struct RunQuantity {
  using Value = std::variant<std::string, double, long, bool>;

  const char* name;     ///< attribute in Python, heading in study.csv
  const char* unit;     ///< "s", or "drift", "drift/s" of RunResult::drift_unit; empty: 1 or none
  const char* pointer;  ///< JSON pointer in summary.json; null: not there
  bool column;          ///< of study.csv
  bool attribute;       ///< of momenta.Run
  Value (*value)(const RunResult&);
  const char* meaning;

  /// The heading in study.csv: `name [unit]`.
  std::string heading(const std::string& drift_unit) const;
};

/// In the order of study.csv.
const std::vector<RunQuantity>& run_quantities();

/// A kind of error against the reference: its series at the samples and its largest value.
struct RunError {
  std::vector<double> Series::*series;
  double RunResult::*largest;
  const char* symbol;  ///< of the quantity, in tables
  bool always;         ///< in tables of observed orders even where nothing was measured
};

/// In the order of tables of observed orders.
const std::vector<RunError>& run_errors();

}  // namespace momenta
