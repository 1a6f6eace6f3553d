#pragma once
// The sweeps in space whose numbers are packs, states or branches side by side, compiled apart from
// those of one state: a record of packs is best copied 64 bytes at a time, a record of single
// numbers is not (the root's CMakeLists.txt says why). MOMENTA_SPATIAL_PACKS(extern, L) keeps a
// file from compiling them again.

#include <momenta/core/kernel/levels/strided.h>
#include <momenta/dae/kkt/sweeps/spatial_loop_sweeps.h>

namespace momenta {

template <int Level>
using StatesAbreast = Pack<native_width<Level>, Level>;
template <int Level>
using BranchesAbreast = typename LoopedBranchLanes<Pack<1, Level>>::type;

template <int Level, int Rows, bool Momentum>
using SpatialSweepsOfStates = SpatialLoopSweeps<StatesAbreast<Level>, Rows, Momentum, LinkTree>;
template <int Level, bool Momentum>
using SpatialSweepsOfBranches =
    SpatialLoopSweeps<BranchesAbreast<Level>, most_looped_branch_rows, Momentum,
                      LoopedBranchTree<BranchesAbreast<Level>>>;

}  // namespace momenta

#define MOMENTA_SPATIAL_STATES(prefix, L, Rows, Momentum)                     \
  prefix template bool SpatialSweepsOfStates<L, Rows, Momentum>::operator()(  \
      const StatesAbreast<L>&, const StridedIn<StatesAbreast<L>>&,            \
      const StridedIn<StatesAbreast<L>>&, const StridedIn<StatesAbreast<L>>&, \
      const RightSide<StatesAbreast<L>>&, StridedOut<StatesAbreast<L>>,       \
      StridedOut<StatesAbreast<L>>, StridedOut<StatesAbreast<L>>);
#define MOMENTA_SPATIAL_BRANCHES(prefix, L, Momentum)                                       \
  prefix template bool SpatialSweepsOfBranches<L, Momentum>::looped_branches_inward(        \
      const BranchesAbreast<L>&, const BranchesAbreast<L>* const&,                          \
      const BranchesAbreast<L>* const&, const BranchesAbreast<L>* const&,                   \
      const RightSide<BranchesAbreast<L>>&, const LoopBody<BranchesAbreast<L>>&);           \
  prefix template void SpatialSweepsOfBranches<L, Momentum>::looped_branches_outward(       \
      const BranchesAbreast<L>* const&, const RightSide<BranchesAbreast<L>>&,               \
      const Spatial::Motion<BranchesAbreast<L>>&, BranchesAbreast<L>*, BranchesAbreast<L>*, \
      BranchesAbreast<L>*);
#define MOMENTA_SPATIAL_PACKS(prefix, L)                                \
  MOMENTA_SPATIAL_STATES(prefix, L, 4, true)                            \
  MOMENTA_SPATIAL_STATES(prefix, L, 4, false)                           \
  MOMENTA_SPATIAL_STATES(prefix, L, 8, true)                            \
  MOMENTA_SPATIAL_STATES(prefix, L, 8, false)                           \
  MOMENTA_SPATIAL_BRANCHES(prefix, L, true)                             \
  MOMENTA_SPATIAL_BRANCHES(prefix, L, false)                            \
  prefix template const Spatial::Force<BranchesAbreast<L>>&             \
  SpatialSweepsOfBranches<L, true>::looped_branches_rates(              \
      const Vec3<BranchesAbreast<L>>&, const Vec3<BranchesAbreast<L>>&, \
      const RightSide<BranchesAbreast<L>>&, BranchesAbreast<L>* const&, BranchesAbreast<L>*);
