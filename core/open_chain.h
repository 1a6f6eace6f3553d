#pragma once
// The face of `core`: an open chain (any tree) and its forward dynamics on canonical momenta.
//
//   OpenChain chain(read_scene("pendulum.toml"));
//   chain.rates(t, q, p, qdot, pdot);          // (9a), (9b): two sweeps, O(bodies)
//
// q: size nq, u and p: size nv, by joint as JointSpec says; SI units. The kernel, planar or
// spatial, is chosen by the plan. One object serves one thread: it owns the workspace. No call
// allocates unless it returns a matrix or a list.

#include <momenta/core/plan.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

namespace momenta {

using ConstVectorRef = Eigen::Ref<const Eigen::VectorXd>;
using VectorRef = Eigen::Ref<Eigen::VectorXd>;

struct Energies {
  double kinetic = 0;  ///< T [J]
  double potential =
      0;  ///< V [J]; constant joint torques and constant ground-axes forces count as potentials
  double hamiltonian = 0;  ///< H = p·u − T + V; equals T + V when nothing is driven
};

/// The wrench a joint transmits to its child body, at the joint's origin, in the scene's axes of
/// the child.
struct Reaction {
  std::string joint;
  Eigen::Vector3d force,
      torque;  ///< [N], [N m]; planar kernels give in-plane forces and the normal torque
};

class OpenChain {
 public:
  explicit OpenChain(const Scene& scene, Algebra algebra = Algebra::automatic);
  ~OpenChain();
  OpenChain(OpenChain&&) noexcept;
  OpenChain& operator=(OpenChain&&) noexcept;

  const Tree& tree() const;
  const Plan& plan() const;
  int nq() const { return tree().nq; }
  int nv() const { return tree().nv; }

  /// q̇ (nq) and ṗ (nv) from (t, q, p): eqs. (35), (45). False when a joint has no inertia to move:
  /// see failure().
  bool rates(double t, const ConstVectorRef& q, const ConstVectorRef& p, VectorRef qdot,
             VectorRef pdot);
  /// u (nv) from p: eq. (45). False as rates().
  bool velocities(double t, const ConstVectorRef& q, const ConstVectorRef& p, VectorRef u);
  /// p (nv) from u: eq. (34), O(bodies).
  void momenta(double t, const ConstVectorRef& q, const ConstVectorRef& u, VectorRef p);
  /// u̇ (nv) from (q, u): the acceleration recursion, O(bodies). False as rates().
  bool accelerations(double t, const ConstVectorRef& q, const ConstVectorRef& u, VectorRef udot);
  /// q̇ (nq) from u (nv).
  void coordinate_rates(const ConstVectorRef& q, const ConstVectorRef& u, VectorRef qdot) const;

  Energies energies(double t, const ConstVectorRef& q, const ConstVectorRef& u);
  /// Joint reactions at (t, q, u) with the accelerations the dynamics gives: eq. (28), O(bodies).
  std::vector<Reaction> reactions(double t, const ConstVectorRef& q, const ConstVectorRef& u);
  /// M (nv × nv), dense, by composite inertias.
  Eigen::MatrixXd mass_matrix(double t, const ConstVectorRef& q);
  /// Pose of every scene body in ground axes.
  std::vector<Eigen::Isometry3d> poses(double t, const ConstVectorRef& q);

  /// One sentence on the last failed call: which joint has no inertia.
  std::string failure() const;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace momenta
