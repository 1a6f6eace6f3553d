#pragma once
// What has a gradient, in words: forms, methods and sizes that have one, mechanisms that have an
// adjoint, and what of a scene is not smooth.

#include <momenta/dae/mechanism.h>
#include <momenta/dae/study/run_result.h>

#include <string>
#include <vector>

namespace momenta {

/// @throws std::invalid_argument, one sentence, for a form, a method or a size that has no gradient
void expect_differentiable(const RunSettings& settings, const Mechanism& mechanism);

/// @throws SceneError for a scene whose runs are no motion that is smooth in its numbers: bearings
/// that rub by their reactions, rigid stops
void expect_smooth_motion(const Scene& scene);

/// Whether the scene has corners that a motion may pass: stops, dead bands, friction, whose slope
/// turns within a small rate, laws of steps and tables, whose f̈ turns, and formulas with functions
/// that have some.
bool has_corners(const Scene& scene);

/// What of the scene, and of the functional's function by this name, is not smooth everywhere: a
/// sentence each. Empty `of_functional`: none.
std::vector<std::string> corners(const Scene& scene, const std::string& of_functional);

/// Why a run has no adjoint, one sentence; empty: it has. `along`: derivatives along the run are
/// asked for.
std::string no_adjoint(const Mechanism& mechanism, bool along);

}  // namespace momenta
