#pragma once
// Measurements of a moving mechanism, from a CSV: a column `t [s]` and columns named like those of
// trajectory.csv, coordinates, rates, positions and velocities of markers. A line per time; an
// empty cell: not measured.

#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace momenta {

/// Measured numbers.
struct MeasuredMotion {
  std::string file;                ///< for messages
  std::vector<Column> quantities;  ///< without t
  std::vector<double> times;       ///< ascending [s]
  Eigen::MatrixXd values;          ///< times × quantities, each in its unit; NaN: not measured
  /// Count of measured numbers.
  Eigen::Index count() const { return values.size() - values.array().isNaN().count(); }
};

/// Reads the file for a mechanism. @throws SceneError: file, line, what was found, what was
/// expected
MeasuredMotion read_measured(const std::filesystem::path& file, const Mechanism& mechanism);

}  // namespace momenta
