#pragma once
// The interface of the sweeps that carry loops, the same for every algebra, level and number of
// slots.

#include <momenta/core/scalar/pack.h>
#include <momenta/dae/kkt/sweeps/slots/right_side.h>

#include <cstddef>
#include <limits>

namespace momenta {

/// States side by side: coordinate i of state s is at base[i * stride + s].
struct LoopedStates {
  const double* q;              ///< nq rows
  const double* p;              ///< nv rows; of acceleration() u
  double* u;                    ///< nv rows; of acceleration() u̇
  double* sigma;                ///< m rows; of acceleration() λ
  double* pdot;                 ///< nv rows; of acceleration() not used
  std::ptrdiff_t stride;        ///< from one row to the next
  std::size_t count;            ///< how many states
  const double* tau = nullptr;  ///< acceleration() only: nv rows; null: zero
  bool body_forces = false;     ///< RightSide::body_forces

  /// `of` states from `first` on.
  MOMENTA_INLINE LoopedStates part(std::size_t first, std::size_t of) const {
    return {q + first,
            p + first,
            u + first,
            sigma + first,
            pdot ? pdot + first : nullptr,
            stride,
            of,
            tau ? tau + first : nullptr,
            body_forces};
  }
};

/// The sweeps that carry the loops of one mechanism, with their workspace: one object per thread.
/// Made by SolverChoice::sweeps().
class LoopedSweeps {
 public:
  virtual ~LoopedSweeps() = default;

  /// u (nv) and σ (m) of (7) from p (nv); with right.rates also ṗ (nv) of (8), without forces
  /// between points of bodies unless right.body_forces. False when a joint has no inertia:
  /// singular_joint().
  virtual bool momentum(double t, const double* q, const double* p, const RightSide<double>& right,
                        double* u, double* sigma, double* pdot) = 0;
  /// u̇ (nv) and λ (m) of (3) from u and the generalised forces τ (nv), weights excluded. @pre No
  /// compliance where loops are paired anew (SolverChoice::pairs_anew), here and in momentum().
  virtual bool acceleration(double t, const double* q, const double* u, const double* tau,
                            const RightSide<double>& right, double* udot, double* lambda) = 0;
  /// momentum() with rates for many states, `width()` at a time, with centre zero. False when a
  /// joint has no inertia in some state.
  virtual bool momentum(double t, const LoopedStates& states, double fade, double leak) = 0;
  /// acceleration() of many states likewise; adds the joints' own springs, dampers and torques to
  /// τ.
  virtual bool acceleration(double t, const LoopedStates& states, double fade) = 0;

  /// Rows of Φ that faded in the last solution of one state by momentum(), or by acceleration()
  /// where `of_momentum` is false. Returns their number; `rows` has room for m.
  virtual std::size_t faded_rows(int* rows, bool of_momentum) const = 0;
  /// The pivots of a solution: the weakest that has not faded, over its scale τ, and the number of
  /// faded ones.
  struct Pivots {
    double weakest = std::numeric_limits<double>::infinity();  ///< none: infinite
    int faded = 0;                                             ///< how many
  };
  /// The pivots of the last solution of one state by momentum(), or by acceleration().
  virtual Pivots pivots(bool of_momentum) const = 0;
  virtual int slots() const = 0;  ///< equations open at once, at most
  virtual int width() const = 0;  ///< states side by side
  /// Place in u of the joint at which the last call failed.
  virtual int singular_joint() const = 0;
  /// Whether the last call closed a folded branch on too weak a pivot, in its state or in one of
  /// many: the solution is then wrong.
  virtual bool weak_looped_branch() const = 0;
};

}  // namespace momenta
