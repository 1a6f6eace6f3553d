#pragma once
// Columns of a linear model's states, inputs and outputs, and their choice by name.

#include <momenta/dae/analysis/linear/independent_coordinates.h>

#include <string>
#include <vector>

namespace momenta {

struct GroupedColumn {
  Column column;
  std::string group;
};

struct LinearColumns {
  std::vector<Column> minimal, descriptor;     ///< states
  std::vector<GroupedColumn> inputs, outputs;  ///< all
  std::vector<std::string> left_out;           ///< rows in words
  std::vector<int> free;                       ///< places in u of the freed mechanism
};

/// Columns in the order of linear_model().
LinearColumns linear_columns(const OperatingPoint& at, const IndependentCoordinates& chosen);

/// Places of columns by name, in the order of names: the column's, its part before the last point,
/// or a group's. No names: all. @throws SceneError for a name unknown or chosen twice; `what`:
/// "input"
std::vector<int> picked(const std::vector<GroupedColumn>& columns,
                        const std::vector<std::string>& names, const std::string& what);

/// Places in u of coordinates by name. @throws SceneError
std::vector<int> independent_places(const OperatingPoint& at,
                                    const std::vector<std::string>& names);

}  // namespace momenta
