// acceleration-index2
//
// Unknowns      q, v; λ
// Equations     q̇ = v,  (1a): M v̇ + Φ_qᵀλ = Q + L_q − Ṁ v,  Φ̇ = Φ_q v + Φ_t = 0
// Index         2
// Hidden        Φ = 0 and Φ̈ = 0
// Multipliers   λ, a force
// Drifts        Φ like t; Φ̇ at the Newton tolerance
// Source        paper, eqs. (1)-(3); Brenan, Campbell, Petzold, Numerical Solution of
//               Initial-Value Problems in DAEs

#include <momenta/dae/form/dae_form.h>
#include <momenta/dae/form/form_entry.h>
#include <momenta/dae/form/half_explicit_parts.h>
#include <momenta/dae/kkt/unheld_joints.h>

namespace momenta {
namespace {

class AccelerationIndex2 final : public DaeFormOf<AccelerationIndex2>, public HalfExplicitParts {
 public:
  AccelerationIndex2(const Mechanism& mechanism, const FormOptions& options, const Start& start)
      : DaeFormOf("acceleration-index2", mechanism,
                  {mechanism.nq(), mechanism.nv(), mechanism.m(), false, false, 1}, options, start,
                  Unknowns::velocities),
        HalfExplicitParts(mechanism) {}

  template <class S>
  void rows(DaeScratch<S>& s, double t, const S* y, const S* ydot, S* r) {
    s.e->velocities(acceleration_rows(s, t, y, ydot, r));
  }

  /// Φ̈ = 0: (3).
  bool consistent(double t, const double* y, double* z, double* f) override {
    Work& w = work();
    const double *q = y, *v = y + layout_.x();
    double* vdot = f + layout_.x();
    if (!add_bearing_friction(t, q, v)) return false;
    if (!w.solver) {
      if (!w.e->open_accelerations(t, q, v, vdot))
        return failed(no_inertia(mechanism_, w.e->singular_joint(), t, q));
    } else if (!w.solver->acceleration(t, q, v, centre(z), 0, 0, vdot, z)) {
      return failed("the solution of (3) is not finite");
    }
    w.e->coordinate_rates(q, v, f);
    return true;
  }

  bool meet(double t, double* y) override { return meet_velocities(t, y, y + layout_.x()); }

  /// q at the next stage does not depend on λ, and v does linearly:
  ///   M v̇ + Φ_qᵀλ = Q + L_q − Ṁ v,  Φ_q(q̄) v̇ = −(Φ_q(q̄) v_base + Φ_t)/w.
  bool advance(double t, const double* y, double t_next, const double* base, double w,
               bool /*exact: always*/, double* z, double* f) override {
    Work& work = this->work();
    auto &e = *work.e, &ahead = *work.ahead;
    const double *q = y, *v = y + layout_.x();
    double* vdot = f + layout_.x();
    if (layout_.m == 0) return consistent(t, y, z, f);
    if (!add_bearing_friction(t, q, v)) return false;
    e.place(t, q);
    work.kkt.act_at(e);
    e.move(v);
    e.joint_forces(q, v, nullptr, nullptr, work.r.data());
    for (std::size_t i = 0; i < work.r.size(); ++i)
      work.r[i] = (work.friction ? work.friction->forces()[i] : 0) - work.r[i];
    e.coordinate_rates(q, v, f);
    for (int i = 0; i < layout_.nq; ++i)
      work.there[static_cast<std::size_t>(i)] = base[i] + w * f[i];
    ahead.place(t_next, work.there.data());
    work.kkt.meet_at(ahead);
    ahead.move(base + layout_.x());
    ahead.velocities(work.g.data());
    for (double& g : work.g) g /= -w;
    work.kkt.add_compliance(-1, z, work.g.data());
    if (!work.kkt.factor()) return failed("the matrix of a half-explicit stage is singular");
    work.kkt.solve(work.r.data(), work.g.data(), vdot, z);
    return true;
  }

 protected:
  const std::vector<double>& newton_regularisation() const override { return regularisation(); }
};

}  // namespace

FormEntry acceleration_index2_entry() {
  return {.name = "acceleration-index2",
          .kind = FormEntry::Kind::dae,
          .bearings = true,
          .colour = 5,
          .place = 13,
          .words = {.x = "v",
                    .s = "λ",
                    .constraints = {given(equation::velocities),
                                    hidden(1, equation::accelerations, "λ"),
                                    invariant(equation::positions)}},
          .make = made<AccelerationIndex2>};
}

}  // namespace momenta
