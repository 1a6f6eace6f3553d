#pragma once
// What a solution of (7), (3) or a projection asks for beside its joint-space right-hand side.

namespace momenta {

/// Options of one solution by the sweeps; as made: drives move, nothing else is asked for.
template <class S>
struct RightSide {
  const S* centre = nullptr;  ///< σ (m) towards which weak rows fade; null: zero
  double fade = 0;            ///< pivots below this, relative to their scale, fade
  bool drives = true;         ///< prescribed motion moves bodies (not in a correction of positions)
  double positions = 0;       ///< second row Φ_q u = −Φ_t − this · Φ [1/s]
  bool rates = false;         ///< ṗ too
  double leak = 0;            ///< κ [1/s]
  bool body_forces = false;   ///< springs and wrenches at points of bodies too: sweeps in a plane
  double alpha = 0;           ///< α of Φ̈ + 2α Φ̇ + β² Φ = 0 [1/s]
  double beta = 0;            ///< β of it [1/s]
  const S* compliance = nullptr;  ///< second row … + (σ − centre) · this (m); null: zero

  /// The same for another scalar, with these rows.
  template <class T>
  RightSide<T> of_rows(const T* its_centre, const T* its_compliance) const {
    return {its_centre, fade,        drives, positions, rates,
            leak,       body_forces, alpha,  beta,      its_compliance};
  }
};

}  // namespace momenta
