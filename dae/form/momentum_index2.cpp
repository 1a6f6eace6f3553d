// momentum-index2
//
// Unknowns      q, p; σ
// Equations     M u + Φ_qᵀσ = p with u the rates of q̇ (first row of 7), (8), Φ(q, t) = 0
// Index         2: Φ = 0 once differentiated gives σ. It is σ that lowers the index: (5a)-(5c) with
// λ has index 3. Hidden        Φ_q u + Φ_t = 0 Multipliers   σ, an impulse; λ = σ̇ + κ σ. Its noise,
// rounding over step, enters ṗ through κ: keep κ near 1/T. Drifts        Φ at the Newton tolerance;
// Φ̇ at rounding once u is recomputed from (7) Source        paper, eqs. (6)-(8), with the
// constraint at position level

#include <momenta/dae/form/dae_form.h>

namespace momenta {
namespace {

class MomentumIndex2 final : public DaeFormOf<MomentumIndex2> {
 public:
  MomentumIndex2(const Mechanism& mechanism, const FormOptions& options, const Start& start)
      : DaeFormOf("momentum-index2", mechanism, {mechanism.nq(), mechanism.nv(), mechanism.m()},
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
    s.e->positions(r);
  }
};

}  // namespace

std::unique_ptr<Form> make_momentum_index2(const Mechanism& mechanism, const FormOptions& o,
                                           const Start& s) {
  return std::make_unique<MomentumIndex2>(mechanism, o, s);
}

}  // namespace momenta
