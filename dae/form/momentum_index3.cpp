// momentum-index3
//
// Unknowns      q, p; λ
// Equations     (5a)-(5c): M u = p with u the rates of q̇,  ṗ = L_q + Q − Φ_qᵀλ,  Φ(q, t) = 0.
//               Here p = ∂L/∂u (4), without Φ_qᵀσ; −∂H/∂q of (5b) is L_q at u.
// Index         3: Φ gives Φ̇ = Φ_q M⁻¹p + Φ_t, and that gives λ. The paper states index 2, which is
//               true with σ in place of λ: `momentum-index2`.
// Hidden        Φ̇ = 0 and Φ̈ = 0
// Multipliers   λ, a force
// Drifts        Φ at the Newton tolerance; Φ̇ at the local error of p, one power of the step worse.
//               u comes from M u = p: nothing corrects it to Φ̇ = 0.
// Source        paper, eqs. (5a)-(5c); Brenan, Campbell, Petzold, Numerical Solution of
//               Initial-Value Problems in DAEs

#include <momenta/dae/form/dae_form.h>
#include <momenta/dae/form/form_entry.h>

namespace momenta {
namespace {

class MomentumIndex3 final : public DaeFormOf<MomentumIndex3> {
 public:
  MomentumIndex3(const Mechanism& mechanism, const FormOptions& options, const Start& start)
      : DaeFormOf("momentum-index3", mechanism,
                  {mechanism.nq(), mechanism.nv(), mechanism.m(), false, false, 2}, options, start,
                  Unknowns::momenta) {}

  template <class S>
  void rows(DaeScratch<S>& s, double t, const S* y, const S* ydot, S* r) {
    position_rows(s, hamilton_rows(s, t, y, ydot, r));
  }

 protected:
  bool rate_is_tested() const override { return false; }  // BDF converges for p one order late
};

}  // namespace

FormEntry momentum_index3_entry() {
  return {
      .name = "momentum-index3",
      .kind = FormEntry::Kind::dae,
      .positions = true,
      .lower_on_rates = true,
      .colour = 6,
      .place = 12,
      .words = {.x = "p",
                .s = "λ",
                .constraints = {given(equation::positions), hidden(1, "Φ̇ = Φ_q M⁻¹p + Φ_t = 0", ""),
                                hidden(2,
                                       "Φ̈ = Φ_q M⁻¹ṗ + d/dt(Φ_q M⁻¹) p + Φ̇_t = 0 with ṗ from (5b)",
                                       "λ")}},
      .make = made<MomentumIndex3>};
}

}  // namespace momenta
