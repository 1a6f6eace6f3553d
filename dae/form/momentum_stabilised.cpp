// momentum-stabilised
//
// Unknowns      q, p; v, σ, μ
// Equations     q̇ = v − Φ_qᵀμ,  M v + Φ_qᵀσ = p,  ṗ as (8) at v,  Φ_q v + Φ_t = 0,  Φ = 0
// Index         2; the equations contain both levels of the constraint
// Hidden        none at position or velocity level
// Multipliers   σ, an impulse; μ, the position correction per unit time, zero in exact arithmetic
// Drifts        nothing: Φ and Φ̇ at the Newton tolerance
// Source        (7)-(8) with the extra multiplier of Gear, Gupta, Leimkuhler, J. Comput. Appl.
//               Math. 12 (1985)

#include <momenta/dae/form/dae_form.h>
#include <momenta/dae/form/form_entry.h>
#include <momenta/dae/form/impulse_gauge.h>

namespace momenta {
namespace {

class MomentumStabilised final : public DaeFormOf<MomentumStabilised>, public ImpulseGauge {
 public:
  MomentumStabilised(const Mechanism& mechanism, const FormOptions& options, const Start& start)
      : DaeFormOf("momentum-stabilised", mechanism,
                  {mechanism.nq(), mechanism.nv(), mechanism.m(), true, true}, options, start,
                  Unknowns::impulses),
        ImpulseGauge(mechanism, layout_, gauge(), sizes_) {}

  template <class S>
  void rows(DaeScratch<S>& s, double t, const S* y, const S* ydot, S* r) {
    const S *q = y, *p = y + layout_.x(), *v = y + layout_.v(), *sigma = y + layout_.s();
    const S* pdot = ydot + layout_.x();
    r = kinematic_rows(s, t, y, ydot, r);
    s.e->momenta(sigma, s.a.data());
    s.e->momentum_rates(q, v, sigma, leak(), s.b.data());
    for (int i = 0; i < layout_.nv; ++i) *r++ = pdot[i] - s.b[static_cast<std::size_t>(i)];
    for (int i = 0; i < layout_.nv; ++i) *r++ = s.a[static_cast<std::size_t>(i)] - p[i];
    both_levels(s, y, r);
  }
};

}  // namespace

FormEntry momentum_stabilised_entry() {
  return {.name = "momentum-stabilised",
          .kind = FormEntry::Kind::dae,
          .impulses = true,
          .positions = true,
          .lower_on_rates = true,
          .colour = 2,
          .place = 2,
          .words = {.x = "p",
                    .s = "σ",
                    .constraints = {{Constraint::Origin::given, 0, 1, 0, "M v + Φ_qᵀσ = p", "v"},
                                    given(equation::velocities, "σ"),
                                    given(equation::positions),
                                    hidden(1, equation::of_stabilised, "μ")}},
          .make = made<MomentumStabilised>};
}

}  // namespace momenta
