#pragma once
// The second derivatives of mixed_rates.h by one sweep outward and one inward, compiled for several
// x86-64 levels as the sweeps of a run are.

#include <momenta/core/kernel/model.h>
#include <momenta/dae/kkt/sweeps/levels/loop_sweeps.h>

#include <algorithm>
#include <memory>

namespace momenta {

/// One object serves one thread; no call allocates.
class MixedSweep {
 public:
  /// t [s]; q, u, u̇, ν of nv numbers; λ, μ of m; s of mixed_rates.h.
  struct At {
    double t;
    const double *q, *u, *udot, *lambda, *nu, *mu;
    double s;
  };
  /// Plain arrays of nv numbers: by_q, by_u without feedback, Φ_qᵀμ and its rate along the motion.
  struct Result {
    double *by_q, *by_u, *force, *rate;
  };
  virtual ~MixedSweep() = default;
  /// O(bodies + m)
  virtual void operator()(const At& at, const Result& result) = 0;
};

/// Whether nothing is prescribed and only weights, forces of joints, and loops of points, axes and
/// distances act.
template <class Space>
bool mixed_sweep_fits(const Model<Space>& model, const LoopModel<Space>& loops) {
  return !model.has_body_forces() && model.drives.empty() && model.laws.empty() &&
         loops.motions.empty() && loops.pairs.empty() && loops.equations.empty() &&
         loops.wheels.empty() && loops.curves == 0 &&
         std::none_of(loops.loops.begin(), loops.loops.end(),
                      [](const auto& loop) { return loop.is_coupler(); });
}

/// The sweep at best_level(). `joint_forces`: those of joints are potential; else none are. @pre
/// mixed_sweep_fits(); both arguments stay where they are
template <class Space>
std::unique_ptr<MixedSweep> make_mixed_sweep(const Model<Space>& model,
                                             const LoopModel<Space>& loops, bool joint_forces);

}  // namespace momenta
