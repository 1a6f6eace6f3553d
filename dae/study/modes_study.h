#pragma once
// An equilibrium of a mechanism, the small motions about it, and pictures of them.

#include <momenta/dae/analysis/linear/spectrum.h>
#include <momenta/dae/analysis/linear/steady_motion.h>
#include <momenta/dae/run/picture.h>

#include <optional>

namespace momenta {

struct ModesRequest {
  Search search = Search::settle;
  int count = 0;  ///< modes; 0: all of up to 300 degrees of freedom, else 20
  Route route = Route::automatic;
};

struct ModesResult {
  bool of_formulas = false;  ///< a Lagrangian: coordinates instead of joints
  std::string scene;
  Equilibrium equilibrium;
  /// Set with Search::steady; `equilibrium` then has t, q and λ alone.
  std::optional<SteadyMotion> steady;
  Spectrum spectrum;
  std::vector<Column> coordinates;  ///< columns of q
  std::vector<Column> shapes;  ///< columns of φ: as q, but displacements and turns in child axes of
                               ///< free and spherical joints: .dx .dy .dz [m], .rx .ry .rz
  bool drives_run = false;
  /// Rank of Φ_q at nearby poses: above the rank here the pose is singular; 0: not found.
  int rank_nearby = 0;
  int growing() const;  ///< modes with Re s > 0
  int rigid() const;    ///< modes with s = 0
  bool singular_here() const { return rank_nearby > spectrum.rank; }
  /// "stable", "unstable", "neutral" (some modes rigid, none growing) or "fixed" (no mode).
  const char* nature() const;
};

/// Drives move as they do at t = 0, at constant speed: `held_at_start` scenes have them at rest.
/// From a saddle `settle` goes on, moved a little along the growing mode.
/// @throws SceneError without an equilibrium, or without constant coefficients of small motions
ModesResult find_modes(const Mechanism& mechanism, const Start& start, const ModesRequest& request);

/// 33 poses on Φ = 0 along a mode, at the time of the equilibrium: for a real mode δ from −A φ to A
/// φ, else one period. A turns bodies by up to 0.35 rad and carries them by up to 0.15 of the
/// mechanism's extent, less where the loops do not allow it.
Film swing(const Mechanism& mechanism, const ModesResult& result, const Mode& mode);

}  // namespace momenta
