// stabilised-index2
//
// Unknowns      q, v; λ, μ
// Equations     q̇ = v − Φ_qᵀμ,  (1a) at v,  Φ_q v + Φ_t = 0,  Φ = 0
// Index         2
// Hidden        Φ̈ = 0
// Multipliers   λ, a force; μ, the position correction per time, zero in exact arithmetic
// Drifts        nothing: Φ and Φ̇ at the Newton tolerance
// Source        Gear, Gupta, Leimkuhler, J. Comput. Appl. Math. 12 (1985)

#include <momenta/dae/form/dae_form.h>

namespace momenta {
namespace {

class StabilisedIndex2 final : public DaeFormOf<StabilisedIndex2> {
 public:
  StabilisedIndex2(const Mechanism& mechanism, const FormOptions& options, const Start& start)
      : DaeFormOf("stabilised-index2", mechanism,
                  {mechanism.nq(), mechanism.nv(), mechanism.m(), false, true}, options, start,
                  false) {}

  template <class S>
  void rows(DaeScratch<S>& s, double t, const S* y, const S* ydot, S* r) {
    const S *q = y, *v = y + layout_.v(), *lambda = y + layout_.s(), *mu = y + layout_.mu();
    const S* vdot = ydot + layout_.v();
    s.e->place(t, q);
    s.e->constraint_forces(mu, s.a.data());
    s.e->joint_rates(q, ydot, s.u.data());
    for (int i = 0; i < layout_.nv; ++i) {
      const auto at = static_cast<std::size_t>(i);
      *r++ = s.u[at] - v[i] + s.a[at];
    }
    r = quaternion_rows(q, ydot, r);
    s.e->move(v);
    s.e->joint_forces(q, v, vdot, lambda, r);
    s.e->velocities(r + layout_.nv);
    s.e->positions(r + layout_.nv + layout_.m);
  }
};

}  // namespace

std::unique_ptr<Form> make_stabilised_index2(const Mechanism& mechanism, const FormOptions& o,
                                             const Start& s) {
  return std::make_unique<StabilisedIndex2>(mechanism, o, s);
}

}  // namespace momenta
