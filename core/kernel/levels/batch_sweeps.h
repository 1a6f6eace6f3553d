#pragma once
// The recursions for many states, or directions of a derivative, side by side in registers of the
// level. Apart from those of one state (open_sweeps.h): they need other machine code, and a shared
// function would be linked in one version alone.

#include <momenta/core/kernel/link.h>
#include <momenta/core/kernel/planar_joint.h>

#include <cstddef>
#include <memory>

namespace momenta {

/// States side by side: coordinate i of state s is at base[i * stride + s].
struct States {
  const double *q, *p;
  double *qdot, *pdot;
  std::ptrdiff_t stride;
  std::size_t count;
  const double* tau = nullptr;  ///< joint forces for acceleration(); null: none

  /// `of` states from `first` on.
  MOMENTA_INLINE States part(std::size_t first, std::size_t of) const {
    return {q + first, p + first, qdot ? qdot + first : nullptr, pdot + first,
            stride,    of,        tau ? tau + first : nullptr};
  }
};

class BatchSweeps {
 public:
  virtual ~BatchSweeps() = default;

  /// q̇ and ṗ of many states, `width()` at a time. False when some state has a joint without
  /// inertia: its index is in failed_state(), its results are NaN, all others are right.
  virtual bool momentum(double t, const States& states) = 0;
  /// u̇ of many states; p holds u, pdot takes u̇. Forces: weights, τ, springs, dampers and torques of
  /// joints. False as momentum().
  virtual bool acceleration(double t, const States& states) = 0;

  /// ∂(q̇, ṗ)/∂(q, p), forces between points of bodies included: columns of nq + nv numbers,
  /// `stride` apart.
  virtual bool jacobian(double t, const double* q, const double* p, double* J,
                        std::ptrdiff_t stride) = 0;

  virtual int width() const = 0;
  /// Body whose joint had no inertia in the last failed call; −1: a result is not finite.
  virtual int singular_joint() const = 0;
  virtual std::size_t failed_state() const = 0;
};

/// @pre level_at_most(level) is level; the tree does not move.
std::unique_ptr<BatchSweeps> make_batch_sweeps(const LinkTree& tree, int level);
std::unique_ptr<BatchSweeps> make_batch_sweeps(const PlanarTree& tree, int level);

}  // namespace momenta
