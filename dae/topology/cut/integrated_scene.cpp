#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/topology/assembly/assembly.h>
#include <momenta/dae/topology/cut/fold_rotors.h>
#include <momenta/dae/topology/cut/integrated_scene.h>
#include <momenta/dae/topology/cut/interchange.h>

#include <algorithm>

namespace momenta {
namespace {

/// Whether cuts are worth other coordinates: a tenth less work, or swept at all. Another order of
/// the same coordinates need only cost less.
bool pays(const Mechanism& written, const Recut& cuts) {
  return written.solver().kkt() != KktChoice::sweeps ||
         10 * cuts.after.sweeps < 9 * cuts.before.sweeps ||
         (cuts.cut.empty() && cuts.after.sweeps < cuts.before.sweeps);
}

bool may_fold(const Scene& scene) {
  const auto weld = [](const JointSpec& joint) { return joint.kind == JointKind::weld; };
  const auto coupler = [](const LoopSpec& loop) { return loop.kind == LoopKind::coupler; };
  return std::any_of(scene.joints.begin(), scene.joints.end(), weld) ||
         std::any_of(scene.loops.begin(), scene.loops.end(), coupler);
}

}  // namespace

bool has_rigid_stops(const Scene& scene) {
  return std::any_of(scene.joints.begin(), scene.joints.end(),
                     [](const JointSpec& joint) { return joint.restitution.has_value(); });
}

IntegratedScene::IntegratedScene(const Mechanism& written, const Start& start, const Recut* known)
    : written_(written), written_start_(start) {
  const MechanismOptions& options = written.options();
  if (written.scene().lagrangian || has_rigid_stops(written.scene()) ||
      options.cut == CutChoice::scene || options.kkt == KktChoice::dense ||
      options.kkt == KktChoice::sparse)
    return;
  try {
    if (may_fold(written.scene())) {
      Scene there = written.scene();
      there.joints = joints_at(written, start);
      FoldedScene folded = fold(there);
      if (folded.folds() && take(made(folded.scene))) folded_ = std::move(folded);
    }
    Recut found = known && !anew() ? *known : recut(mechanism(), this->start());
    if (!found.gains() || !pays(mechanism(), found)) return;
    const bool as_asked = options.kkt == KktChoice::automatic;
    if (!take(as_asked ? found.mechanism : made(found.scene))) return;
    cuts_ = std::move(found);
    if (!folded_.folds()) folded_.scene = written.scene();
  } catch (const SceneError&) {
    return;  // a scene that cannot start so is integrated as written
  }
}

std::string IntegratedScene::in_words() const {
  const std::string words = momenta::in_words(folded_);
  const std::string cuts = momenta::in_words(cuts_);
  return words + (words.empty() || cuts.empty() ? "" : "; ") + cuts;
}

std::shared_ptr<const Mechanism> IntegratedScene::made(const Scene& scene) const {
  return std::make_shared<const Mechanism>(scene, written_.options());
}

bool IntegratedScene::take(std::shared_ptr<const Mechanism> mechanism) {
  const Tree& tree = mechanism->tree();
  Assembly assembly = assemble(*mechanism, written_start_.t, tree.q0, tree.u0);
  // Where equations contradict each other the pose is that of least squares, another one.
  constexpr double same_pose = 1e-9;
  if (assembly.moved > same_pose) return false;
  // Loops without an independent equation leave methods rounding alone to divide by.
  if (mechanism->m() > 0 && assembly.rank == 0) return false;
  start_ = std::move(assembly.start);
  mechanism_ = std::move(mechanism);
  return true;
}

Scene integrated_scene(const Scene& scene) {
  const Mechanism written(scene);
  const Start start = assemble(written).start;
  const IntegratedScene integrated(written, start);
  if (!integrated.anew()) return scene;
  Scene anew = integrated.mechanism().scene();
  anew.joints = joints_at(integrated.mechanism(), integrated.start());
  return anew;
}

}  // namespace momenta
