#include <momenta/dae/assembly/assembly.h>
#include <momenta/dae/cut/fold_rotors.h>
#include <momenta/dae/cut/interchange.h>
#include <momenta/dae/cut/swept_scene.h>

namespace momenta {
namespace {

/// Whether an evaluation is worth other coordinates.
bool pays(const Mechanism& written, const Recut& cuts) {
  const double per_body = written.plan().planar ? 8 : 30;
  const auto cost = [&](const CutCost& cut) {
    return per_body * static_cast<double>(written.tree().bodies.size()) +
           static_cast<double>(cut.work);
  };
  const bool carried = written.kkt() == KktChoice::sweeps;
  return !carried || cost(cuts.after) < 0.9 * cost(cuts.before) ||
         4 * cuts.after.mass_entries < 3 * cuts.before.mass_entries;
}

}  // namespace

SweptScene::SweptScene(const Mechanism& written, const Start& start)
    : written_(written), written_start_(start) {
  folded_.scene = written.scene();
  const MechanismOptions& options = written.options();
  if (options.cut == CutChoice::scene || options.kkt == KktChoice::dense ||
      options.kkt == KktChoice::sparse)
    return;
  Scene there = written.scene();
  there.joints = joints_at(written, start);
  FoldedScene folded = fold(there);
  if (folded.folds() && take(folded.scene)) folded_ = std::move(folded);
  Recut found = recut(mechanism(), this->start());
  if (found.gains() && pays(mechanism(), found) && take(found.scene)) cuts_ = std::move(found);
}

bool SweptScene::take(Scene scene) {
  try {
    auto mechanism = std::make_unique<Mechanism>(std::move(scene), written_.options());
    const Tree& tree = mechanism->tree();
    Assembly assembly = assemble(*mechanism, written_start_.t, tree.q0, tree.u0);
    // Where equations contradict each other the pose is that of least squares, another one.
    constexpr double same_pose = 1e-9;
    if (assembly.moved > same_pose) return false;
    start_ = std::move(assembly.start);
    mechanism_ = std::move(mechanism);
    return true;
  } catch (const SceneError&) {
    return false;  // what cannot start so is swept as it is written
  }
}

}  // namespace momenta
