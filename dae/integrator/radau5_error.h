#pragma once
// The local error of a step of Radau IIA, the embedded formula of order 3 with γ_0 = 1/γ and the
// old rate,
//
//   d = γ_0 h y'_n + e_1 Z_1 + e_2 Z_2 + e_3 Z_3,  err = J(γ/h)⁻¹ (γ/h) ∂F/∂y' d,
//
// filtered once more where it fails at the start or after a rejection. For M y' = f this is
// RADAU5's estimate; ∂F/∂y' has no columns for multipliers, whatever their rate in d. Norms weigh a
// variable of index 2 by h (DaeSystem::weight); multipliers are in none.
//
// Error and estimate are of orders 5 and 3, so the estimate is held at 0.1 tol^(2/3). In long runs
// each step has a share of the tolerance (local_newton.h), the estimate its power 2/3. With gauge
// reset it is measured by what moves alone (gauge_symmetry.h). Source: Hairer, Wanner, Solving
// Ordinary Differential Equations II, IV.8, VII.4.

#include <momenta/dae/integrator/gauge_symmetry.h>
#include <momenta/dae/integrator/integration.h>
#include <momenta/dae/integrator/local_newton.h>
#include <momenta/dae/integrator/radau5_stages.h>
#include <momenta/dae/integrator/weighted_norm.h>

#include <vector>

namespace momenta::radau5 {

struct StepStart {
  double t;
  const double *y, *ydot;
};

class LocalError {
 public:
  /// `gauge` null: none.
  LocalError(const DaeSystem& system, GaugeSymmetry* gauge, const IntegrationOptions& options,
             double span);

  /// Norm for Newton's corrections of a step of length h from y; its weights stay until forget().
  const WeightedNorm& norm(const double* y, double h);
  void forget() { weighed_for_ = 0; }
  /// Fraction of the estimate's tolerance at which Newton stops.
  double fraction() const;
  /// Whether corrections that do not shrink are rounding: of the motion they change no more than a
  /// tenth of its tolerance (as bdf_step.h has it). The rest of them is along Φ_qᵀ, as large as the
  /// rounding of q makes it.
  bool rounding_is_left(const Stages& stages, const StepStart& start);
  /// Error of the stages z over the tolerance; `doubtful`: at the start of a run or after a
  /// rejection.
  double of(Stages& stages, const Factors& factors, const StepStart& start, double h,
            const StageValues& z, bool doubtful);
  void passed(double h) { share_.passed(h); }

 private:
  /// Share of the estimate's tolerance.
  double share() const;
  double size(const StepStart& start);

  GaugeSymmetry* gauge_;
  const IntegrationOptions& options_;
  LocalShare share_;
  double inner_;  ///< tolerance of the estimate
  WeightedNorm norm_;
  double weighed_for_ = 0;  ///< length of the step of the weights
  std::vector<double> error_;
};

}  // namespace momenta::radau5
