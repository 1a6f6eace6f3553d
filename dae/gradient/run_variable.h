#pragma once
// Numbers that a run depends on: parameters of the scene, and guesses of its start.

#include <momenta/core/format/toml/setting.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace momenta {

/// A parameter or a start value by which a run is differentiated.
struct RunVariable {
  /// Kinds of variables.
  enum class Kind {
    parameter,  ///< a number of the scene's text
    position,   ///< a joint's, guess for the assembly
    rate        ///< a joint's, likewise
  };
  Kind kind = Kind::parameter;  ///< its kind
  std::string name;             ///< "a", "body.crank.mass", "O.q", "O.u"
  std::string unit;             ///< a start value's unit
  int place = -1;               ///< a start value's place in q or u
  double value = 0;             ///< value in the scene
  double size = 1;              ///< > 0; scale of the steps of differences
};

/// A scene as text, with parameters that can be changed.
struct SceneText {
  std::string text;            ///< TOML
  std::string file;            ///< name in messages
  std::vector<Setting> fixed;  ///< numbers in place of its own
  MechanismOptions options;    ///< options of all its mechanisms
  /// The scene with further numbers. @throws SceneError
  Scene scene(const std::vector<Setting>& more = {}) const;
};

/// Scale of the steps of differences by a number of a scene: its magnitude. Below 1e-12 it may be
/// what rounding left of zero, and stand beside larger numbers, as in "1 + e": there, and at zero,
/// the scale is 1, or the largest power of 1/8 at which `make` makes scenes on both sides, without
/// a SceneError. Cost: two scenes for each power
double step_size(double value, const std::function<void(double)>& make);

/// Variables by name: a parameter, "a" or "parameters.a"; a coordinate or rate, as in the header of
/// trajectory.csv, but no part of a quaternion; any other number by its place
/// (core/format/toml/setting.h). @throws std::invalid_argument: one sentence on a name that is
/// unknown, or comes twice
std::vector<RunVariable> run_variables(const SceneText& scene, const Mechanism& mechanism,
                                       const std::vector<std::string>& names);

}  // namespace momenta
