#include <momenta/dae/gradient/levels/at_best_level.h>
#include <momenta/dae/gradient/levels/mixed_sweep.h>

namespace momenta {

template <int Level, class Space>
std::unique_ptr<MixedSweep> mixed_sweep_at(const Model<Space>& model, const LoopModel<Space>& loops,
                                           bool joint_forces);

namespace {

template <class Space>
std::unique_ptr<MixedSweep> mixed(const Model<Space>& model, const LoopModel<Space>& loops,
                                  bool joint_forces) {
  return at_best_level(
      [&]<int Level>() { return mixed_sweep_at<Level>(model, loops, joint_forces); });
}

}  // namespace

std::unique_ptr<MixedSweep> make_mixed_sweep(const Model<Planar>& model,
                                             const LoopModel<Planar>& loops, bool joint_forces) {
  return mixed(model, loops, joint_forces);
}
std::unique_ptr<MixedSweep> make_mixed_sweep(const Model<Spatial>& model,
                                             const LoopModel<Spatial>& loops, bool joint_forces) {
  return mixed(model, loops, joint_forces);
}

}  // namespace momenta
