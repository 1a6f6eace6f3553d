#pragma once
// The rank of the loop equations at a start.

#include <momenta/dae/kkt/loop_rank.h>
#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/topology/assembly/assembly.h>

namespace momenta {

/// Rank of Φ_q at (t, q) of the start, without singular values. O(m² nv).
inline LoopRank rank_at(const Mechanism& mechanism, const Start& start) {
  const auto e = mechanism.evaluation<double>();
  e->place(start.t, start.q.data());
  return loop_rank(mechanism, *e, Judged::dependence);
}

}  // namespace momenta
