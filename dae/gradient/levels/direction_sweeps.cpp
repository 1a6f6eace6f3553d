#include <momenta/dae/gradient/levels/at_best_level.h>
#include <momenta/dae/gradient/levels/direction_sweeps.h>

namespace momenta {

template <int Level, class Space, class Tree>
std::unique_ptr<DirectionSweeps> direction_sweeps_at(const Tree& tree,
                                                     const SweptLoops<Space>& swept, double fade,
                                                     bool body_forces);
template <int Level, class Space>
std::unique_ptr<NumberRows> number_rows_at(const Model<Space>& model, std::size_t count,
                                           const LoopModel<Space>* loops);

std::unique_ptr<DirectionSweeps> make_direction_sweeps(const PlanarTree& tree,
                                                       const SweptLoops<Planar>& swept, double fade,
                                                       bool body_forces) {
  return at_best_level(
      [&]<int Level>() { return direction_sweeps_at<Level>(tree, swept, fade, body_forces); });
}
std::unique_ptr<DirectionSweeps> make_direction_sweeps(const LinkTree& tree,
                                                       const SweptLoops<Spatial>& swept,
                                                       double fade, bool body_forces) {
  return at_best_level(
      [&]<int Level>() { return direction_sweeps_at<Level>(tree, swept, fade, body_forces); });
}
std::unique_ptr<NumberRows> make_number_rows(const Model<Planar>& model, std::size_t count,
                                             const LoopModel<Planar>* loops) {
  return at_best_level([&]<int Level>() { return number_rows_at<Level>(model, count, loops); });
}
std::unique_ptr<NumberRows> make_number_rows(const Model<Spatial>& model, std::size_t count,
                                             const LoopModel<Spatial>* loops) {
  return at_best_level([&]<int Level>() { return number_rows_at<Level>(model, count, loops); });
}

}  // namespace momenta
