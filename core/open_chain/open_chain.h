#pragma once
// The main interface of `core`: an open chain (any tree) and its forward dynamics on canonical
// momenta.
//
//     OpenChain chain(read_scene("pendulum.toml"));
//     chain.rates(t, q, p, qdot, pdot);          // (9a), (9b): two sweeps, O(bodies)
//
// q: size nq, u and p: size nv, by joint as JointSpec says; SI units. The plan chooses the planar
// or spatial kernel. One object serves one thread. No call allocates unless it returns a matrix or
// a list.
//
// An argument of wrong size throws std::invalid_argument with one sentence. Where an input or a
// result is not finite, calls that return bool return false and failure() names it; other calls
// throw.

#include <momenta/core/kernel/plan.h>
#include <momenta/core/open_chain/centroidal.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

/// Everything in momenta: the libraries core and dae.
namespace momenta {

/// A vector by reference, without a copy: a `VectorXd`, or a contiguous part of one.
using ConstVectorRef = Eigen::Ref<const Eigen::VectorXd>;
/// A writable vector by reference.
using VectorRef = Eigen::Ref<Eigen::VectorXd>;
/// A writable matrix by reference, columns contiguous.
using MatrixRef = Eigen::Ref<Eigen::MatrixXd>;

/// Many states side by side: one row per coordinate, one column per state, rows contiguous.
using StateMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
/// Many states by reference, without a copy.
using ConstStatesRef = Eigen::Ref<const StateMatrix>;
/// Many writable states by reference.
using StatesRef = Eigen::Ref<StateMatrix>;

/// Energies of a whole chain at one state.
struct Energies {
  double kinetic = 0;  ///< T [J]
  /// V [J]; constant joint torques and constant ground-axes forces count as potentials.
  double potential = 0;
  double hamiltonian = 0;  ///< H = p·u − T + V; equals T + V when nothing is driven
};

/// The wrench a joint transmits to its child body, at the joint's origin, in the scene's axes of
/// the child.
struct Reaction {
  std::string joint;       ///< its name in the scene
  Eigen::Vector3d force;   ///< [N]; planar kernel: in the plane only
  Eigen::Vector3d torque;  ///< [N m]; planar kernel: normal to the plane only
};

/// Forward dynamics of an open chain (any tree), with its workspace: one object per thread. Calls
/// that return false have no result; failure() says why.
class OpenChain {
 public:
  /// `level`: x86-64 instruction level of the compiled recursion: 1, 3 (AVX2) or 4 (AVX-512). Else
  /// the next lower one of machine and library; 0: the best. `branches_side_by_side`: the spatial
  /// kernel sweeps subtrees of revolute joints of one shape side by side in vector registers
  /// (kernel/branches/branches.h); results differ by rounding.
  explicit OpenChain(const Scene& scene, Algebra algebra = Algebra::automatic, int level = 0,
                     bool branches_side_by_side = true);
  ~OpenChain();
  /// Movable. A moved-from chain may only be destroyed or assigned to.
  OpenChain(OpenChain&&) noexcept;
  /// Move assignment.
  OpenChain& operator=(OpenChain&&) noexcept;

  /// Bodies in the order of the sweeps, with the places of their joints in q and u.
  const Tree& tree() const;
  /// The plan: what every evaluation computes and leaves out.
  const Plan& plan() const;
  int nq() const { return tree().nq; }  ///< size of q and q̇
  int nv() const { return tree().nv; }  ///< size of u, p and their rates
  /// x86-64 level of the recursions in use.
  int level() const;

