#pragma once
// Wanted poses of a mechanism, from a CSV: a line per pose, columns named like those of move.csv.
// One may be the swept coordinate; without it that is free and only the path counts. An empty cell
// asks for nothing.

#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace momenta {

/// Wanted quantities, pose by pose.
struct WantedPoses {
  /// A column: a coordinate of q, or a component of the position of a marker.
  struct Quantity {
    std::string name;     ///< "P.x"
    std::string unit;     ///< "m"
    int coordinate = -1;  ///< place in q; −1: of a marker
    int marker = -1;      ///< place among the markers; −1: a coordinate
    int component = 0;    ///< 0, 1, 2 for x, y, z of the marker's position
  };
  std::string file;                  ///< for messages
  std::vector<Quantity> quantities;  ///< without the swept coordinate
  std::vector<double> swept;         ///< swept coordinate by pose [rad or m]; empty: free
  Eigen::MatrixXd values;            ///< poses × quantities [rad or m]; NaN: not asked
  /// Count of poses.
  Eigen::Index poses() const { return values.rows(); }
};

/// Reads the file for a mechanism whose coordinate `sweep` is swept. @throws SceneError: file,
/// line, what was found, what was expected
WantedPoses read_wanted(const std::filesystem::path& file, const Mechanism& mechanism,
                        const std::string& sweep);

}  // namespace momenta
