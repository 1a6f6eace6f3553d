#pragma once
// Rows of a loop of a scene, from its kind and from what drives prescribe of it.

#include <momenta/core/scene/scene.h>

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// Drives of one loop; null: none.
struct LoopDrives {
  std::array<const DriveSpec*, 3> coordinate{}, origin{};
  bool drives_coordinates() const { return coordinate[0] || coordinate[1] || coordinate[2]; }
};
using DrivesOfLoops = std::map<std::string, LoopDrives>;
DrivesOfLoops drives_of_loops(const Scene& scene);

/// In the joint frame, as columns: `direction` or its default, across that, and `axis`.
Eigen::Matrix3d frame_across(const LoopSpec& loop);

struct LoopChoice {
  struct Along {
    const DriveSpec* drive;
    Eigen::Vector3d axis;  ///< in the joint frame
  };
  /// Axes 1, 2, 3 in the joint frame: in space, and of loops with curves, whose axis is the third.
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
  std::vector<int> points;                ///< j of the D_j rows
  std::vector<std::pair<int, int>> axes;  ///< (i, j) of the O_ij rows
  std::vector<std::string> names;         ///< names of all rows
  std::vector<Along> translations;        ///< displacements of x_B
  std::vector<Along> turns_a, turns_b;    ///< turns of the axes of A and B, in order
};

/// Rows and prescribed motion; distances, couplers and, last, the row of a higher pair have only
/// their names. In a plane axis 1 is that of the slide or of the slot, axis 2 across it.
LoopChoice choose_rows(const LoopSpec& loop, const LoopDrives& drives, bool planar);

}  // namespace momenta
