#pragma once
// The wrenches that joints and loops transmit. Eqs. (20), (21), (28), with the applied wrenches
// T_K, which include −Jᵀλ of the loops:
//
//   F_K = M_K A_K + Ω_K × (M_K Ω_K) − T_K + Σ 𝒯ᶠ F_child
//
// F_K is the whole wrench of joint K on its child body: the reaction, and along the free directions
// of the joint the forces of its spring, damper, drive and generalised forces. The wrench of a loop
// on its child is −λ times the unit wrenches of its rows; its parent takes the opposite wrench on
// the same line of action.
//
// A driven coordinate d of a joint is a coordinate whose equation (1a) is not solved but gives the
// effort of its drive, with r_d the ratios of couplers that tie it:
//
//   τ_d = E_dᵀ F_K + Σ r_d λ
//
// The planar kernel has forces in the plane and torques normal to it. Loads out of the plane are
// not determined there, and are left out.

#include <momenta/dae/mechanism.h>

#include <memory>
#include <string>
#include <vector>

namespace momenta {

/// The wrench on the child of a joint or loop, in ground axes.
struct Transmitted {
  std::string name;        ///< of the joint or loop
  Eigen::Vector3d at;      ///< the joint's or loop's point of the child, ground axes [m]
  Eigen::Vector3d force;   ///< [N]
  Eigen::Vector3d torque;  ///< about `at` [N m]
  bool unique = true;      ///< false: redundant loop equations leave this wrench undetermined
};

/// The wrenches of all joints and loops.
struct Reactions {
  std::vector<Transmitted> joints;  ///< in the order of joint_places()
  std::vector<Transmitted> loops;   ///< in the order of the scene
};

/// The wrenches along a motion: what they need of the mechanism is made once.
class WrenchSweep {
 public:
  virtual ~WrenchSweep() = default;

  /// Sweeps the bodies at (t, q, u), with accelerations `udot` (nv) and force multipliers `lambda`
  /// (m) [N, N m]. Cost O(bodies + loops), no allocation.
  virtual void move(double t, const double* q, const double* u, const double* udot,
                    const double* lambda) = 0;
  /// The efforts of the drives of joints, by their places in Tree::drives: what each drive adds
  /// along its coordinate, beside what springs and formulas do there [N m, N]. After move().
  virtual void efforts(double* by_drive) const = 0;
  /// Σ F_K·Ω_t: the power of what moves joints with time, drives above all [W]. After move().
  virtual double prescribed_power() const = 0;
  /// The wrenches of all joints and loops. After move().
  virtual Reactions reactions() = 0;
};

/// @pre the scene has bodies, no Lagrangian. Cost O(bodies + loops)
std::unique_ptr<WrenchSweep> make_wrench_sweep(const Mechanism& mechanism);

/// Wrenches at (t, q, u), with accelerations `udot` (nv) and force multipliers `lambda` (m) [N, N
/// m]. Cost O(bodies + loops).
Reactions reactions(const Mechanism& mechanism, double t, const Eigen::VectorXd& q,
                    const Eigen::VectorXd& u, const Eigen::VectorXd& udot,
                    const Eigen::VectorXd& lambda);

/// Marks as not unique the wrenches that change with multipliers without effect on the motion, the
/// columns of `idle` (m × n, measure/rank.h), by more than `rounding` of the largest change.
void mark_undetermined(Reactions& all, const Mechanism& mechanism, double t,
                       const Eigen::VectorXd& q, const Eigen::MatrixXd& idle,
                       double rounding = 1e-9);

}  // namespace momenta
