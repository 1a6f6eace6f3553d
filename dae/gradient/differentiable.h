#pragma once
// Forms, methods and sizes that have a gradient, mechanisms that have an adjoint, and what of a
// scene is not smooth, in words.

#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/run/run_result.h>

#include <string>
#include <vector>

namespace momenta {

/// @throws std::invalid_argument, one sentence, for a form, method or size without gradient
void expect_differentiable(const RunSettings& settings, const Mechanism& mechanism);

/// @throws SceneError for motions that are not smooth in the scene's numbers: bearings that rub by
/// their reactions, rigid stops
void expect_smooth_motion(const Scene& scene);

/// Whether a motion may pass corners: stops, dead bands, friction (its slope turns within a small
/// rate), laws of steps and tables (f̈ turns), formulas with such functions.
bool has_corners(const Scene& scene);

/// A sentence for each part of the scene, and for the functional's function of this name (empty:
/// none), that is not smooth everywhere.
std::vector<std::string> corners(const Scene& scene, const std::string& of_functional);

/// Why a run has no adjoint, one sentence; empty: it has. `along`: derivatives along the run are
/// asked for.
std::string no_adjoint(const Mechanism& mechanism, bool along);

}  // namespace momenta
