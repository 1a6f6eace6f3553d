// momentum-index2
//
// Unknowns      q, p; σ
// Equations     M u + Φ_qᵀσ = p with u the rates of q̇ (first row of 7), (8), Φ(q, t) = 0
// Index         2: Φ = 0, differentiated once, gives σ. With λ in place of σ, as in (5a)-(5c), the
//               index is 3
// Hidden        Φ_q u + Φ_t = 0
// Multipliers   σ, an impulse; λ = σ̇ + κ σ. The noise of σ, rounding over step, enters ṗ through κ:
//               keep κ near 1/T
// Drifts        Φ at the Newton tolerance; Φ̇ at rounding once u is recomputed from (7)
// Source        paper, eqs. (6)-(8), with the constraint at position level

#include <momenta/dae/form/dae_form.h>
#include <momenta/dae/form/form_entry.h>
#include <momenta/dae/form/half_explicit_parts.h>
#include <momenta/dae/form/impulse_gauge.h>
#include <momenta/dae/kkt/unheld_joints.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace momenta {
namespace {

class MomentumIndex2 final : public DaeFormOf<MomentumIndex2>,
                             public HalfExplicitParts,
                             public ImpulseGauge {
 public:
  MomentumIndex2(const Mechanism& mechanism, const FormOptions& options, const Start& start)
      : DaeFormOf("momentum-index2", mechanism,
                  {mechanism.nq(), mechanism.nv(), mechanism.m(), false, false, 1}, options, start,
                  Unknowns::impulses),
        HalfExplicitParts(mechanism),
        ImpulseGauge(mechanism, layout_, gauge(), sizes_) {}

  template <class S>
  void rows(DaeScratch<S>& s, double t, const S* y, const S* ydot, S* r) {
    position_rows(s, momentum_rows(s, t, y, ydot, r));
  }

  /// Φ̇ = 0: (7), and (8).
  bool consistent(double t, const double* y, double* z, double* f) override {
    Work& w = work();
    const double *q = y, *p = y + layout_.x();
    double* pdot = f + layout_.x();
    if (!w.solver) {
      if (!w.e->open_momentum_rates(t, q, p, w.u.data(), pdot))
        return failed(no_inertia(mechanism_, w.e->singular_joint(), t, q));
    } else if (!w.solver->momentum(t, q, p, centre(z), fade_evaluation, leak(), w.u.data(), z,
                                   pdot)) {
      return failed("the solution of (7) is not finite");
    }
    w.e->coordinate_rates(q, w.u.data(), f);
    return true;
  }

  bool meet(double t, double* y) override { return meet_positions(t, y, sizes_); }

  /// Newton's method for u and σ in
  ///   M u + Φ_qᵀσ = p,  Φ(q̄) = 0,  q̄ = q_base + w q̇(u),
  /// from the u predicted, with the Φ_q(q̄) of its first q̄: row 1 holds at every iteration. A u off
  /// by O(h^r) has q̄ off by O(h^(r+1)); the first solution leaves Φ = O(h^(2r+2)) and, by w, u and
  /// σ off by O(h^(2r+1)). Where q̇ ≠ u, q̇ is that at q and not at q̄, and each solution gains one
  /// power: three of them. To rounding, the number is that which the rate of the last two foresees;
  /// so it is for redundant loops, whose rows contradict each other at a q̄ off the manifold.
  bool advance(double t, const double* y, double t_next, const double* base, double w, bool exact,
               double* z, double* f) override {
    Work& work = this->work();
    auto &e = *work.e, &ahead = *work.ahead;
    const double *q = y, *p = y + layout_.x();
    if (layout_.m == 0) return consistent(t, y, z, f);
    exact = exact || !regularisation().empty();
    const int enough = exact ? most_solutions : mechanism_.plan().quasi_velocities ? 3 : 1;
    e.place(t, q);
    work.kkt.act_at(e);
    std::copy_n(p, work.r.size(), work.r.data());
    if (mechanism_.plan().drives || mechanism_.scene().lagrangian) {  // subtracts p at rest
      e.move(nullptr);
      e.momenta(nullptr, work.delta.data());
      for (std::size_t i = 0; i < work.r.size(); ++i) work.r[i] -= work.delta[i];
    }
    e.joint_rates(q, f, work.u.data());
    double last = std::numeric_limits<double>::infinity();
    for (int count = 1;; ++count) {
      e.coordinate_rates(q, work.u.data(), f);
      double size = 1;
      for (std::size_t i = 0; i < work.there.size(); ++i) {
        work.there[i] = base[i] + w * f[i];
        size = std::max(size, std::abs(work.there[i]) / sizes_.q[i]);
      }
      ahead.place(t_next, work.there.data());
      ahead.positions(work.g.data());
      for (double& g : work.g) g /= -w;
      if (count == 1) {
        centre(z);
        work.kkt.add_compliance(-1, z, work.g.data());
        work.kkt.meet_at(ahead);
        if (!work.kkt.factor()) return failed("the matrix of a half-explicit stage is singular");
        work.kkt.rates(work.u.data(), work.correction.data());
        for (std::size_t i = 0; i < work.g.size(); ++i) work.g[i] += work.correction[i];
        work.kkt.solve(work.r.data(), work.g.data(), work.delta.data(), z);
        for (std::size_t i = 0; i < work.u.size(); ++i)
          std::swap(work.u[i], work.delta[i]), work.delta[i] = work.u[i] - work.delta[i];
      } else {
        work.kkt.add_compliance(1, z, work.g.data());
        work.kkt.add_compliance(-1, work.centre.data(), work.g.data());
        work.kkt.solve(nullptr, work.g.data(), work.delta.data(), work.correction.data());
        for (std::size_t i = 0; i < work.u.size(); ++i) work.u[i] += work.delta[i];
        for (int i = 0; i < layout_.m; ++i) z[i] += work.correction[static_cast<std::size_t>(i)];
      }
      double change = 0;
      for (std::size_t i = 0; i < work.delta.size(); ++i)
        change = std::max(change, std::abs(w * work.delta[i]) / (sizes_.way[i] * size));
      if (!std::isfinite(change)) return failed("a value that is not a finite number came up");
      if (!exact && count == enough) break;
      // Rounding; below its square root a correction that shrinks no more is rounding too.
      const bool next_is_rounding =
          count > 1 && change < last && 100 * change * change <= reached * last;
      if (change <= reached || next_is_rounding || (change <= small && change >= 0.5 * last)) break;
      if (count == enough || (count > 2 && change > last))
        return failed("the impulses of a half-explicit stage did not converge");
      last = change;
    }
    e.coordinate_rates(q, work.u.data(), f);
    e.move(work.u.data());
    e.momenta(z, work.r.data());
    e.momentum_rates(q, work.u.data(), z, leak(), f + layout_.x());
    return true;
  }

 protected:
  const std::vector<double>& newton_regularisation() const override { return regularisation(); }

 private:
  static constexpr double reached = 4 * std::numeric_limits<double>::epsilon(), small = 1e-12;
  static constexpr int most_solutions = 21;
};

}  // namespace

FormEntry momentum_index2_entry() {
  return {
      .name = "momentum-index2",
      .kind = FormEntry::Kind::dae,
      .impulses = true,
      .positions = true,
      .lower_on_rates = true,
      .colour = 6,
      .place = 6,
      .words = {.x = "p",
                .s = "σ",
                .constraints = {given(equation::positions), hidden(1, equation::of_momenta, "σ")}},
      .make = made<MomentumIndex2>};
}

}  // namespace momenta
