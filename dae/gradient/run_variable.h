#pragma once
// Numbers that a run depends on: parameters of the scene, and guesses of its start.

#include <momenta/core/scene/toml/setting.h>
#include <momenta/dae/mechanism.h>

#include <memory>
#include <string>
#include <vector>

namespace momenta {

/// One of them.
struct RunVariable {
  /// Kinds.
  enum class Kind {
    parameter,  ///< a number of the scene's text
    position,   ///< of a joint, from which the scene is assembled
    rate        ///< of a joint, likewise
  };
  Kind kind = Kind::parameter;  ///< its kind
  std::string name;             ///< "a", "body.crank.mass", "O.q", "O.u"
  std::string unit;             ///< of a start value; of a parameter empty
  int place = -1;               ///< in q or u of a start value
  double value = 0;             ///< of the scene
  double size = 1;              ///< > 0, of which the steps of differences are a part
};

/// A scene as text, of which parameters can be changed.
struct SceneText {
  std::string text;            ///< TOML
  std::string file;            ///< what messages call it
  std::vector<Setting> fixed;  ///< numbers in place of its own
  MechanismOptions options;    ///< of all its mechanisms
  /// The scene with further numbers. @throws SceneError
  Scene scene(const std::vector<Setting>& more = {}) const;
};

/// Of names: a parameter, "a" or "parameters.a"; a coordinate or rate, as in the header of
/// trajectory.csv, but no part of a quaternion; any other number by its place
/// (core/scene/toml/setting.h). `mechanism`: of the scene. @throws std::invalid_argument: one
/// sentence on a name that is not known, or comes twice
std::vector<RunVariable> run_variables(const SceneText& scene, const Mechanism& mechanism,
                                       const std::vector<std::string>& names);

}  // namespace momenta
