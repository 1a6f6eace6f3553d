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
                  options, start, Unknowns::impulses) {}

  template <class S>
  void rows(DaeScratch<S>& s, double t, const S* y, const S* ydot, S* r) {
    s.e->positions(momentum_rows(s, t, y, ydot, r));
  }
};

}  // namespace

std::unique_ptr<Form> make_momentum_index2(const Mechanism& mechanism, const FormOptions& o,
                                           const Start& s) {
  return std::make_unique<MomentumIndex2>(mechanism, o, s);
}

}  // namespace momenta
