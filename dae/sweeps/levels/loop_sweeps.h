#pragma once
// The sweeps that carry loops, compiled for several x86-64 levels in one library and for several
// numbers of lanes, and chosen when a mechanism is made.

#include <momenta/core/kernel/link.h>
#include <momenta/core/kernel/levels/open_sweeps.h>
#include <momenta/core/kernel/planar_link.h>
#include <momenta/dae/loop/loop_model.h>
#include <momenta/dae/sweeps/loop_plan.h>
#include <momenta/dae/sweeps/right_side.h>

#include <memory>

namespace momenta {

/// States side by side: coordinate i of state s is at base[i * stride + s].
struct LoopedStates {
  const double *q, *p;
  double *u, *sigma, *pdot;
  std::ptrdiff_t stride;
  std::size_t count;
};

class LoopedSweeps {
 public:
  virtual ~LoopedSweeps() = default;

  /// u (nv) and σ (m) of (7) from p (nv); with right.rates ṗ (nv) of (8), forces between points of
  /// bodies left out. False when a joint has no inertia: stuck().
  virtual bool momentum(double t, const double* q, const double* p, const RightSide<double>& right,
                        double* u, double* sigma, double* pdot) = 0;
  /// u̇ (nv) and λ (m) of (3) from u and all generalised forces τ (nv) but the weights'.
  virtual bool acceleration(double t, const double* q, const double* u, const double* tau,
                            const RightSide<double>& right, double* udot, double* lambda) = 0;
  /// momentum() with rates for many states, `width()` at a time; no centre. False when some state
  /// has a joint without inertia.
  virtual bool momentum(double t, const LoopedStates& states, double fade, double leak) = 0;

  /// Rows of Φ that faded in the last solution of one state: that of momentum(), or acceleration().
  /// Returns their number; `rows` has room for m.
  virtual std::size_t faded_rows(int* rows, bool of_momentum) const = 0;
  virtual int lanes() const = 0;
  virtual int width() const = 0;
  virtual int stuck() const = 0;
};

/// The same loops with points and axes in the frames of the links.
LoopModel<Planar> in_link_frames(LoopModel<Planar> loops, const PlanarTree& tree);

/// @pre `loops` in the frames of the links, level ≤ best_level(), plan.fits(); tree and plan stay where they are.
std::unique_ptr<LoopedSweeps> make_looped_sweeps(const PlanarTree& tree,
                                                 const LoopModel<Planar>& loops,
                                                 const LoopPlan& plan, int level);
std::unique_ptr<LoopedSweeps> make_looped_sweeps(const LinkTree& tree,
                                                 const LoopModel<Spatial>& loops,
                                                 const LoopPlan& plan, int level);

}  // namespace momenta
