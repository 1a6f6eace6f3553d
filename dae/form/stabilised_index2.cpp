// stabilised-index2
//
// Unknowns      q, v; λ, μ
// Equations     q̇ = v − Φ_qᵀμ,  (1a) at v,  Φ_q v + Φ_t = 0,  Φ = 0
// Index         2
// Hidden        Φ̈ = 0
// Multipliers   λ, a force; μ, the position correction per unit time, zero in exact arithmetic
// Drifts        nothing: Φ and Φ̇ at the Newton tolerance
// Source        Gear, Gupta, Leimkuhler, J. Comput. Appl. Math. 12 (1985)

#include <momenta/dae/form/dae_form.h>

namespace momenta {
namespace {

class StabilisedIndex2 final : public DaeFormOf<StabilisedIndex2> {
 public:
  StabilisedIndex2(const Mechanism& mechanism, const FormOptions& options, const Start& start)
      : DaeFormOf("stabilised-index2", mechanism,
                  {mechanism.nq(), mechanism.nv(), mechanism.m(), false, true, 1}, options, start,
                  Unknowns::velocities) {}

  template <class S>
  void rows(DaeScratch<S>& s, double t, const S* y, const S* ydot, S* r) {
    r = acceleration_rows(s, t, y, ydot, r);
    both_levels(s, y, r);
  }
};

}  // namespace

std::unique_ptr<Form> make_stabilised_index2(const Mechanism& mechanism, const FormOptions& o,
                                             const Start& s) {
  return std::make_unique<StabilisedIndex2>(mechanism, o, s);
}

}  // namespace momenta
