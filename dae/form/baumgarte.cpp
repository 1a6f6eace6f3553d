// baumgarte
//
// Unknowns      q, u
// Equations     (3) with Φ̈ + 2α Φ̇ + β² Φ = 0 in the second row:
//                 M u̇ + Φ_qᵀλ = Q + L_q − Ṁ u,  Φ_q u̇ = −Φ̇_q u − Φ̇_t − 2α Φ̇ − β² Φ;  q̇ = u
// Index         an ODE
// Hidden        Φ(q, t) = 0 and Φ_q u + Φ_t = 0
// Multipliers   λ, a force, the correction included
// Drifts        Φ and Φ̇ stay bounded, at a level set by α, β and the step; the correction
//               does not conserve energy
// Gains         α = β = 1/T unless given, which is critical damping, with T the time scale of the
//               mechanism (1/default_leak): larger gains make the problem stiff for an explicit
//               method, smaller ones let the loops open
// Source        Baumgarte, Comput. Methods Appl. Mech. Eng. 1 (1972).

#include <momenta/dae/form/acceleration_form.h>
#include <momenta/dae/form/form_entry.h>

namespace momenta {

FormEntry baumgarte_entry() {
  return {.name = "baumgarte",
          .bearings = true,
          .colour = 5,
          .place = 5,
          .words = {.x = "u",
                    .solved = "(3) for u̇ and λ, with feedback of Φ and Φ̇",
                    .constraints = {invariant(equation::rates), invariant(equation::positions)}},
          .make = [](const Mechanism& mechanism, const FormOptions& options,
                     const Start& start) -> std::unique_ptr<Form> {
            return std::make_unique<AccelerationForm>("baumgarte", mechanism, options, start,
                                                      feedback_of(mechanism, options, start));
          }};
}

}  // namespace momenta
