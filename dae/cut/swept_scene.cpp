#include <momenta/core/scene/near_name.h>
#include <momenta/dae/assembly/assembly.h>
#include <momenta/dae/cut/fold_rotors.h>
#include <momenta/dae/cut/interchange.h>
#include <momenta/dae/cut/swept_scene.h>

#include <algorithm>

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

bool may_fold(const Scene& scene) {
  const auto weld = [](const JointSpec& joint) { return joint.kind == JointKind::weld; };
  const auto coupler = [](const LoopSpec& loop) { return loop.kind == LoopKind::coupler; };
  return std::any_of(scene.joints.begin(), scene.joints.end(), weld) ||
         std::any_of(scene.loops.begin(), scene.loops.end(), coupler);
}

}  // namespace

SweptScene::SweptScene(const Mechanism& written, const Start& start)
    : written_(written), written_start_(start) {
  folded_.scene = written.scene();
  const MechanismOptions& options = written.options();
  if (options.cut == CutChoice::scene || options.kkt == KktChoice::dense ||
      options.kkt == KktChoice::sparse)
    return;
  try {
    if (may_fold(written.scene())) {
      Scene there = written.scene();
      there.joints = joints_at(written, start);
      FoldedScene folded = fold(there);
      if (folded.folds() && take(folded.scene)) folded_ = std::move(folded);
    }
    Recut found = recut(mechanism(), this->start());
    if (found.gains() && pays(mechanism(), found) && take(found.scene)) cuts_ = std::move(found);
  } catch (const SceneError&) {
    return;  // what cannot start so is swept as it is written
  }
}

std::string SweptScene::in_words() const {
  if (!anew()) return "";
  std::string words = momenta::in_words(folded_);
  if (!cuts_.gains()) return words;
  if (cuts_.cut.empty())
    return words + (words.empty() ? "" : "; ") + "trees on the ground in another order";
  constexpr std::size_t most_named = 4;
  return words + (words.empty() ? "" : "; ") + "cut at " +
         reading::all_in_quotes(cuts_.cut, most_named) + ", with " +
         reading::all_in_quotes(cuts_.joined, most_named) + " in the tree";
}

bool SweptScene::take(Scene scene) {
  auto mechanism = std::make_unique<Mechanism>(std::move(scene), written_.options());
  const Tree& tree = mechanism->tree();
  Assembly assembly = assemble(*mechanism, written_start_.t, tree.q0, tree.u0);
  // Where equations contradict each other the pose is that of least squares, another one.
  constexpr double same_pose = 1e-9;
  if (assembly.moved > same_pose) return false;
  // Loops none of whose equations are independent leave every method rounding alone to divide by.
  if (mechanism->m() > 0 && assembly.rank == 0) return false;
  start_ = std::move(assembly.start);
  mechanism_ = std::move(mechanism);
  return true;
}

}  // namespace momenta
