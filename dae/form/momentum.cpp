// momentum
//
// Unknowns      q, p
// Equations     (7) solved for u and σ at every evaluation, then (8):
//                 M u + Φ_qᵀσ = p,  Φ_q u = −Φ_t;  q̇ = u,  ṗ = L_q + Q + Φ̇_qᵀσ − κ Φ_qᵀσ
//               Here p = ∂L*/∂u of the augmented Lagrangian (6): (34) plus Φ_qᵀσ, not the p of (4).
// Index         an ODE on all of R²ⁿ: any p is consistent
// Hidden        Φ(q, t) = 0
// Multipliers   σ, an impulse; the constraint force is λ = σ̇ + κ σ
// Drifts        Φ like t, because Φ̇ = 0 holds to rounding at every evaluation and only its integral
//               has an error. Without a gauge σ grows like t under a mean load, the local error
//               grows with it, and Φ grows like t².
// Gauge         none; leak κ; reset (p ← M u, σ ← 0 after each step: exact, since the gauge is a
//               symmetry); flip (p −= 2 Φ_qᵀσ, σ ← −σ after each step: σ oscillates about zero.
//               Flip is an involution that commutes with time reversal, so a symmetric method stays
//               reversible; with reset, a projection, it does not. Both keep dq∧dp on Φ_q dq = 0.)
// Stabilised    with β the second row is Φ_q u = −Φ_t − βΦ, so Φ̇ = −βΦ: errors of Φ decay like
//               e^(−βt), and Φ stays bounded. The motion is that of (7), (8) where Φ = 0;
//               elsewhere u has a part of the size βΦ that comes from no force.
// Without loops there is no σ: (q, p) → (q̇, ṗ) is the recursion (35)-(48), momentum_recursion.h.
// Source        Naudet, Lefeber, Terze, eqs. (6)-(8); Bayo, Avello, Nonlinear Dynamics 5 (1994).

#include <momenta/dae/form/form_entry.h>
#include <momenta/dae/form/hamiltonian_parts.h>
#include <momenta/dae/form/momentum_form.h>

namespace momenta {
namespace {

class Momentum final : public MomentumForm, public HamiltonianParts {
 public:
  Momentum(const Mechanism& mechanism, const FormOptions& options, const Start& start)
      : MomentumForm("momentum", mechanism, options, start, options.beta),
        HamiltonianParts(mechanism) {}
};

}  // namespace

std::unique_ptr<OdeForm> make_momentum(const Mechanism& mechanism, const FormOptions& options,
                                       const Start& start) {
  return std::make_unique<Momentum>(mechanism, options, start);
}

FormEntry momentum_entry() {
  return {.name = "momentum",
          .impulses = true,
          .bearings = true,
          .colour = 0,
          .place = 0,
          .words = {.x = "p",
                    .solved = "(7) for u and σ",
                    .constraints = {invariant(equation::positions)}},
          .make = make_momentum};
}

}  // namespace momenta
