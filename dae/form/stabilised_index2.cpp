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
#include <momenta/dae/form/form_entry.h>

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

FormEntry stabilised_index2_entry() {
  return {.name = "stabilised-index2",
          .kind = FormEntry::Kind::dae,
          .positions = true,
          .bearings = true,
          .colour = 3,
          .place = 3,
          .words = {.x = "v",
                    .s = "λ",
                    .constraints = {given(equation::velocities), given(equation::positions),
                                    hidden(1, equation::of_stabilised, "μ"),
                                    hidden(1, equation::accelerations, "λ")}},
          .make = made<StabilisedIndex2>};
}

}  // namespace momenta
