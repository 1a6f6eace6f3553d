#pragma once
// Numbers of a scene given from outside, for sweeps over parameters.

#include <momenta/core/scene/scene.h>

#include <string>
#include <string_view>
#include <vector>

namespace momenta {

/// A number in place of the one that a scene's text has, or leaves out.
struct Setting {
  /// KIND.NAME.KEY of a table with a name, KEY or TABLE.KEY of the others; an element of an array
  /// by its number: "body.crank.mass", "loop.E2.origin.parent.0", "gravity.1", "run.end"; the name
  /// of a parameter, in place of its number or formula. SI units.
  std::string place;
  double value = 0;
};

/// The scene of a TOML text with other numbers in it; as parse_scene in every other respect.
/// @throws std::invalid_argument for a place that the scene does not have, one sentence; SceneError
/// for what the scene then is.
Scene parse_scene(std::string_view text, const std::string& file,
                  const std::vector<Setting>& settings);

}  // namespace momenta
