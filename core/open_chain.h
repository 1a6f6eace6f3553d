#pragma once
// The face of `core`: an open chain (any tree) and its forward dynamics on canonical momenta.
//
//     OpenChain chain(read_scene("pendulum.toml"));
//     chain.rates(t, q, p, qdot, pdot);          // (9a), (9b): two sweeps, O(bodies)
//
// q: size nq, u and p: size nv, by joint as JointSpec says; SI units. The kernel, planar or
// spatial, is chosen by the plan. One object serves one thread: it owns the workspace. No call
// allocates unless it returns a matrix or a list.
//
// Arguments of wrong size are thrown, std::invalid_argument with one sentence. Where a number given
// or found is not finite, calls that return bool are false and failure() says which; others throw.

#include <momenta/core/centroidal.h>
#include <momenta/core/plan.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

/// Both libraries, core and dae.
namespace momenta {

/// Vectors by reference, without a copy: a `VectorXd`, or a contiguous part of one.
using ConstVectorRef = Eigen::Ref<const Eigen::VectorXd>;
/// The same, to be written to.
using VectorRef = Eigen::Ref<Eigen::VectorXd>;
/// A matrix to be written to, columns contiguous.
using MatrixRef = Eigen::Ref<Eigen::MatrixXd>;

/// Many states side by side: one row a coordinate, one column a state, rows contiguous.
using StateMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
/// Many states by reference, without a copy.
using ConstStatesRef = Eigen::Ref<const StateMatrix>;
/// The same, to be written to.
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
  Eigen::Vector3d force;   ///< [N]; of planar kernels in the plane
  Eigen::Vector3d torque;  ///< [N m]; of planar kernels across the plane
};

/// Forward dynamics of an open chain (any tree), with its workspace: one object a thread.
/// Where a call returns bool, false means that there is no result; failure() then says why.
class OpenChain {
 public:
  /// `level`: x86-64 level of the compiled recursion, 1, 3 (AVX2) or 4 (AVX-512), or what is next
  /// below it of those machine and library have; 0 takes the best. `branches_side_by_side`: in
  /// space, subtrees of revolute joints of one shape share vector registers
  /// (kernel/branches/branches.h); results differ by rounding.
  explicit OpenChain(const Scene& scene, Algebra algebra = Algebra::automatic, int level = 0,
                     bool branches_side_by_side = true);
  ~OpenChain();
  /// Chains move; the one moved from may only be destroyed or assigned to.
  OpenChain(OpenChain&&) noexcept;
  /// As the constructor.
  OpenChain& operator=(OpenChain&&) noexcept;

  /// Bodies in the order of the sweeps, with the places of their joints in q and u.
  const Tree& tree() const;
  /// What every evaluation does and leaves out.
  const Plan& plan() const;
  int nq() const { return tree().nq; }  ///< size of q and q̇
  int nv() const { return tree().nv; }  ///< size of u, p and their rates
  /// x86-64 level of the recursions in use.
  int level() const;

  /// q̇ (nq) and ṗ (nv) from (t, q, p): eqs. (35), (45). False when a joint has no inertia to move:
  /// see failure().
  bool rates(double t, const ConstVectorRef& q, const ConstVectorRef& p, VectorRef qdot,
             VectorRef pdot);
  /// The same with τ (nv), forces of joints beside the scene's own [N m or N]: ṗ + τ.
  bool rates(double t, const ConstVectorRef& q, const ConstVectorRef& p, const ConstVectorRef& tau,
             VectorRef qdot, VectorRef pdot);
  /// The same for many states at one time t: q (nq × states), p (nv × states), side by side in the
  /// lanes of vector registers. Where forces act between points of bodies, state by state. False
  /// when a state has no rates: its columns are NaN, those of all others are right; failure() names
  /// the first. `threads`: how many share the states, each with a workspace of its own, for the
  /// same results bit by bit. They start and end with the call, which takes 8 µs or more each, and
  /// memory. User joints and forces between points of bodies keep to the caller's thread.
  /// @throws std::invalid_argument for less than one thread.
  bool rates_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& p, StatesRef qdot,
                       StatesRef pdot, int threads = 1);
  /// u̇ of many states at one time: as rates_of_states, by the acceleration recursion.
  bool accelerations_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& u,
                               StatesRef udot, int threads = 1);
  /// M⁻¹ x (nv), prescribed motion left out: eqs. (44), (45) without Ω_t. False as rates().
  bool inverse_mass_times(double t, const ConstVectorRef& q, const ConstVectorRef& x,
                          VectorRef result);
  /// Derivative of (q̇, ṗ) along (δq, δp): one evaluation on dual numbers, about the cost of two
  /// plain ones. False as rates().
  bool jacobian_times(double t, const ConstVectorRef& q, const ConstVectorRef& p,
                      const ConstVectorRef& dq, const ConstVectorRef& dp, VectorRef dqdot,
                      VectorRef dpdot);
  /// ∂(q̇, ṗ)/∂(q, p) into J, (nq + nv)², exact to rounding: as many directions side by side as the
  /// level has lanes; made of M⁻¹ and half the derivatives where Hamilton's equations hold on
  /// revolute joints. False as rates().
  bool jacobian(double t, const ConstVectorRef& q, const ConstVectorRef& p, MatrixRef J);
  /// The same as a new matrix, empty where rates() would be false.
  Eigen::MatrixXd jacobian(double t, const ConstVectorRef& q, const ConstVectorRef& p);
  /// u (nv) from p: eq. (45). False as rates().
  bool velocities(double t, const ConstVectorRef& q, const ConstVectorRef& p, VectorRef u);
  /// p (nv) from u: eq. (34), O(bodies).
  void momenta(double t, const ConstVectorRef& q, const ConstVectorRef& u, VectorRef p);
  /// u̇ (nv) from (q, u): the acceleration recursion, O(bodies). False as rates().
  bool accelerations(double t, const ConstVectorRef& q, const ConstVectorRef& u, VectorRef udot);
  /// The same with τ (nv), forces of joints beside the scene's own [N m or N].
  bool accelerations(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                     const ConstVectorRef& tau, VectorRef udot);
  /// q̇ (nq) from u (nv).
  void coordinate_rates(const ConstVectorRef& q, const ConstVectorRef& u, VectorRef qdot) const;

  /// T, V and H at (t, q, u), O(bodies).
  Energies energies(double t, const ConstVectorRef& q, const ConstVectorRef& u);
  /// Mass, centre of mass, linear and angular momentum of all bodies together, ground axes, from
  /// (t, q, p): u of (45), then Σ M Ω with what drives prescribe. O(bodies). False as rates().
  bool centroidal(double t, const ConstVectorRef& q, const ConstVectorRef& p, Centroidal& all);
  /// Joint reactions at (t, q, u) with the accelerations the dynamics gives: eq. (28), O(bodies).
  std::vector<Reaction> reactions(double t, const ConstVectorRef& q, const ConstVectorRef& u);
  /// M (nv × nv), dense, by composite inertias.
  Eigen::MatrixXd mass_matrix(double t, const ConstVectorRef& q);
  /// Pose of every body of the tree in ground axes, in the tree's order.
  std::vector<Eigen::Isometry3d> poses(double t, const ConstVectorRef& q);

  /// One sentence on the last failed call: which joints have no inertia (massless_joints.h), or
  /// what is not finite. O(nv³) up to 600 rates.
  std::string failure() const;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace momenta
