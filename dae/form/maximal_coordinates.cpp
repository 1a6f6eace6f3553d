// maximal-coordinates
//
// Unknowns      q, u
// Equations     for every body a 6- (3-) vector of acceleration A_k, for every joint the reactions
// y_k
//               in the directions S_k it holds, for every loop λ:
//                 M_k A_k + S_kᵀ y_k − Σ 𝒯ᶠ S_cᵀ y_c + J_kᵀ λ = T_k − Ω_k × M_k Ω_k + joints'
//                 forces S_k (A_k − 𝒯ⱽ A_parent − c_k) = 0,   Σ J_k A_k + … = Φ̈ = −2α Φ̇ − β² Φ
//               with q̇ = u, u̇ from A_k − 𝒯ⱽ A_parent − c_k = E u̇
// Index         an ODE
// Hidden        Φ(q, t) = 0 and Φ_q u + Φ_t = 0; those of the joints hold by the choice of q
// Multipliers   λ, a force, with the correction in it; reactions y_k of the joints beside, not kept
// Drifts        as `baumgarte`, whose motion it is to rounding: Φ and Φ̇ bounded
// Solution      block LDLᵀ ordered along the tree, nothing fills in: O(bodies) for a tree. Loops
// are
//               the source's auxiliary constraints: m solutions along their ways to the ground and
//               one matrix m × m
// Left out      body coordinates as the state. It is q, u here, taken to and from velocities and
//               accelerations of bodies at each evaluation without loss: joints can't open, need no
//               feedback, and errors compare with those of other forms. Six coordinates a body
//               would drift at every joint as λ's loops do.
// Gains         as in `baumgarte`
// Source        Baraff, Linear-time dynamics using Lagrange multipliers, SIGGRAPH 1996.

#include <momenta/dae/form/acceleration_form.h>
#include <momenta/dae/kkt/maximal_solver.h>

namespace momenta {
namespace {

class MaximalCoordinates final : public AccelerationForm {
 public:
  MaximalCoordinates(const Mechanism& mechanism, const FormOptions& options, const Start& start)
      : AccelerationForm("maximal-coordinates", mechanism, options,
                         feedback_of(mechanism, options, start)),
        feedback_(feedback_of(mechanism, options, start)) {
    solver_ = make_maximal_solver(mechanism, *e_);
  }

  SingularityHandling wanted_handling() const override { return SingularityHandling::none; }

  /// Trees too are solved by their joints' multipliers.
  bool rhs(double t, const double* y, double* ydot) override {
    const double *q = y, *u = y + mechanism_.nq();
    if (!solver_->acceleration(t, q, u, centre_.data(), feedback_.alpha, feedback_.beta,
                               ydot + mechanism_.nq(), multipliers_.data()))
      return solver_failed(t, q, "the solution in maximal coordinates");
    if (has_loops()) note_pivots();
    coordinate_rates(q, u, ydot);
    return true;
  }

 private:
  Feedback feedback_;
};

}  // namespace

std::unique_ptr<OdeForm> make_maximal_coordinates(const Mechanism& mechanism,
                                                  const FormOptions& options, const Start& start) {
  return std::make_unique<MaximalCoordinates>(mechanism, options, start);
}

}  // namespace momenta
