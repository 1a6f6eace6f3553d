#pragma once
// The mechanism that runs integrate in place of the one written: the same without bodies that have
// no coordinate of their own (fold_welds.h, fold_rotors.h), and with joints cut where that is less
// work (recut.h). Reports are of the scene as written (original_scene_motion.h).
//
// An evaluation by sweeps costs about c₀ a body and c₁ for each of the squared numbers of equations
// that are open at it, J in all (cycles.h), with c₀ / c₁ about 8 in the plane and 30 in space.
// Cuts of recut() are taken that are a tenth cheaper, or with which the sweeps carry loops that
// they cannot carry as written, or the tree becomes so much shallower at next to the same work that
// rounding adds up less.

#include <momenta/dae/topology/cut/folded_scene.h>
#include <momenta/dae/topology/cut/recut.h>

#include <memory>
#include <string>

namespace momenta {

/// The mechanism that a run integrates, and how it differs from the one written.
class IntegratedScene {
 public:
  /// Folds and chooses the cuts, unless the mechanism's options keep those of the scene or ask for
  /// an assembled matrix. `written` and `start` must outlive it. `known`: recut() of these, or
  /// null. Cost: recut(); an assembly for each step taken.
  IntegratedScene(const Mechanism& written, const Start& start, const Recut* known = nullptr);

  /// The integrated mechanism; it lives as long as this object, or is the one written.
  const Mechanism& mechanism() const { return mechanism_ ? *mechanism_ : written_; }
  /// The integrated mechanism's start.
  const Start& start() const { return mechanism_ ? start_ : written_start_; }
  /// Whether the scene differs from the one written.
  bool anew() const { return mechanism_ != nullptr; }
  /// The folded scene, or the one written where nothing was folded. @pre anew()
  const FoldedScene& folded() const { return folded_; }
  /// The cuts chosen; gains() is false where there are none.
  const Recut& cuts() const { return cuts_; }
  /// "welded into 'B': 'C'; cut at 'J3', with 'end' in the tree"; empty where it is the scene as
  /// written.
  std::string in_words() const;

 private:
  const Mechanism& written_;
  const Start& written_start_;
  bool take(std::shared_ptr<const Mechanism> mechanism);
  std::shared_ptr<const Mechanism> made(const Scene& scene) const;

  FoldedScene folded_;
  Recut cuts_;
  std::shared_ptr<const Mechanism> mechanism_;
  Start start_;
};

/// Whether joints of a scene have rigid stops (JointSpec::restitution): these hold coordinates as
/// written, so that a run integrates the scene as written.
bool has_rigid_stops(const Scene& scene);

/// The scene that runs integrate, for programs with integrators of their own: ClosedChain and
/// OpenChain take every scene as written. The same motion from the same start, loops closed; joints
/// keep their names, those that stay joints their coordinates; remarks tell which joints and loops
/// changed places. The given scene where no other is less work.
/// @throws SceneError as Mechanism and assemble(). Cost: as IntegratedScene
Scene integrated_scene(const Scene& scene);

}  // namespace momenta
