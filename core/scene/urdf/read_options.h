#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace momenta {

/// Options for files of robots: what the formats themselves cannot say.
struct ReadOptions {
  /// URDF: YAML file with the loops; empty: the file of the same name beside the URDF, if there is
  /// one.
  std::filesystem::path loops;
  bool free_root = false;  ///< URDF: true: the root link floats; false: it is fixed to the ground
  /// MJCF: the `<key>` at whose state the scene starts, by name or by number from 0; empty: as
  /// drawn
  std::string key;
  /// MJCF: constant controls of actuators, "NAME=VALUE", or "VALUE" for all; the others are at 0.
  /// Empty: actuators are left out.
  std::vector<std::string> controls;
};

}  // namespace momenta
