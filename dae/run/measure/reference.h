#pragma once
// A reference solution: a CSV with first column `t [s]` and others named like measured columns: the
// trajectory with reactions, momenta M u, loop impulses ∫λ dt, and the work of drives and of forces
// without potential (study/force_columns.h).

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace momenta {

/// Immutable once bound.
class Reference {
 public:
  Reference() = default;
  /// @throws SceneError: file, line, what was found, what was expected.
  explicit Reference(const std::filesystem::path& file);
  /// A solution without a file: values by time and by column (without t); `source` names it.
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

  /// Matches the columns with those of a row ("t [s]" first). @throws SceneError naming a column
  /// without a match.
  void bind(const std::vector<std::string>& measured_columns);

  /// CSV for the constructor, with all digits.
  std::string csv() const;

  /// Kind of a column, by its name and unit.
  enum class Kind { position, velocity, force, effort, reaction, momentum, impulse, work };
  /// After bind().
  bool has(Kind kind) const;
  /// λ, efforts or reactions. After bind().
  bool has_forces() const { return has(Kind::force) || has(Kind::effort) || has(Kind::reaction); }
  /// The reference's column for a bound place; columns()' size: none. After bind(). Cost
  /// O(columns).
  std::size_t column_at(std::size_t place) const;

  /// The error of a row against the reference.
  struct Error {
    /// Nothing is compared.
    static constexpr double none = std::numeric_limits<double>::quiet_NaN();
    double position = 0;  ///< max |value − ref| / (1 + |ref|) over columns in rad and m
    double velocity = 0;  ///< the same over columns in rad/s and m/s
    // The same over other columns; NaN where none is unique.
    double force = none;     ///< λ of loops [N, N m]
    double effort = none;    ///< efforts of drives [N, N m]
    double reaction = none;  ///< reactions of joints [N, N m]
    double impulse = none;   ///< ∫λ dt [N s, N m s]
    double work = none;      ///< [J]
  };
  /// Error of a row at reference time `row`, without momenta (study/reference_errors.h) and columns
  /// that are not unique there (places, ascending). After bind().
  Error error(std::size_t row, const std::vector<double>& measured,
              const std::vector<std::size_t>& not_unique = {}) const;

 private:
  std::string file_;
  std::vector<double> times_;
  std::vector<std::string> columns_;
  std::vector<std::vector<double>> values_;  ///< by time, by column
  std::vector<std::size_t> place_;           ///< place of each column in a row
  std::vector<Kind> kind_;
};

}  // namespace momenta
