#pragma once
// How a form's start depends on the numbers of a run: y(0) = (q, p) or (q, u) of the assembled
// scene, with its choice of the nearest pose and rates, and p = M u + Φ_qᵀσ with the gauge's first
// σ. Differences of sixth order (sixth_order.h); loops are closed to rounding on both sides, which
// leaves 12 digits.

#include <momenta/dae/form/form.h>
#include <momenta/dae/gradient/other_parameters.h>

namespace momenta {

struct StartTangents {
  Eigen::MatrixXd of_state;         ///< dy(0), size of y × variables
  std::vector<std::string> broken;  ///< sentences on variables by which the start has no derivative
};

/// Tangents of the form of this name; the gains of `options` are held. Columns stay zero for
/// variables whose start is taken at once (start_adjoint.h). @throws SceneError. Cost: six to
/// twelve assemblies for each other variable
StartTangents start_tangents(const Mechanism& mechanism, const std::string& form,
                             const FormOptions& options, const std::vector<RunVariable>& variables,
                             const std::vector<OtherParameter>& others);

/// A change of y(0) that loops allow, by displacements and rates of ±1 in all joints: what a run
/// amplifies shows in its tangent. Size of y × 1. One factorisation
Eigen::MatrixXd any_start_change(const Mechanism& mechanism, const Start& start, bool momenta);

}  // namespace momenta
