#pragma once
// The face of `dae` for users with integrators, controllers or optimisers of their own: a mechanism
// with closed loops and its dynamics, as OpenChain is for trees.
//
//   ClosedChain chain(read_scene("four_bar.toml"));
//   const Assembly a = chain.assemble();          // loops closed: a.start.q, a.start.u
//   chain.momenta(0, a.start.q, a.start.u, p);
//   chain.rates(0, q, p, qdot, pdot);             // (7)-(8)
//
//   ( M   Φ_qᵀ ) ( u )   ( p )
//   ( Φ_q   0  ) ( σ ) = (−Φ_t),        ṗ = L_q + Q + τ + Φ̇_qᵀ σ − κ Φ_qᵀ σ                (7), (8)
//
//   M u̇ + Φ_qᵀ λ = Q + τ − bias,  Φ̈ = 0                                                    (3)
//
// q: size nq, u and p: size nv, σ and λ: size m, by joint and row as the scene has them; τ: size
// nv, forces of joints beside the scene's own [N m or N]; SI units. Scenes without loops are taken
// too, with m = 0. p includes what the loops transmitted, Φ_qᵀ σ; momenta() gives the p of σ = 0.
// Where loop equations are redundant or nearly so, their σ and λ are least in norm of what is left.
//
// One object serves one thread: it owns the workspace. No call allocates unless it returns
// something, or works on many states. Arguments of wrong size are thrown, std::invalid_argument
// with one sentence. Where a number given or found is not finite, calls that return bool are false
// and failure() says which, outputs are not to be used then; other calls throw.

#include <momenta/core/open_chain.h>
#include <momenta/dae/assembly/assembly.h>
#include <momenta/dae/measure/reactions.h>

#include <memory>
#include <string>

namespace momenta {

/// A mechanism with closed loops, and its dynamics at one state.
class ClosedChain {
 public:
  /// @throws SceneError
  explicit ClosedChain(const Scene& scene, MechanismOptions options = {});
  ~ClosedChain();
  /// What was moved from is not to be used.
  ClosedChain(ClosedChain&&) noexcept;
  /// Likewise.
  ClosedChain& operator=(ClosedChain&&) noexcept;

  /// What forms, runs and studies take: lives as long as this object, wherever it is moved.
  const Mechanism& mechanism() const;
  int nq() const { return mechanism().nq(); }  ///< coordinates
  int nv() const { return mechanism().nv(); }  ///< rates, momenta
  int m() const { return mechanism().m(); }    ///< loop equations

  /// A consistent start from the scene's positions and rates. @throws SceneError: assemble()
  Assembly assemble() const;

  /// q̇ (nq) and ṗ (nv) from (t, q, p): (7), (8). κ = `leak` [1/s] keeps σ bounded over long
  /// times, 0: none. O(bodies) where the sweeps carry the loops. False where a joint has no inertia
  /// or the loops no solution.
  bool rates(double t, const ConstVectorRef& q, const ConstVectorRef& p, VectorRef qdot,
             VectorRef pdot, double leak = 0);
  /// The same with τ.
  bool rates(double t, const ConstVectorRef& q, const ConstVectorRef& p, const ConstVectorRef& tau,
             VectorRef qdot, VectorRef pdot, double leak = 0);
  /// The same for many states at one time: q (nq × states), p (nv × states), one column a state;
  /// side by side in vector registers where the sweeps carry the loops and no forces act between
  /// points of bodies. `threads`: how many share the states, each with sweeps of its own. False
  /// where a state has no rates: its columns are NaN, those of all others are right. Allocates.
  /// @throws std::invalid_argument for less than one thread
  bool rates_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& p, StatesRef qdot,
                       StatesRef pdot, double leak = 0, int threads = 1);
  /// u (nv) and the loops' impulses σ (m) from p: (7). False as rates().
  bool velocities(double t, const ConstVectorRef& q, const ConstVectorRef& p, VectorRef u,
                  VectorRef sigma);
  /// p (nv) of u with σ = 0: M u and what drives prescribe. O(bodies).
  void momenta(double t, const ConstVectorRef& q, const ConstVectorRef& u, VectorRef p);

  /// u̇ (nv) and the loops' forces λ (m) from (t, q, u): (3). False as rates().
  bool accelerations(double t, const ConstVectorRef& q, const ConstVectorRef& u, VectorRef udot,
                     VectorRef lambda);
  /// The same with τ.
  bool accelerations(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                     const ConstVectorRef& tau, VectorRef udot, VectorRef lambda);
  /// Inverse dynamics: τ (nv) that makes (q, u) accelerate by u̇ while the loops push with λ,
  /// M u̇ + bias − Q + Φ_qᵀ λ. O(bodies + loops). Which joints push and which loops do is the
  /// caller's choice: τ + Φ_qᵀ μ with λ − μ is the same motion for any μ.
  void joint_forces(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                    const ConstVectorRef& udot, const ConstVectorRef& lambda, VectorRef tau);

  /// Φ (m) and Φ̇ (m): position drift [m, rad] and velocity drift [m/s, rad/s], row by row.
  void constraints(double t, const ConstVectorRef& q, const ConstVectorRef& u, VectorRef phi,
                   VectorRef phidot);
  /// Moves q to Φ = 0 by steps of least kinetic norm, Φ_q δ = −Φ, and u to the nearest rates in
  /// that norm with Φ_q u + Φ_t = 0. False where q is too far off to get there, or as rates().
  bool correct(double t, VectorRef q, VectorRef u);
  /// Φ_q, m × nv, dense.
  Eigen::MatrixXd jacobian(double t, const ConstVectorRef& q);
  /// M, nv × nv, dense.
  Eigen::MatrixXd mass_matrix(double t, const ConstVectorRef& q);

  /// T, V and H = (M u + what drives prescribe)·u − T + V [J].
  Energies energies(double t, const ConstVectorRef& q, const ConstVectorRef& u);
  /// What joints and loops transmit at (t, q, u) with the accelerations and forces of (3).
  /// @throws std::runtime_error with failure() where these are not to be had
  Reactions reactions(double t, const ConstVectorRef& q, const ConstVectorRef& u);
  /// q̇ (nq) from u (nv).
  void coordinate_rates(double t, const ConstVectorRef& q, const ConstVectorRef& u, VectorRef qdot);

  /// One sentence on the last call that returned false.
  const std::string& failure() const;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace momenta
