#pragma once
// A reference solution: a CSV whose first column is `t [s]` and whose other columns are named like
// trajectory columns.

#include <filesystem>
#include <string>
#include <vector>

namespace momenta {

/// A reference solution, by time and column; immutable once bound.
class Reference {
 public:
  Reference() = default;
  /// Reads the file. @throws SceneError: file, line, what was found, what was expected.
  explicit Reference(const std::filesystem::path& file);
  /// Values by time, by column (without t), of a solution from elsewhere: `source` names it.
  Reference(std::string source, std::vector<std::string> columns, std::vector<double> times,
            std::vector<std::vector<double>> values)
      : file_(std::move(source)),
        times_(std::move(times)),
        columns_(std::move(columns)),
        values_(std::move(values)) {}

  const std::string& file() const { return file_; }            ///< or where else it is from
  const std::vector<double>& times() const { return times_; }  ///< ascending [s]
  /// Without t, "name [unit]".
  const std::vector<std::string>& columns() const { return columns_; }
  const std::vector<std::vector<double>>& values() const { return values_; }  ///< by time, column

  /// Matches the columns with those of a trajectory ("t [s]" first). @throws SceneError naming a
  /// column that the trajectory does not have.
  void bind(const std::vector<std::string>& trajectory_columns);

  /// As a file: what the constructor reads, numbers to the last digit.
  std::string csv() const;

  /// How far a row is from the reference.
  struct Error {
    double position = 0;  ///< max |value − ref| / (1 + |ref|) over columns in rad and m
    double velocity = 0;  ///< the same over columns in rad/s and m/s
  };
  /// Error of a trajectory row at reference time number `row`. After bind().
  Error error(std::size_t row, const std::vector<double>& trajectory_row) const;

 private:
  std::string file_;
  std::vector<double> times_;
  std::vector<std::string> columns_;
  std::vector<std::vector<double>> values_;  ///< by time, by column
  std::vector<std::size_t> place_;           ///< of each column in a trajectory row
  std::vector<bool> is_rate_;
};

}  // namespace momenta
