#pragma once
#include <filesystem>

namespace momenta {

/// What a URDF does not say.
struct ReadOptions {
  /// YAML file with the loops; empty: the one beside the URDF under its name, if there is one.
  std::filesystem::path loops;
  bool free_root = false;  ///< the root link floats; else it is fixed to the ground
};

}  // namespace momenta
