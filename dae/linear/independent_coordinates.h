#pragma once
// Which loop equations and which rates are kept as independent, of Φ_q at a pose in the units of
// kkt/loop_units.h.
//
//   rows     a basis R of those of positions, R_p, completed by nonholonomic ones; the last of the
//            scene are left out where there is a choice
//   rates    D_p: as many as R_p, pivots of a QR decomposition, or the complement of those named;
//            D: D_p completed to as many as R on what D_p leaves of the nonholonomic rows
//
// A drive of a loop can be varied by itself where the loops follow, νᵀΦ_f = 0 with Φ_f of
// loop_drives.h and ν the forces that move nothing. Others stay functions of time.
//
// The block Φ_q of R and D is regular, and so is that of R_p and D_p.

#include <momenta/dae/linear/operating_point.h>

#include <string>
#include <vector>

namespace momenta {

struct IndependentCoordinates {
  std::vector<int> rows, position_rows;  ///< R, R_p: the first of R
  std::vector<int> left_out;             ///< rows that follow from others
  std::vector<int> dependent;            ///< D, D_p first, as places in u
  std::vector<int> free_rates;           ///< I of rates
  std::vector<int> free_positions;       ///< I of positions
  std::vector<bool> unique;              ///< by row, whether λ is
  std::vector<int> loop_drives;          ///< drives of loops that can be varied, in the scene
  double kept = 0;                       ///< smallest singular value that counts over the largest
};

/// `named`: places in u for free_positions; empty: chosen. `pivot`: as of an Equilibrium.
/// @throws SceneError where drives ask what the loops cannot follow, or the named ones do not
/// determine the pose. O((nv + m)³)
IndependentCoordinates independent_coordinates(const OperatingPoint& at,
                                               const std::vector<int>& named, double pivot = 0);

/// Refuses a pose at which Φ_q has less rank than nearby. @throws SceneError. O((nv + m)³)
void expect_regular(const Mechanism& mechanism, const Start& at);

}  // namespace momenta
