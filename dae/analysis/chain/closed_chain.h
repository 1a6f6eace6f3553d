#pragma once
// A mechanism with closed loops and its dynamics at one state, for programs with their own
// integrators, controllers or optimisers; what OpenChain is for trees.
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
// q: size nq, u and p: size nv, in the order of the joints; σ and λ: size m, in the order of the
// loop equations; τ: size nv, joint forces in addition to those of the scene [N m or N]; SI units.
// A scene may have no loops; then m = 0. It may be a Lagrangian, with constraints for loops. p
// includes Φ_qᵀ σ, the impulses of the loops; momenta() gives the p with σ = 0. Where loop
// equations are redundant or nearly so, σ and λ are not unique; the weak directions fade
// (dae/kkt/kkt.h).
//
// One object serves one thread: it owns the workspace. No call allocates unless it returns an
// object or works on many states. An argument of wrong size throws std::invalid_argument with one
// sentence. Where an input or a result is not finite, calls that return bool return false,
// failure() names it, and the outputs must not be used; other calls throw.

#include <momenta/core/open_chain/open_chain.h>
#include <momenta/dae/run/measure/reactions.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <memory>
#include <string>

namespace momenta {

/// A mechanism with closed loops, and its dynamics at one state.
class ClosedChain {
 public:
  /// @throws SceneError
  explicit ClosedChain(const Scene& scene, MechanismOptions options = {});
  ~ClosedChain();
  /// Movable. A moved-from object must not be used.
  ClosedChain(ClosedChain&&) noexcept;
  /// As the move constructor.
  ClosedChain& operator=(ClosedChain&&) noexcept;

  /// The mechanism, which forms, runs and studies take. It lives as long as this object, also when
  /// the object is moved.
  const Mechanism& mechanism() const;
  int nq() const { return mechanism().nq(); }  ///< coordinates
  int nv() const { return mechanism().nv(); }  ///< rates, momenta
  int m() const { return mechanism().m(); }    ///< loop equations

  /// A consistent start from the scene's positions and rates. @throws SceneError as assemble().
  Assembly assemble() const;

  /// q̇ (nq) and ṗ (nv) from (t, q, p): (7), (8). κ = `leak` [1/s] keeps σ bounded over long times;
  /// 0: no leak. O(bodies) where the sweeps carry the loops. False where a joint has no inertia, or
  /// where (7) has no solution.
  bool rates(double t, const ConstVectorRef& q, const ConstVectorRef& p, VectorRef qdot,
             VectorRef pdot, double leak = 0);
  /// The same with τ.
  bool rates(double t, const ConstVectorRef& q, const ConstVectorRef& p, const ConstVectorRef& tau,
             VectorRef qdot, VectorRef pdot, double leak = 0);
  /// The same for many states at one time: q (nq × states), p (nv × states), one column per state.
  /// States are side by side in vector registers where the sweeps carry the loops (in space without
  /// forces between points of bodies), else one by one. `threads` share the states, each with its
  /// own sweeps. False where a state has no rates: its columns are NaN, those of all others are
  /// right. Allocates. @throws std::invalid_argument for fewer than one thread
  bool rates_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& p, StatesRef qdot,
                       StatesRef pdot, double leak = 0, int threads = 1);
  /// The same with τ (nv × states).
  bool rates_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& p,
                       const ConstStatesRef& tau, StatesRef qdot, StatesRef pdot, double leak = 0,
                       int threads = 1);
  /// u (nv) and the impulse multipliers σ (m) from p: (7). False as for rates().
  bool velocities(double t, const ConstVectorRef& q, const ConstVectorRef& p, VectorRef u,
                  VectorRef sigma);
  /// p (nv) of u with σ = 0: M u plus the part of prescribed motion. O(bodies).
  void momenta(double t, const ConstVectorRef& q, const ConstVectorRef& u, VectorRef p);

  /// u̇ (nv) and the force multipliers λ (m) from (t, q, u): (3). False as for rates().
  bool accelerations(double t, const ConstVectorRef& q, const ConstVectorRef& u, VectorRef udot,
                     VectorRef lambda);
  /// The same with τ.
  bool accelerations(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                     const ConstVectorRef& tau, VectorRef udot, VectorRef lambda);
  /// The same for many states at one time, as rates_of_states: u̇ (nv × states), λ (m × states).
  bool accelerations_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& u,
                               StatesRef udot, StatesRef lambda, int threads = 1);
  /// The same with τ (nv × states).
  bool accelerations_of_states(double t, const ConstStatesRef& q, const ConstStatesRef& u,
                               const ConstStatesRef& tau, StatesRef udot, StatesRef lambda,
                               int threads = 1);
  /// Inverse dynamics: joint forces τ (nv) that give accelerations u̇ at (q, u) when the loops have
  /// the multipliers λ: τ = M u̇ + bias − Q + Φ_qᵀ λ. O(bodies + loops). The caller chooses how
  /// joints and loops share the load: τ + Φ_qᵀ μ with λ + μ is the same motion.
  void joint_forces(double t, const ConstVectorRef& q, const ConstVectorRef& u,
                    const ConstVectorRef& udot, const ConstVectorRef& lambda, VectorRef tau);

  /// Φ (m) and Φ̇ (m): position drift [m, rad] and velocity drift [m/s, rad/s] of each loop
  /// equation.
  void constraints(double t, const ConstVectorRef& q, const ConstVectorRef& u, VectorRef phi,
                   VectorRef phidot);
  /// Projects q and u onto the constraints: q to Φ = 0 by Newton steps Φ_q δ = −Φ of least norm in
  /// the mass metric, u to the nearest rates in that metric with Φ_q u + Φ_t = 0. False where q is
  /// too far for the steps to converge, or as for rates().
  bool correct(double t, VectorRef q, VectorRef u);
  /// Φ_q, m × nv, dense.
  Eigen::MatrixXd jacobian(double t, const ConstVectorRef& q);
  /// M, nv × nv, dense.
  Eigen::MatrixXd mass_matrix(double t, const ConstVectorRef& q);

  /// T, V and H = p·u − T + V [J], with p of momenta().
  Energies energies(double t, const ConstVectorRef& q, const ConstVectorRef& u);
  /// The wrenches that joints and loops transmit at (t, q, u), with u̇ and λ of (3). @throws
  /// std::runtime_error with failure() where (3) has no solution
  Reactions reactions(double t, const ConstVectorRef& q, const ConstVectorRef& u);
  /// q̇ (nq) from u (nv).
  void coordinate_rates(double t, const ConstVectorRef& q, const ConstVectorRef& u, VectorRef qdot);

  /// One sentence on the last call that returned false.
  const std::string& failure() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace momenta
