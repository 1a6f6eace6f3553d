#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace momenta {

/// Options for URDF and MJCF files: what the format itself cannot say.
struct ReadOptions {
  /// YAML file with the loops; empty: the file of the same name beside the URDF, if there is one.
  std::filesystem::path loops;
  bool free_root = false;  ///< true: the root link floats; false: it is fixed to the ground
  /// Of MJCF: constant controls of actuators, "NAME=VALUE", or "VALUE" for all; the others are at
  /// 0. Empty: actuators are left out.
  std::vector<std::string> controls;
};

}  // namespace momenta
