#pragma once
// A CSV whose columns have names that are known beforehand: what is wanted of a mechanism, or what
// was measured on one. Names as in move.csv and trajectory.csv, the unit may be left out; an empty
// cell says nothing.

#include <momenta/dae/mechanism.h>

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace momenta {

/// What may stand in such a file, and its words.
struct NamedTableForm {
  const char* kind;           ///< "file of wanted poses"
  const char* rows;           ///< "poses"
  const char* other;          ///< of a column: "is no coordinate and no position of a marker"
  const char* whole_alone;    ///< where the column `whole` is the only one
  std::vector<Column> known;  ///< columns that it may have
  std::size_t whole = 0;      ///< which of them has no empty cells
};

/// Its numbers.
struct NamedTable {
  std::vector<std::size_t> columns;  ///< of each column its place among the known ones
  Eigen::MatrixXd values;            ///< rows × columns; NaN where a cell is empty
  std::vector<int> lines;            ///< of each row its line in the file
};

/// @throws SceneError: file, line, what was found, what was expected
NamedTable read_named_table(const std::filesystem::path& file, const NamedTableForm& form);

}  // namespace momenta
