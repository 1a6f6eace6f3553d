#pragma once
// How the start of a form depends on the numbers of a run: y(0) = (q, p) or (q, u) of the assembled
// scene, assembly included, its choice of the nearest pose, of rates, and p = M u + Φ_qᵀσ with what
// the gauge begins with. Differences of sixth order of the start itself (sixth_order.h); loops are
// closed to rounding on both sides, not to the tolerance of the assembly, so that these have 12
// digits.

#include <momenta/dae/form/form.h>
#include <momenta/dae/gradient/number_slopes.h>
#include <momenta/dae/gradient/row_derivatives.h>
#include <momenta/dae/gradient/run_variable.h>

namespace momenta {

/// Mechanisms at other values of each variable; none of a start value, and, with `slopes`, none of
/// what inertias, gravity, springs and dampers alone depend on. @throws SceneError where there is
/// none within three differences, or it has other coordinates or equations. Cost: six scenes read
/// for each parameter; with `slopes` six for numbers of these kinds together, one of each body,
/// joint and spring
std::vector<OtherParameter> other_parameters(const SceneText& scene, const Mechanism& mechanism,
                                             const std::vector<RunVariable>& variables,
                                             const NumberSlopes* slopes = nullptr);

struct StartTangents {
  Eigen::MatrixXd of_state;         ///< dy(0), size of y × variables
  std::vector<std::string> broken;  ///< sentences on variables by which the start has no derivative
};

/// Of the form of this name; the gains of `options` are held. Of variables that have `numbers`
/// and no mechanisms columns stay zero. @throws SceneError. Cost: six to twelve assemblies for each
/// variable
StartTangents start_tangents(const Mechanism& mechanism, const std::string& form,
                             const FormOptions& options, const std::vector<RunVariable>& variables,
                             const std::vector<OtherParameter>& others);

}  // namespace momenta
