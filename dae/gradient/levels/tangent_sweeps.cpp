#include <momenta/dae/gradient/levels/at_best_level.h>
#include <momenta/dae/gradient/levels/tangent_sweeps.h>

namespace momenta {

template <int Level, class Space, class Tree>
std::unique_ptr<TangentSweeps> tangent_sweeps_at(const Tree& tree, const SweptLoops<Space>& swept,
                                                 double fade, bool body_forces);
template <int Level, class Space>
std::unique_ptr<NumberSweep> number_sweep_at(const Model<Space>& model,
                                             const LoopModel<Space>& loops, bool of_places);
template <int Level, class Space>
std::unique_ptr<KineticSweep> kinetic_sweep_at(const Model<Space>& model);

namespace {

template <class Tree, class Space>
std::unique_ptr<TangentSweeps> tangents(const Tree& tree, const SweptLoops<Space>& swept,
                                        double fade, bool body_forces) {
  return at_best_level(
      [&]<int Level>() { return tangent_sweeps_at<Level>(tree, swept, fade, body_forces); });
}
template <class Space>
std::unique_ptr<NumberSweep> numbers(const Model<Space>& model, const LoopModel<Space>& loops,
                                     bool of_places) {
  return at_best_level(
      [&]<int Level>() { return number_sweep_at<Level>(model, loops, of_places); });
}
template <class Space>
std::unique_ptr<KineticSweep> kinetic(const Model<Space>& model) {
  return at_best_level([&]<int Level>() { return kinetic_sweep_at<Level>(model); });
}

}  // namespace

std::unique_ptr<TangentSweeps> make_tangent_sweeps(const PlanarTree& tree,
                                                   const SweptLoops<Planar>& swept, double fade,
                                                   bool body_forces) {
  return tangents(tree, swept, fade, body_forces);
}
std::unique_ptr<TangentSweeps> make_tangent_sweeps(const LinkTree& tree,
                                                   const SweptLoops<Spatial>& swept, double fade,
                                                   bool body_forces) {
  return tangents(tree, swept, fade, body_forces);
}
std::unique_ptr<NumberSweep> make_number_sweep(const Model<Planar>& model,
                                               const LoopModel<Planar>& loops, bool of_places) {
  return numbers(model, loops, of_places);
}
std::unique_ptr<NumberSweep> make_number_sweep(const Model<Spatial>& model,
                                               const LoopModel<Spatial>& loops, bool of_places) {
  return numbers(model, loops, of_places);
}
std::unique_ptr<KineticSweep> make_kinetic_sweep(const Model<Planar>& model) {
  return kinetic(model);
}
std::unique_ptr<KineticSweep> make_kinetic_sweep(const Model<Spatial>& model) {
  return kinetic(model);
}

}  // namespace momenta
