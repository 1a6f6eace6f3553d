#pragma once
// Times at which inputs of a scene change in a run: laws of drives, and forces, equations of loops
// and
// Lagrangians that take the time (core/expression/input_times.h).

#include <momenta/core/scene/scene.h>

#include <vector>

namespace momenta {

/// The times inside the run, ascending [s]. @pre a valid scene. Cost: 4097 values of each input
std::vector<double> input_times(const Scene& scene, double t0, double end);

}  // namespace momenta
