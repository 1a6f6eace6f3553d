#pragma once
// The right-hand side of (7), (3) or a projection, apart from its joint-space part.

namespace momenta {

/// Options of one solution by the sweeps. By default drives move the bodies, and nothing else is
/// added.
template <class S>
struct RightSide {
  const S* centre = nullptr;  ///< σ (m) towards which weak rows fade; null: zero
  double fade = 0;            ///< pivots below this, relative to their scale, fade
  bool drives = true;         ///< prescribed motion moves bodies (not in a correction of positions)
  double positions = 0;       ///< β of the second row Φ_q u = −Φ_t − βΦ [1/s]
  bool rates = false;         ///< compute ṗ too
  double leak = 0;            ///< κ [1/s]
  bool body_forces = false;   ///< add springs and wrenches at points of bodies: planar sweeps only
  double alpha = 0;           ///< α of Φ̈ + 2α Φ̇ + β² Φ = 0 [1/s]
  double beta = 0;            ///< β of it [1/s]
  const S* compliance = nullptr;  ///< c (m) of the second row … + c (σ − centre); null: zero

  /// The same options for another scalar, with these centre and compliance.
  template <class T>
  RightSide<T> of_rows(const T* its_centre, const T* its_compliance) const {
    return {its_centre, fade,        drives, positions, rates,
            leak,       body_forces, alpha,  beta,      its_compliance};
  }
};

}  // namespace momenta
