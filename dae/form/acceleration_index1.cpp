// acceleration-index1
//
// Unknowns      q, v; λ
// Equations     q̇ = v,  (1a): M v̇ + Φ_qᵀλ = Q + L_q − Ṁ v,  Φ̈ = 0
// Index         1
// Hidden        Φ = 0 and Φ̇ = 0
// Multipliers   λ, a force
// Feedback      none; Φ̈ = −2α Φ̇ − β² Φ where these are the equations that `baumgarte` solves
// Drifts        Φ̇ like t, Φ like t²
// Source        paper, eqs. (1)-(3); Brenan, Campbell, Petzold, Numerical Solution of
//               Initial-Value Problems in DAEs

#include <momenta/dae/form/acceleration_form.h>
#include <momenta/dae/form/dae_form.h>
#include <momenta/dae/form/form_entry.h>

namespace momenta {
namespace {

class AccelerationIndex1 final : public DaeFormOf<AccelerationIndex1> {
 public:
  AccelerationIndex1(Feedback feedback, const Mechanism& mechanism, const FormOptions& options,
                     const Start& start)
      : DaeFormOf("acceleration-index1", mechanism, {mechanism.nq(), mechanism.nv(), mechanism.m()},
                  options, start, Unknowns::velocities),
        feedback_(feedback) {}

  template <class S>
  void rows(DaeScratch<S>& s, double t, const S* y, const S* ydot, S* r) {
    r = acceleration_rows(s, t, y, ydot, r);
    s.e->accelerations(r);
    if (feedback_.alpha == 0 && feedback_.beta == 0) return;
    const double rate = 2 * feedback_.alpha, position = feedback_.beta * feedback_.beta;
    s.e->velocities(s.a.data());
    for (int i = 0; i < layout_.m; ++i) r[i] += rate * s.a[static_cast<std::size_t>(i)];
    s.e->positions(s.a.data());
    for (int i = 0; i < layout_.m; ++i) r[i] += position * s.a[static_cast<std::size_t>(i)];
  }

 private:
  Feedback feedback_;
};

}  // namespace

FormEntry acceleration_index1_entry() {
  return {
      .name = "acceleration-index1",
      .kind = FormEntry::Kind::dae,
      .bearings = true,
      .colour = 1,
      .place = 9,
      .words = {.x = "v",
                .s = "λ",
                .constraints = {given(equation::accelerations, "λ"),
                                invariant(equation::velocities), invariant(equation::positions)}},
      .make = [](const Mechanism& mechanism, const FormOptions& options, const Start& start) {
        return make_acceleration_index1_with({}, mechanism, options, start);
      }};
}

std::unique_ptr<Form> make_acceleration_index1_with(Feedback feedback, const Mechanism& mechanism,
                                                    const FormOptions& o, const Start& s) {
  return std::make_unique<AccelerationIndex1>(feedback, mechanism, o, s);
}

}  // namespace momenta
