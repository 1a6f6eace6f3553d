// momentum-index1
//
// Unknowns      q, p; σ
// Equations     M u + Φ_qᵀσ = p with u the rates of q̇ (7), ṗ = L_q + Q + Φ̇_qᵀσ − κ Φ_qᵀσ (8), Φ̇ = 0
// Index         1: differentiating nothing, σ and q̇ follow from (7) at once
// Hidden        Φ(q, t) = 0
// Multipliers   σ, an impulse; λ = σ̇ + κ σ
// Drifts        Φ like t; Φ̇ at rounding
// Source        paper, eqs. (6)-(8)

#include <momenta/dae/form/dae_form.h>

namespace momenta {
namespace {

class MomentumIndex1 final : public DaeFormOf<MomentumIndex1> {
 public:
  MomentumIndex1(const Mechanism& mechanism, const FormOptions& options, const Start& start)
      : DaeFormOf("momentum-index1", mechanism, {mechanism.nq(), mechanism.nv(), mechanism.m()},
                  options, start, true) {}

  template <class S>
  void rows(DaeScratch<S>& s, double t, const S* y, const S* ydot, S* r) {
    const S *q = y, *p = y + layout_.x(), *sigma = y + layout_.s(), *pdot = ydot + layout_.x();
    s.e->place(t, q);
    s.e->joint_rates(q, ydot, s.u.data());
    s.e->move(s.u.data());
    s.e->momenta(sigma, r);
    for (int i = 0; i < layout_.nv; ++i) *r++ -= p[i];
    r = quaternion_rows(q, ydot, r);
    s.e->momentum_rates(q, s.u.data(), sigma, leak(), s.b.data());
    for (int i = 0; i < layout_.nv; ++i) *r++ = pdot[i] - s.b[static_cast<std::size_t>(i)];
    s.e->velocities(r);
  }
};

}  // namespace

std::unique_ptr<Form> make_momentum_index1(const Mechanism& mechanism, const FormOptions& o,
                                           const Start& s) {
  return std::make_unique<MomentumIndex1>(mechanism, o, s);
}

}  // namespace momenta
