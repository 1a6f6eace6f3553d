#pragma once
// Names of a linear model's states, inputs and outputs, and how they are chosen by name.

#include <momenta/dae/linear/independent_coordinates.h>

#include <string>
#include <vector>

namespace momenta {

/// A column and the group that names it too.
struct GroupedColumn {
  Column column;
  std::string group;
};

struct LinearColumns {
  std::vector<Column> minimal, descriptor;     ///< states
  std::vector<GroupedColumn> inputs, outputs;  ///< all there are
  std::vector<std::string> left_out;           ///< rows, in words
  std::vector<int> free;                       ///< places in u of the freed mechanism
};

/// In the order in which linear_model() has them.
LinearColumns linear_columns(const OperatingPoint& at, const IndependentCoordinates& chosen);

/// Places of the columns with these names, in their order: of the column, of what stands before the
/// last point, or of a group. None: all. @throws SceneError for a name that is not known or chosen
/// twice; `what`: "input"
std::vector<int> picked(const std::vector<GroupedColumn>& columns,
                        const std::vector<std::string>& names, const std::string& what);

/// Places in u of coordinates by name. @throws SceneError
std::vector<int> independent_places(const OperatingPoint& at,
                                    const std::vector<std::string>& names);

}  // namespace momenta
