#pragma once
// Scenes with other numbers in place of those that a run depends on, and what the parameters of
// the run make of the numbers of its tables: differences of sixth order (sixth_order.h) of scenes
// as they are read.

#include <momenta/dae/gradient/number_slopes.h>
#include <momenta/dae/gradient/row_derivatives.h>
#include <momenta/dae/gradient/run_variable.h>

#include <vector>

namespace momenta {

/// What is taken at once of all numbers of the tables, and what is not.
struct TakenAtOnce {
  /// Null: nothing.
  const NumberSlopes* slopes = nullptr;
  /// The start too: of inertias and forces, and wherever it is assembled (start_adjoint.h).
  bool slopes_of_start = true, starts = false;
  /// Something else asks for the mechanisms of those that change places, or of all.
  bool makes_places = false, makes_all = false;
  /// Numbers of springs and dampers alone, and no laws of drives: what follows knows no other.
  bool plain_forces = false;
};

/// Mechanisms at other values of each variable; none of a start value, and none of what is taken at
/// once where nothing asks for them. @throws SceneError where there is none within three
/// differences, or it has other coordinates or equations. Cost: six scenes read for each parameter;
/// six for numbers of bodies', joints', loops' and springs' own together, as far as these share
/// nothing
std::vector<OtherParameter> other_parameters(const SceneText& scene, const Mechanism& mechanism,
                                             const std::vector<RunVariable>& variables,
                                             const TakenAtOnce& at_once = {});

}  // namespace momenta
