// momentum-index1
//
// Unknowns      q, p; σ
// Equations     M u + Φ_qᵀσ = p with u the rates of q̇ (7), ṗ = L_q + Q + Φ̇_qᵀσ − κ Φ_qᵀσ (8),
//               Φ̇ = 0, or with β Φ̇ = −βΦ
// Index         1: σ and q̇ follow from (7) without differentiation
// Hidden        Φ(q, t) = 0
// Multipliers   σ, an impulse; λ = σ̇ + κ σ
// Drifts        Φ like t, with β bounded; Φ̇ at rounding, with β equal to −βΦ
// Source        paper, eqs. (6)-(8)

#include <momenta/dae/form/dae_form.h>
#include <momenta/dae/form/form_entry.h>
#include <momenta/dae/form/impulse_gauge.h>

namespace momenta {
namespace {

class MomentumIndex1 final : public DaeFormOf<MomentumIndex1>, public ImpulseGauge {
 public:
  MomentumIndex1(const Mechanism& mechanism, const FormOptions& options, const Start& start)
      : DaeFormOf("momentum-index1", mechanism, {mechanism.nq(), mechanism.nv(), mechanism.m()},
                  options, start, Unknowns::impulses),
        ImpulseGauge(mechanism, layout_, gauge(), sizes_),
        beta_(mechanism.m() > 0 ? options.beta : 0) {}

  double beta() const override { return beta_; }

  template <class S>
  void rows(DaeScratch<S>& s, double t, const S* y, const S* ydot, S* r) {
    r = momentum_rows(s, t, y, ydot, r);
    s.e->velocities(r);
    if (beta_ == 0) return;
    s.e->positions(s.a.data());
    for (int i = 0; i < layout_.m; ++i) r[i] += beta_ * s.a[static_cast<std::size_t>(i)];
  }

 private:
  double beta_;
};

}  // namespace

std::unique_ptr<Form> make_momentum_index1(const Mechanism& mechanism, const FormOptions& o,
                                           const Start& s) {
  return std::make_unique<MomentumIndex1>(mechanism, o, s);
}

FormEntry momentum_index1_entry() {
  return {
      .name = "momentum-index1",
      .kind = FormEntry::Kind::dae,
      .impulses = true,
      .colour = 0,
      .place = 8,
      .words = {.x = "p",
                .s = "σ",
                .constraints = {given(equation::of_momenta, "σ"), invariant(equation::positions)}},
      .make = make_momentum_index1};
}

}  // namespace momenta
