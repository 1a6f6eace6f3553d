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
// A driven coordinate d of a joint has an equation (1a) that is not solved but gives the effort of
// its drive, with r_d the ratios of its couplers:
//
//   τ_d = E_dᵀ F_K + Σ r_d λ
//
// The planar kernel has forces in the plane and torques normal to it. Other loads are not
// determined there, and are left out.

#include <momenta/dae/mechanism/mechanism.h>

#include <memory>
#include <string>
#include <vector>

namespace momenta {

/// The wrench on the child of a joint or loop, in ground axes.
struct Transmitted {
  std::string name;        ///< joint or loop
  Eigen::Vector3d at;      ///< point of the child, ground axes [m]
  Eigen::Vector3d force;   ///< [N]
  Eigen::Vector3d torque;  ///< about `at` [N m]
  bool unique = true;      ///< false: redundant loop equations leave this wrench undetermined
};

/// The wrenches of all joints and loops.
struct Reactions {
  std::vector<Transmitted> joints;  ///< order of joint_places()
  std::vector<Transmitted> loops;   ///< order of the scene
};

/// The wrenches along a motion: what they need of the mechanism is made once.
class WrenchSweep {
 public:
  virtual ~WrenchSweep() = default;

  /// Sweeps at (t, q, u), with accelerations `udot` (nv) and force multipliers `lambda` (m) [N, N
  /// m]. Cost O(bodies + loops), no allocation.
  virtual void move(double t, const double* q, const double* u, const double* udot,
                    const double* lambda) = 0;
  /// Efforts of joints' drives along their coordinates, in the order of Tree::drives, without
  /// springs and formulas [N m, N]. After move().
  virtual void efforts(double* by_drive) const = 0;
  /// Σ F_K·Ω_t: power of prescribed motion of joints [W]. After move().
  virtual double prescribed_power() const = 0;
  /// After move().
  virtual Reactions reactions() = 0;
};

/// @pre the scene has bodies, no Lagrangian. Cost O(bodies + loops)
std::unique_ptr<WrenchSweep> make_wrench_sweep(const Mechanism& mechanism);

/// Wrenches at (t, q, u), with accelerations `udot` (nv) and force multipliers `lambda` (m) [N, N
/// m]. Cost O(bodies + loops).
Reactions reactions(const Mechanism& mechanism, double t, const Eigen::VectorXd& q,
                    const Eigen::VectorXd& u, const Eigen::VectorXd& udot,
                    const Eigen::VectorXd& lambda);

/// Marks wrenches as not unique that columns of `idle` (m × n, measure/rank.h), multipliers without
/// effect on the motion, change by more than `rounding` of the largest change.
void mark_undetermined(Reactions& all, const Mechanism& mechanism, double t,
                       const Eigen::VectorXd& q, const Eigen::MatrixXd& idle,
                       double rounding = 1e-9);

}  // namespace momenta
