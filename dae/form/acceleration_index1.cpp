// acceleration-index1
//
// Unknowns      q, v; λ
// Equations     q̇ = v,  (1a): M v̇ + Φ_qᵀλ = Q + L_q − Ṁ v,  Φ̈ = 0
// Index         1
// Hidden        Φ = 0 and Φ̇ = 0
// Multipliers   λ, a force
// Drifts        Φ̇ like t, Φ like t²
// Source        paper, eqs. (1)-(3); Brenan, Campbell, Petzold, Numerical Solution of
//               Initial-Value Problems in DAEs

#include <momenta/dae/form/dae_form.h>

namespace momenta {
namespace {

class AccelerationIndex1 final : public DaeFormOf<AccelerationIndex1> {
 public:
  AccelerationIndex1(const Mechanism& mechanism, const FormOptions& options, const Start& start)
      : DaeFormOf("acceleration-index1", mechanism, {mechanism.nq(), mechanism.nv(), mechanism.m()},
                  options, start, Unknowns::velocities) {}

  template <class S>
  void rows(DaeScratch<S>& s, double t, const S* y, const S* ydot, S* r) {
    s.e->accelerations(acceleration_rows(s, t, y, ydot, r));
  }
};

}  // namespace

std::unique_ptr<Form> make_acceleration_index1(const Mechanism& mechanism, const FormOptions& o,
                                               const Start& s) {
  return std::make_unique<AccelerationIndex1>(mechanism, o, s);
}

}  // namespace momenta
