#pragma once
// The loops of a model at one time: points, axes, lengths and offsets where drives prescribe them,
// and their rates relative to the bodies.
// (driven_loop.h). Everything that follows, rows, impulses and rates N, is then as for points and
// axes fixed in the bodies, with total velocities in place of the bodies'.

#include <momenta/core/scalar/pack.h>
#include <momenta/dae/loop/loop_model.h>

namespace momenta {

/// Its functions are out of line, in doubles: the sweeps that call them are compiled for several
/// instruction levels.
template <class Space>
class LoopsInTime {
 public:
  /// @pre the model stays where it is
  explicit LoopsInTime(const LoopModel<Space>& model);
  ~LoopsInTime();
  LoopsInTime(const LoopsInTime&) = delete;
  LoopsInTime& operator=(const LoopsInTime&) = delete;

  /// The model at time t [s]: without drives as it is. Valid until the next call. O(loops with
  /// drives), no allocation.
  MOMENTA_INLINE const LoopModel<Space>& at(double t) { return moving_ ? moved(t) : *constant_; }

 private:
  const LoopModel<Space>& moved(double t);

  const LoopModel<Space>* constant_;
  LoopModel<Space>* moving_;  ///< own; null without drives
};

}  // namespace momenta