  /// q̇ (nq) and ṗ (nv) from (t, q, p): eqs. (35), (45). False when a joint has no inertia: see
  /// failure().
  bool rates(double t, const ConstVectorRef& q, const ConstVectorRef& p, VectorRef qdot,
             VectorRef pdot);
  /// The same with τ (nv), joint forces in addition to those of the scene [N m or N]; τ is added to
  /// ṗ.
  bool rates(double t, const ConstVectorRef& q, const ConstVectorRef& p, const ConstVectorRef& tau,
             VectorRef qdot, VectorRef pdot);
  /// The same for many states at one time t: q (nq × states), p (nv × states). States share vector
  /// registers, a lane each; with forces between points of bodies they are evaluated one by one.
  /// False when a state has no rates: its columns are NaN, all others are right, and failure()
  /// names the first such state. `threads`: threads that share the states; results are the same bit
  /// by bit. They start and end with the call: 8 µs or more and a workspace each. Scenes with user
  /// joints or forces between points use the caller's thread alone. @throws std::invalid_argument
  /// for fewer than one thread.
  bool rates_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& p, StatesRef qdot,
                       StatesRef pdot, int threads = 1);
  /// The same with τ (nv × states), joint forces in addition to those of the scene.
  bool rates_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& p,
                       const ConstStatesRef& tau, StatesRef qdot, StatesRef pdot, int threads = 1);
  /// u̇ of many states at one time, by the acceleration recursion; otherwise as rates_of_states.
  bool accelerations_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& u,
                               StatesRef udot, int threads = 1);
  /// The same with τ (nv × states).
  bool accelerations_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& u,
                               const ConstStatesRef& tau, StatesRef udot, int threads = 1);
  /// M⁻¹ x (nv), without prescribed motion: eqs. (44), (45) without Ω_t. False as for rates().
  bool inverse_mass_times(double t, const ConstVectorRef& q, const ConstVectorRef& x,
                          VectorRef result);
  /// The same at the place of the last rates(), velocities() or inverse_mass_times(): two sweeps
  /// without the cost of M*. Where branches are swept side by side, the first call after rates() or
  /// velocities() takes an evaluation. False also where none of these calls came before, or the
  /// last one returned false.
  bool inverse_mass_times(const ConstVectorRef& x, VectorRef result);
  /// Derivative of (q̇, ṗ) along (δq, δp): one evaluation on dual numbers, at about the cost of two
  /// in doubles. False as for rates().
  bool jacobian_times(double t, const ConstVectorRef& q, const ConstVectorRef& p,
                      const ConstVectorRef& dq, const ConstVectorRef& dp, VectorRef dqdot,
                      VectorRef dpdot);
  /// Writes ∂(q̇, ṗ)/∂(q, p) into J, (nq + nv)², exact to rounding. Each evaluation takes as many
  /// directions as the level has lanes. Where Hamilton's equations hold and all joints are
  /// revolute, only the nq directions of q are differentiated and M⁻¹ gives the rest
  /// (kernel/jacobian_pass.h). False as for rates().
  bool jacobian(double t, const ConstVectorRef& q, const ConstVectorRef& p, MatrixRef J);
  /// The same as a new matrix; empty where rates() would return false.
  Eigen::MatrixXd jacobian(double t, const ConstVectorRef& q, const ConstVectorRef& p);
  /// u (nv) from p: eq. (45). False as for rates().
  bool velocities(double t, const ConstVectorRef& q, const ConstVectorRef& p, VectorRef u);
  /// p (nv) from u: eq. (34), O(bodies).
  void momenta(double t, const ConstVectorRef& q, const ConstVectorRef& u, VectorRef p);
  /// u̇ (nv) from (q, u): the acceleration recursion, O(bodies). False as for rates().
  bool accelerations(double t, const ConstVectorRef& q, const ConstVectorRef& u, VectorRef udot);
  /// The same with τ (nv), joint forces in addition to those of the scene [N m or N].
  bool accelerations(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                     const ConstVectorRef& tau, VectorRef udot);
  /// q̇ (nq) from u (nv).
  void coordinate_rates(const ConstVectorRef& q, const ConstVectorRef& u, VectorRef qdot) const;

  /// T, V and H at (t, q, u), O(bodies).
  Energies energies(double t, const ConstVectorRef& q, const ConstVectorRef& u);
  /// Centroidal quantities from (t, q, p): u by (45), then Σ M Ω, prescribed motion included.
  /// O(bodies). False as for rates().
  bool centroidal(double t, const ConstVectorRef& q, const ConstVectorRef& p, Centroidal& all);
  /// Joint reactions at (t, q, u), with the accelerations from the forward dynamics: eq. (28),
  /// O(bodies).
  std::vector<Reaction> reactions(double t, const ConstVectorRef& q, const ConstVectorRef& u);
  /// M (nv × nv), dense, by the composite-rigid-body method.
  Eigen::MatrixXd mass_matrix(double t, const ConstVectorRef& q);
  /// Pose of every body in ground axes, in the order of the tree.
  std::vector<Eigen::Isometry3d> poses(double t, const ConstVectorRef& q);

  /// One sentence on the last failed call: which joints have no inertia (massless_joints.h), or
  /// which number is not finite. Cost O(nv³) up to 600 rates; beyond that only massless joints with
  /// M_jj = 0 are found.
  std::string failure() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace momenta
