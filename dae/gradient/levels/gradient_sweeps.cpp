// The sweeps of derivatives at the best level of this machine.

#include <momenta/core/kernel/levels/at_level.h>
#include <momenta/dae/gradient/levels/direction_sweeps.h>
#include <momenta/dae/gradient/levels/mixed_sweep.h>
#include <momenta/dae/gradient/levels/tangent_sweeps.h>

namespace momenta {

template <int Level, class Space, class Tree>
std::unique_ptr<TangentSweeps> tangent_sweeps_at(const Tree& tree, const SweptLoops<Space>& swept,
                                                 double fade, bool body_forces);
template <int Level, class Space, class Tree>
std::unique_ptr<DirectionSweeps> direction_sweeps_at(const Tree& tree,
                                                     const SweptLoops<Space>& swept, double fade,
                                                     bool body_forces);
template <int Level, class Space>
std::unique_ptr<NumberSweep> number_sweep_at(const Model<Space>& model,
                                             const LoopModel<Space>& loops, bool of_places);
template <int Level, class Space>
std::unique_ptr<NumberRows> number_rows_at(const Model<Space>& model, std::size_t count,
                                           const LoopModel<Space>* loops);
template <int Level, class Space>
std::unique_ptr<KineticSweep> kinetic_sweep_at(const Model<Space>& model);
template <int Level, class Space>
std::unique_ptr<MixedSweep> mixed_sweep_at(const Model<Space>& model, const LoopModel<Space>& loops,
                                           bool joint_forces);

namespace {

template <class Act>
auto at_best_level(Act&& act) {
  return at_level(best_level(), act);
}

}  // namespace

template <class Tree, class Space>
std::unique_ptr<TangentSweeps> make_tangent_sweeps(const Tree& tree, const SweptLoops<Space>& swept,
                                                   double fade, bool body_forces) {
  return at_best_level(
      [&]<int Level>() { return tangent_sweeps_at<Level>(tree, swept, fade, body_forces); });
}
template <class Tree, class Space>
std::unique_ptr<DirectionSweeps> make_direction_sweeps(const Tree& tree,
                                                       const SweptLoops<Space>& swept, double fade,
                                                       bool body_forces) {
  return at_best_level(
      [&]<int Level>() { return direction_sweeps_at<Level>(tree, swept, fade, body_forces); });
}
template <class Space>
std::unique_ptr<NumberSweep> make_number_sweep(const Model<Space>& model,
                                               const LoopModel<Space>& loops, bool of_places) {
  return at_best_level(
      [&]<int Level>() { return number_sweep_at<Level>(model, loops, of_places); });
}
template <class Space>
std::unique_ptr<NumberRows> make_number_rows(const Model<Space>& model, std::size_t count,
                                             const LoopModel<Space>* loops) {
  return at_best_level([&]<int Level>() { return number_rows_at<Level>(model, count, loops); });
}
template <class Space>
std::unique_ptr<KineticSweep> make_kinetic_sweep(const Model<Space>& model) {
  return at_best_level([&]<int Level>() { return kinetic_sweep_at<Level>(model); });
}
template <class Space>
std::unique_ptr<MixedSweep> make_mixed_sweep(const Model<Space>& model,
                                             const LoopModel<Space>& loops, bool joint_forces) {
  return at_best_level(
      [&]<int Level>() { return mixed_sweep_at<Level>(model, loops, joint_forces); });
}

template std::unique_ptr<TangentSweeps> make_tangent_sweeps(const PlanarTree&,
                                                            const SweptLoops<Planar>&, double,
                                                            bool);
template std::unique_ptr<DirectionSweeps> make_direction_sweeps(const PlanarTree&,
                                                                const SweptLoops<Planar>&, double,
                                                                bool);
template std::unique_ptr<NumberSweep> make_number_sweep(const Model<Planar>&,
                                                        const LoopModel<Planar>&, bool);
template std::unique_ptr<NumberRows> make_number_rows(const Model<Planar>&, std::size_t,
                                                      const LoopModel<Planar>*);
template std::unique_ptr<KineticSweep> make_kinetic_sweep(const Model<Planar>&);
template std::unique_ptr<MixedSweep> make_mixed_sweep(const Model<Planar>&,
                                                      const LoopModel<Planar>&, bool);
template std::unique_ptr<TangentSweeps> make_tangent_sweeps(const LinkTree&,
                                                            const SweptLoops<Spatial>&, double,
                                                            bool);
template std::unique_ptr<DirectionSweeps> make_direction_sweeps(const LinkTree&,
                                                                const SweptLoops<Spatial>&, double,
                                                                bool);
template std::unique_ptr<NumberSweep> make_number_sweep(const Model<Spatial>&,
                                                        const LoopModel<Spatial>&, bool);
template std::unique_ptr<NumberRows> make_number_rows(const Model<Spatial>&, std::size_t,
                                                      const LoopModel<Spatial>*);
template std::unique_ptr<KineticSweep> make_kinetic_sweep(const Model<Spatial>&);
template std::unique_ptr<MixedSweep> make_mixed_sweep(const Model<Spatial>&,
                                                      const LoopModel<Spatial>&, bool);

}  // namespace momenta
