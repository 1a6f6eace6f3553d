// acceleration
//
// Unknowns      q, u
// Equations     (3): M u̇ + Φ_qᵀλ = Q + L_q − Ṁ u,  Φ_q u̇ = −Φ̇_q u − Φ̇_t;  q̇ = u
// Index         an ODE
// Hidden        Φ(q, t) = 0 and Φ_q u + Φ_t = 0
// Multipliers   λ, a force
// Drifts        Φ̇ like t, Φ like t²: Φ̈ = 0 is integrated twice
// Projection    with --project this form is `projected`
// Source        paper, eqs. (2), (3).

#include <momenta/dae/form/acceleration_form.h>
#include <momenta/dae/form/form_entry.h>

namespace momenta {

FormEntry acceleration_entry() {
  return {.name = "acceleration",
          .bearings = true,
          .colour = 1,
          .place = 1,
          .words = {.x = "u",
                    .solved = "(3) for u̇ and λ",
                    .constraints = {invariant(equation::rates), invariant(equation::positions)}},
          .make = [](const Mechanism& mechanism, const FormOptions& options, const Start& start) {
            if (options.project) return make_form("projected", mechanism, options, start);
            return std::unique_ptr<Form>(
                std::make_unique<AccelerationForm>("acceleration", mechanism, options, start));
          }};
}

}  // namespace momenta
