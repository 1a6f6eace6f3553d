#pragma once
// A reference solution: a CSV whose first column is `t [s]` and whose other columns are named like
// trajectory columns.

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace momenta {

/// A reference solution, by time and column; immutable once bound.
class Reference {
 public:
  Reference() = default;
  /// Reads the file. @throws SceneError: file, line, what was found, what was expected.
  explicit Reference(const std::filesystem::path& file);
  /// A solution that is not from a file: values by time and by column (without t); `source` names
  /// it.
  Reference(std::string source, std::vector<std::string> columns, std::vector<double> times,
            std::vector<std::vector<double>> values)
      : file_(std::move(source)),
        times_(std::move(times)),
        columns_(std::move(columns)),
        values_(std::move(values)) {}

  const std::string& file() const { return file_; }            ///< the file, or another source
  const std::vector<double>& times() const { return times_; }  ///< ascending [s]
  /// Names of the columns without t, "name [unit]".
  const std::vector<std::string>& columns() const { return columns_; }
  const std::vector<std::vector<double>>& values() const { return values_; }  ///< by time, column

  /// Matches the columns with those of a trajectory ("t [s]" first). @throws SceneError naming a
  /// column that the trajectory does not have.
  void bind(const std::vector<std::string>& trajectory_columns);

  /// The text of the CSV file that the constructor reads, with all digits of each number.
  std::string csv() const;

  /// Whether there are columns in N or N m. After bind().
  bool has_forces() const;

  /// The error of a row against the reference.
  struct Error {
    double position = 0;  ///< max |value − ref| / (1 + |ref|) over columns in rad and m
    double velocity = 0;  ///< the same over columns in rad/s and m/s
    /// The same over columns in N and N m; not a number where none is unique.
    double force = std::numeric_limits<double>::quiet_NaN();
  };
  /// The error of a trajectory row at the reference time of index `row`, without the columns that
  /// are not unique there (places in the trajectory, ascending). After bind().
  Error error(std::size_t row, const std::vector<double>& trajectory_row,
              const std::vector<std::size_t>& not_unique = {}) const;

 private:
  std::string file_;
  std::vector<double> times_;
  std::vector<std::string> columns_;
  std::vector<std::vector<double>> values_;  ///< by time, by column
  std::vector<std::size_t> place_;           ///< of each column in a trajectory row
  enum class Kind { position, velocity, force };
  std::vector<Kind> kind_;
};

}  // namespace momenta
