#pragma once
// Scenes with other numbers in place of those of a run, and the slopes of the numbers of its tables
// by its parameters: differences of sixth order (sixth_order.h) of scenes as read.

#include <momenta/dae/gradient/number_slopes.h>
#include <momenta/dae/gradient/row_derivatives.h>
#include <momenta/dae/gradient/run_variable.h>

#include <vector>

namespace momenta {

/// Slopes by numbers of the tables, and which of them are taken at once.
struct TakenAtOnce {
  /// Null: none.
  const NumberSlopes* slopes = nullptr;
  /// Also at the start: by inertias and forces, and wherever it is assembled (start_adjoint.h).
  bool slopes_of_start = true, starts = false;
  /// Other reasons to make mechanisms: of θ that change places, or of all.
  bool makes_places = false, makes_all = false;
  /// Only springs and dampers count, and no laws of drives.
  bool plain_forces = false;
};

/// Mechanisms at other values of each variable; none for a start value, nor for a variable taken at
/// once unless asked for. @throws SceneError where there is none within three widths, or it has
/// other coordinates or equations. Cost: six scenes read for each parameter; six together for
/// numbers of bodies, joints, loops and springs that share nothing
std::vector<OtherParameter> other_parameters(const SceneText& scene, const Mechanism& mechanism,
                                             const std::vector<RunVariable>& variables,
                                             const TakenAtOnce& at_once = {});

}  // namespace momenta
