// maximal-coordinates
//
// Unknowns      q, u
// Equations     for every body the acceleration A_k, 6 (planar 3) components; for every joint the
//               reactions y_k in the directions S_k that it constrains; for every loop λ:
//                 M_k A_k + S_kᵀ y_k − Σ 𝒯ᶠ S_cᵀ y_c + J_kᵀ λ = T_k − Ω_k × M_k Ω_k + joint forces,
//                 S_k (A_k − 𝒯ⱽ A_parent − c_k) = 0,   Σ J_k A_k + … = Φ̈ = −2α Φ̇ − β² Φ
//               with q̇ = u, u̇ from A_k − 𝒯ⱽ A_parent − c_k = E u̇
// Index         an ODE
// Hidden        Φ(q, t) = 0 and Φ_q u + Φ_t = 0; the constraints of joints hold by the choice of q
// Multipliers   λ, a force, the correction included; the reactions y_k of the joints are not kept
// Drifts        as `baumgarte`, with the same motion to rounding: Φ and Φ̇ bounded
// Solution      block LDLᵀ ordered along the tree, without fill-in: O(bodies) for a tree. Loops are
//               the auxiliary constraints of the source: m solutions along their paths to the
//               ground, and one m × m matrix
// Left out      body coordinates as the state. The state is q, u here; each evaluation converts it
//               to velocities and accelerations of bodies and back without loss. So joints cannot
//               open and need no feedback, and errors can be compared with other forms. With six
//               coordinates per body every joint would drift as the loops of λ do.
// Gains         as in `baumgarte`
// Source        Baraff, Linear-time dynamics using Lagrange multipliers, SIGGRAPH 1996.

#include <momenta/dae/form/acceleration_form.h>
#include <momenta/dae/form/form_entry.h>
#include <momenta/dae/kkt/loop_solver.h>

namespace momenta {
namespace {

class MaximalCoordinates final : public AccelerationForm {
 public:
  MaximalCoordinates(const Mechanism& mechanism, const FormOptions& options, const Start& start)
      : AccelerationForm("maximal-coordinates", mechanism, options, start,
                         feedback_of(mechanism, options, start)),
        feedback_(feedback_of(mechanism, options, start)) {
    if (mechanism.scene().lagrangian) return;
    solver_ = make_maximal_solver(mechanism, *e_);
    solves_itself_ = true;
  }

  SingularityHandling wanted_handling() const override { return SingularityHandling::none; }

  /// Trees too are solved by their joints' multipliers. A Lagrangian has no joints, and this is
  /// `baumgarte`.
  bool rhs(double t, const double* y, double* ydot) override {
    if (mechanism_.scene().lagrangian) return AccelerationForm::rhs(t, y, ydot);
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

FormEntry maximal_coordinates_entry() {
  return {.name = "maximal-coordinates",
          .colour = 7,
          .place = 15,
          .words = {.x = "u",
                    .solved = "accelerations of all bodies, reactions of all joints and λ, with "
                              "feedback of Φ and Φ̇",
                    .constraints = {invariant(equation::rates), invariant(equation::positions)}},
          .make = made<MaximalCoordinates>};
}

}  // namespace momenta
