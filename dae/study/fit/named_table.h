#pragma once
// A CSV with columns of known names: wanted poses of a mechanism, or measurements on one. Names as
// in move.csv and trajectory.csv, the unit may be left out; an empty cell says nothing.

#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace momenta {

/// Columns of such a file, and words for messages.
struct NamedTableForm {
  const char* kind;           ///< "file of wanted poses"
  const char* rows;           ///< "poses"
  const char* other;          ///< other column: "is no coordinate and no position of a marker"
  const char* whole_alone;    ///< message if `whole` is the only column
  std::vector<Column> known;  ///< permitted columns
  std::size_t whole = 0;      ///< permitted column without empty cells
};

/// Contents of such a file.
struct NamedTable {
  std::vector<std::size_t> columns;  ///< by column: place among the known ones
  Eigen::MatrixXd values;            ///< rows × columns; NaN where a cell is empty
  std::vector<int> lines;            ///< by row: line in the file
};

/// @throws SceneError: file, line, what was found, what was expected
NamedTable read_named_table(const std::filesystem::path& file, const NamedTableForm& form);

}  // namespace momenta
