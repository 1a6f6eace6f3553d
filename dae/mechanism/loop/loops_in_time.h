#pragma once
// The loops of a model at one time: points, axes, lengths and offsets where drives prescribe them,
// and their rates relative to the bodies.
//
//   x_B = x_B0 + Σ f_k d_k,  v = Σ ḟ_k d_k,  a = Σ f̈_k d_k
//   b_j = R₁(f₁) R₂(f₂) … b_j0;  with c_k = R₁ … R_{k−1} times the axis of R_k
//   w = Σ ḟ_k c_k,  dw/dt = Σ (f̈_k c_k + w_{<k} × ḟ_k c_k)
//
// Everything that follows, rows, impulses and rates N, is then as for points and axes fixed in the
// bodies, with total velocities in place of the bodies'.

#include <momenta/core/scalar/pack.h>
#include <momenta/dae/mechanism/loop/loop_model.h>

namespace momenta {

/// Functions are out of line, in doubles: the sweeps that call them are compiled for several
/// instruction levels.
template <class Space>
class LoopsInTime {
 public:
  /// @pre the model stays where it is
  explicit LoopsInTime(const LoopModel<Space>& model);
  ~LoopsInTime();
  LoopsInTime(const LoopsInTime&) = delete;
  LoopsInTime& operator=(const LoopsInTime&) = delete;

  /// The model at time t [s]; valid until the next call. O(loops with drives), no allocation.
  MOMENTA_INLINE const LoopModel<Space>& at(double t) { return moving_ ? moved(t) : *constant_; }

 private:
  const LoopModel<Space>& moved(double t);

  const LoopModel<Space>* constant_;
  LoopModel<Space>* moving_;  ///< own; null without drives
};

}  // namespace momenta
