#pragma once
// Couplers in the sweeps: the joints a row ties, its right-hand side, and its leak.

#include <momenta/dae/kkt/sweeps/slots/loop_plan.h>
#include <momenta/dae/kkt/sweeps/slots/right_side.h>
#include <momenta/dae/mechanism/loop/loop_model.h>

namespace momenta {

/// Calls act(coupling, loop, slot) for the couplers that tie the joint of body k.
template <class Act>
void each_coupling(const LoopPlan& plan, std::size_t k, Act&& act) {
  const LoopPlan::Range range = plan.couplings_of[k];
  for (int i = range.first; i < range.last; ++i) {
    const LoopPlan::Coupling& coupling = plan.couplings[static_cast<std::size_t>(i)];
    const auto loop = static_cast<std::size_t>(coupling.loop);
    act(coupling, loop, plan.slot[loop]);
  }
}

/// d of Φ = Σ r q − c: −ċ and what is asked of Φ; in the acceleration form −c̈ +
/// 2α Φ̇ + β² Φ, with x = u.
template <bool Momentum, class Space, class S, class In>
S coupler_bias(const LoopModel<Space>& loops, const typename LoopModel<Space>::Loop& l, const In& q,
               const In& x, const RightSide<S>& right) {
  double rate = 0, second = 0;
  if (l.motion >= 0) {
    const auto& m = loops.motions[static_cast<std::size_t>(l.motion)];
    rate = m.given_rate;
    second = m.given_second;
  }
  S phi(0.0);
  if (right.positions != 0 || right.beta != 0) {
    phi = S(-l.given);
    for (const auto& c : l.joints) phi = phi + c.ratio * S(q[c.q]);
  }
  if constexpr (Momentum) {
    const S given = right.positions * phi;
    return right.drives ? given - S(rate) : given;
  } else {
    S moving(-rate);
    for (const auto& c : l.joints) moving = moving + c.ratio * S(x[c.u]);
    return (2 * right.alpha) * moving + (right.beta * right.beta) * phi - S(second);
  }
}

/// ṗ −= κ r σ
template <class S, class Space, class In, class Out>
void leak_of_couplers(const LoopModel<Space>& loops, double leak, const In& impulse, Out& rate) {
  for (const auto& l : loops.loops)
    for (const auto& c : l.joints) rate[c.u] = S(rate[c.u]) - (leak * c.ratio) * S(impulse[l.row]);
}

}  // namespace momenta
