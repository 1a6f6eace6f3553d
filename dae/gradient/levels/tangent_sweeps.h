#pragma once
// Evaluations at stages of a step back over a run, along one direction, compiled for several x86-64
// levels. No call allocates; one object serves one thread.

#include <momenta/core/kernel/link.h>
#include <momenta/core/kernel/model.h>
#include <momenta/core/kernel/planar_joint.h>
#include <momenta/dae/kkt/sweeps/levels/loop_sweeps.h>

#include <Eigen/Core>
#include <memory>

namespace momenta {

/// (q, p, t) → (u, σ, ṗ), eqs. (7)-(8), and its derivative along (δq, δp).
class TangentSweeps {
 public:
  /// Plain arrays of nv numbers, σ of m.
  struct Result {
    double *u, *du, *dpdot;
    double *sigma, *dsigma;  ///< rows as they are swept
  };
  virtual ~TangentSweeps() = default;
  /// κ of (8) and β of (7) [1/s], zero until then.
  virtual void feed_back(double leak, double beta) = 0;
  /// False where a joint has no inertia or a branch is weak. `besides`: added to the second row's
  /// derivative (m), by rows as they are swept; null: zero. O(bodies + m)
  virtual bool operator()(double t, const double* q, const double* p, const double* dq,
                          const double* dp, const Result& result,
                          const double* besides = nullptr) = 0;
};

/// Where the numbers of a mechanism's tables stand among the slopes, in this order:
///   - of each body m, m c, J, 10 in space, 4 in a plane; gravity
///   - of each joint its place, in space a screw at the parent's origin (shift, turn), in a plane
///     the shift and the direction of a slide; stiffness, rest, damping, torque, friction; rotor
///   - of each loop x_A, x_B, and by j axes a_j, b_j, in body axes; 1/l₀, l or c, square of the
///     offset across the plane, γ
///   - of each spring between points both ends, stiffness, rest, damping, square of the offset; of
///     each spring of coordinates stiffness, rest, damping
///   - of each wrench its point, force, couple; of each bushing its two stiffnesses and dampings,
///     k, c, k_r, c_r
///   - of each drive of a joint f and ḟ, at the time of the motion
template <class Space>
struct NumberPlaces {
  static constexpr int axes = Space::dimension == 6 ? 3 : 2;
  static constexpr Eigen::Index of_body = Space::dimension == 6 ? 10 : 4,
                                of_joint = (Space::dimension == 6 ? 6 : 4) + 6,
                                of_loop = 2 * axes * (1 + axes) + 4, of_spring = 2 * axes + 4,
                                of_sum = 3, of_wrench = 2 * axes + (axes == 3 ? 3 : 1),
                                of_bushing = 4, of_drive = 2;
  Eigen::Index joints = 0, loops = 0, springs = 0, sums = 0, wrenches = 0, bushings = 0, drives = 0,
               size = 0;
};
template <class Space>
MOMENTA_INLINE NumberPlaces<Space> number_places(const Model<Space>& model, std::size_t loops) {
  using Places = NumberPlaces<Space>;
  const auto n = static_cast<Eigen::Index>(model.bodies.size());
  Places at;
  at.joints = Places::of_body * n + Places::axes;
  at.loops = at.joints + Places::of_joint * n;
  at.springs = at.loops + Places::of_loop * static_cast<Eigen::Index>(loops);
  at.sums = at.springs + Places::of_spring * static_cast<Eigen::Index>(model.springs.size());
  at.wrenches =
      at.sums + Places::of_sum * static_cast<Eigen::Index>(model.coordinate_springs.size());
  at.bushings = at.wrenches + Places::of_wrench * static_cast<Eigen::Index>(model.wrenches.size());
  at.drives = at.bushings + Places::of_bushing * static_cast<Eigen::Index>(model.bushings.size());
  at.size = at.drives + Places::of_drive * static_cast<Eigen::Index>(model.drives.size());
  return at;
}

/// Derivatives by numbers of L* = T − V + σᵀΦ̇ and of σᵀΦ: number_slopes.h. Motions are read at once
/// and swept later, several side by side.
class NumberSweep {
 public:
  /// Arrays of nv and m numbers at t [s]; u, σ, dq, du, dσ may be null: zero.
  struct Motion {
    double t;
    const double *q, *u, *sigma, *dq, *du, *dsigma;
  };
  virtual ~NumberSweep() = default;
  /// Adds factor D ∂L*/∂number along (dq, du, dσ). O(bodies + m)
  virtual void add(double factor, const Motion& at) = 0;
  /// Adds factor D ∂(σᵀΦ̇)/∂number alone. O(bodies + m)
  virtual void add_loop_rates(double factor, const Motion& at) = 0;
  /// Adds factor ∂(νᵀΦ)/∂number. O(bodies + m)
  virtual void add_loops(double factor, double t, const double* q, const double* nu) = 0;
  /// slopes += all since the last finish(). O(numbers)
  virtual void finish(double* slopes) = 0;
};

/// D_v T_q and M v (mixed_rates.h).
class KineticSweep {
 public:
  virtual ~KineticSweep() = default;
  /// rates, momenta (nv each) at t [s], q, u along v (nv each). O(bodies)
  virtual void along(double t, const double* q, const double* u, const double* v, double* rates,
                     double* momenta) = 0;
};

/// Sweeps of one mechanism at best_level(); the arguments stay where they are. `fade`: share of its
/// scale below which a pivot fades. @pre swept.plan.fits()
template <class Tree, class Space>
std::unique_ptr<TangentSweeps> make_tangent_sweeps(const Tree& tree, const SweptLoops<Space>& swept,
                                                   double fade, bool body_forces);
/// `of_places` false: without the places of joints and the numbers of loops, at less cost.
template <class Space>
std::unique_ptr<NumberSweep> make_number_sweep(const Model<Space>& model,
                                               const LoopModel<Space>& loops, bool of_places);
template <class Space>
std::unique_ptr<KineticSweep> make_kinetic_sweep(const Model<Space>& model);

}  // namespace momenta
