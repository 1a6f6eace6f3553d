#pragma once
// Loop equations and rates that are kept as independent, by Φ_q at a pose in the units of
// kkt/loop_units.h.
//
//   rows     a basis R of those of positions, R_p, completed by nonholonomic ones; the last of the
//            scene are left out where there is a choice
//   rates    D_p: as many as R_p, pivots of a QR decomposition, or the complement of those named;
//            D: D_p completed to as many as R on what D_p leaves of the nonholonomic rows
//
// A drive of a loop can be varied alone where the loops follow, νᵀΦ_f = 0 with Φ_f of loop_drives.h
// and ν the forces that move nothing. Others stay functions of time.
//
// The block Φ_q of R and D is regular, and so is that of R_p and D_p.

#include <momenta/dae/analysis/linear/operating_point.h>

#include <string>
#include <vector>

namespace momenta {

struct IndependentCoordinates {
  std::vector<int> rows, position_rows;  ///< R, R_p: the first of R
  std::vector<int> left_out;             ///< dependent rows
  std::vector<int> dependent;            ///< D, D_p first, as places in u
  std::vector<int> free_rates;           ///< I of rates
  std::vector<int> free_positions;       ///< I of positions
  std::vector<bool> unique;              ///< by row: λ is unique
  std::vector<int> loop_drives;          ///< places of drives of loops that can be varied
  double kept = 0;                       ///< relative, least singular value that counts
};

/// `named`: places in u for free_positions; empty: chosen. `pivot`: as in an Equilibrium.
/// @throws SceneError where loops cannot follow drives, or the named coordinates do not determine
/// the pose. O((nv + m)³)
IndependentCoordinates independent_coordinates(const OperatingPoint& at,
                                               const std::vector<int>& named, double pivot = 0);

/// @throws SceneError where Φ_q has less rank than nearby. O((nv + m)³)
void expect_regular(const Mechanism& mechanism, const Start& at);

}  // namespace momenta
