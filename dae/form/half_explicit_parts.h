#pragma once
// Base of the two forms of index 2 as half-explicit systems: evaluations and solvers, made at first
// use. The multipliers z of a stage that satisfy the hidden constraint are those of the right-hand
// side of the ODE form; SplitKkt solves for the z that lead onto the constraint at the next stage.

#include <momenta/dae/form/natural_sizes.h>
#include <momenta/dae/integrator/half_explicit.h>
#include <momenta/dae/kkt/bearing_friction.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/kkt/split_kkt.h>

#include <memory>
#include <string>
#include <vector>

namespace momenta {

class HalfExplicitParts : public HalfExplicit {
 public:
  explicit HalfExplicitParts(const Mechanism& mechanism) : system_(mechanism) {}

  int differential_unknowns() const override { return system_.nq() + system_.nv(); }
  int multipliers() const override { return system_.m(); }
  void normalise(double* y) override;
  std::string dependent(double t, const double* y) override;
  Pivots pivots() const override;
  const std::string& half_explicit_failure() const override { return why_; }

 protected:
  struct Work {
    Work(const Mechanism& mechanism, std::vector<double> compliance);
    std::unique_ptr<Evaluation<double>> e;
    std::unique_ptr<Evaluation<double>> ahead;  ///< placed where a stage leads
    std::unique_ptr<LoopSolver> solver;         ///< null without loops
    std::unique_ptr<BearingFriction> friction;  ///< null without bearings; pushed to both
    SplitKkt kkt;
    std::vector<double> there, u, delta, r, g, correction, centre;
  };
  /// ε of the form's Newton matrix by row of redundant loops (m), or empty.
  virtual const std::vector<double>& newton_regularisation() const = 0;

  Work& work();
  bool failed(std::string sentence);
  /// Finds the friction of bearings, if any, at (t, q, u).
  bool add_bearing_friction(double t, const double* q, const double* u);
  /// Newton's method for Φ(q, t) = 0 by q + δ, M δ + Φ_qᵀν = 0.
  bool meet_positions(double t, double* q, const NaturalSizes& natural);
  /// Φ_q v + Φ_t = 0 by M v + Φ_qᵀν = M v_before, linear.
  bool meet_velocities(double t, const double* q, double* v);
  /// Copies z, which faded rows keep, for a solution that overwrites it.
  const double* centre(const double* z);

  const Mechanism& system_;

 private:
  std::shared_ptr<Work> work_;
  std::string why_;
};

}  // namespace momenta
