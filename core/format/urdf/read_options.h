#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace momenta {

/// Options for files of robots, beyond the formats themselves. `stops` is for any format.
struct ReadOptions {
  /// URDF: YAML file with the loops; empty: the file of the same name beside the URDF, if any.
  std::filesystem::path loops;
  bool free_root = false;  ///< URDF: the root link floats; else it is fixed to the ground
  /// MJCF: the `<key>` of the start, by name or by number from 0; empty: as drawn
  std::string key;
  /// MJCF: constant controls of actuators, "NAME=VALUE", or "VALUE" for all; the others are 0.
  /// Empty: actuators are left out.
  std::vector<std::string> controls;
  /// Stops at the limits of joints without their own: stop_stiffness [N m/rad or N/m] and
  /// stop_damping [N m s/rad or N s/m]. Empty: limits exert no force. Driven joints get none.
  std::optional<std::array<double, 2>> stops;
};

}  // namespace momenta
