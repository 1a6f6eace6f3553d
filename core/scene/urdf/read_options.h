#pragma once
#include <filesystem>

namespace momenta {

/// Options for URDF files: what the format itself cannot say.
struct ReadOptions {
  /// YAML file with the loops; empty: the file of the same name beside the URDF, if there is one.
  std::filesystem::path loops;
  bool free_root = false;  ///< true: the root link floats; false: it is fixed to the ground
};

}  // namespace momenta
