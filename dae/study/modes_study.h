#pragma once
// An equilibrium of a mechanism, the small motions about it, and pictures of them.

#include <momenta/dae/linear/spectrum.h>
#include <momenta/dae/linear/steady_motion.h>
#include <momenta/dae/study/picture.h>

#include <optional>

namespace momenta {

struct ModesRequest {
  Search search = Search::settle;
  int count = 0;  ///< modes; 0: all of up to 300 degrees of freedom, else 20
  Route route = Route::automatic;
};

struct ModesResult {
  bool of_formulas = false;  ///< of a Lagrangian: coordinates instead of joints
  std::string scene;
  Equilibrium equilibrium;
  /// With Search::steady: then `equilibrium` has its q and λ alone.
  std::optional<SteadyMotion> steady;
  Spectrum spectrum;
  std::vector<Column> coordinates;  ///< of q
  std::vector<Column> shapes;       ///< of φ: as q, but displacements and turns in child axes of
                                    ///< free and spherical joints: .dx .dy .dz [m], .rx .ry .rz
  bool drives_run = false;
  int rank_nearby = 0;  ///< of Φ_q at poses nearby, where asked: above the rank here the pose is
                        ///< singular; 0: not asked
  int growing() const;  ///< modes with Re s > 0
  int rigid() const;    ///< modes with s = 0
  bool singular_here() const { return rank_nearby > spectrum.rank; }
  /// "stable", "unstable", "neutral" (some modes rigid, none growing) or "fixed" (no mode).
  const char* nature() const;
};

/// Drives move as they do at t = 0, at constant speed: `held_at_start` scenes have them at rest.
/// From a saddle that `settle` came to it goes on, a little turned along the growing mode.
/// @throws SceneError where there is no equilibrium, or no small motions about it with constant
/// coefficients
ModesResult find_modes(const Mechanism& mechanism, const Start& start, const ModesRequest& request);

/// Poses on Φ = 0 along a mode, 33, all at the time of the equilibrium: of a real one δ from −A φ
/// to A φ, of another one period of it. A turns bodies by up to 0.35 rad and carries them by up to
/// 0.15 of the mechanism's extent, less where the loops do not allow it.
Film swing(const Mechanism& mechanism, const ModesResult& result, const Mode& mode);

}  // namespace momenta
