#pragma once
// Numbers of a scene given from outside, for sweeps over parameters.

#include <momenta/core/scene/scene.h>

#include <string>
#include <string_view>
#include <vector>

namespace momenta {

/// A number that replaces or adds one in a scene's text.
struct Setting {
  /// KIND.NAME.KEY of a table with a name, KEY or TABLE.KEY of others; an element of an array by
  /// its number: "body.crank.mass", "loop.E2.origin.parent.0", "gravity.1", "run.end"; or the name
  /// of a parameter. SI units.
  std::string place;
  double value = 0;
};

/// The scene of a TOML text with these numbers in it; otherwise as parse_scene. @throws
/// std::invalid_argument for a place that the scene does not have, one sentence; SceneError for
/// faults of the resulting scene.
Scene parse_scene(std::string_view text, const std::string& file,
                  const std::vector<Setting>& settings);

}  // namespace momenta
