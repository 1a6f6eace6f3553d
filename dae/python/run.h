#pragma once
// The result of a run in Python.

#include <momenta/dae/study/column_named.h>
#include <momenta/dae/study/run_record.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"

namespace momenta::python {

/// A result, with its trajectory as one block of rows.
struct Run {
  RunResult result;
  std::vector<double> rows;

  explicit Run(RunResult made) : result(std::move(made)) {
    for (const auto& row : result.trajectory.rows) rows.insert(rows.end(), row.begin(), row.end());
    result.trajectory.rows.clear();
    result.trajectory.rows.shrink_to_fit();
  }
  std::size_t columns() const { return result.trajectory.columns.size(); }
  std::size_t column(const std::string& name) const {
    if (const auto at = column_named(result.trajectory.columns, name)) return *at;
    throw py::key_error("no column '" + name + "'; `columns` has all of them");
  }
};
using RunPtr = std::shared_ptr<Run>;

}  // namespace momenta::python
