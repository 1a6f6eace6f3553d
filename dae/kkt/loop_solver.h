#pragma once
// The forms' interface to mechanisms with loops: the right-hand sides of (7)-(8) and (3), and
// corrections of positions and velocities in the mass metric.
//
//   sweeps   the loops' impulses are eliminated inside the recursion           (dae/kkt/sweeps)
//   sparse   LDLᵀ of the assembled matrix of (7), or KLU            (sparse_kkt.cpp, klu_kkt.cpp)
//   dense    Cholesky of M, pivoted LDLᵀ of the loops' matrix                  (dense_kkt.cpp)
//
// Weak rows fade towards `centre`, the σ of the step's start: see kkt.h. In a softened solver no
// row fades, all give way to their multiplier instead: second row … = (σ − centre) · compliance.

#include <momenta/dae/kkt/kkt.h>
#include <momenta/dae/kkt/solver_choice.h>

#include <memory>
#include <vector>

namespace momenta {

class LoopSolver {
 public:
  virtual ~LoopSolver() = default;

  /// Lets momentum() solve Φ_q u = −Φ_t − βΦ in the second row of (7), β in 1/s.
  void stabilise(double beta) { beta_ = beta; }
  /// Lets momentum() and acceleration() solve (M + Φ_qᵀ α Φ_q) x = r − Φ_qᵀ(centre − α g) instead
  /// of their two rows, α⁻¹ the compliance (m) by row, alike in a group of rows
  /// (Mechanism::row_groups); multipliers are centre + α(Φ_q x − g). `fade` is ignored.
  virtual void soften(std::vector<double> compliance) = 0;

  /// Sets τ (nv) that momentum() adds to ṗ and acceleration() to the joints' forces; null: none.
  /// Kept by reference. @throws std::logic_error by MaximalSolver
  virtual void push(const double* tau) { pushed_ = tau; }

  /// u (nv) and σ (m) of (7) from p (nv) at (t, q). `centre` (m) null: zero. With `pdot` not null
  /// also ṗ (nv), eq. (8), −κ Φ_qᵀσ included.
  virtual bool momentum(double t, const double* q, const double* p, const double* centre,
                        double fade, double leak, double* u, double* sigma, double* pdot) = 0;
  /// u̇ (nv) and λ (m) of (3) with Φ̈ + 2α Φ̇ + β² Φ = 0.
  virtual bool acceleration(double t, const double* q, const double* u, const double* centre,
                            double alpha, double beta, double* udot, double* lambda) = 0;
  /// u (nv) of M u + Φ_qᵀσ = p, Φ_q u = 0, with nothing prescribed.
  virtual bool free_velocity(double t, const double* q, const double* p, double* u) = 0;
  /// δ (nv) of M δ + Φ_qᵀν = 0, Φ_q δ = −Φ.
  virtual bool position_correction(double t, const double* q, double* delta) = 0;

  long solutions() const { return solutions_; }
  /// Rows of Φ that faded in the last solution: redundant or singular there.
  virtual const std::vector<int>& faded_rows() = 0;
  /// Weakest pivot of the last solution that has not faded, relative to its row's without other
  /// loops, and the number that have faded. KLU alone can't tell.
  struct Pivots {
    double weakest = 1;
    int faded = 0;
  };
  virtual Pivots pivots() const = 0;
  /// Whether a solution depends on those before: KLU keeps its choice of pivots.
  virtual bool remembers() const = 0;
  /// Place in u of the joint at which the last call failed, or −1: a result is not finite.
  int singular_joint() const { return singular_joint_; }

 protected:
  double beta_ = 0;
  const double* pushed_ = nullptr;
  long solutions_ = 0;
  int singular_joint_ = -1;
};

/// The solver of the mechanism's plan; needs loops. `e`: an evaluation of it, used as a workspace.
std::unique_ptr<LoopSolver> make_loop_solver(const Mechanism& mechanism, Evaluation<double>& e);

/// Solves with the mechanism's assembled matrix, dense or sparse.
std::unique_ptr<LoopSolver> make_assembled_solver(const Mechanism& mechanism,
                                                  Evaluation<double>& e);

/// Solves by the sparse block matrix of all bodies' velocities and joints' multipliers
/// (maximal_tree.h), loops by the small matrix they leave. O(bodies) for a tree, O(bodies m² + m³)
/// with m loop equations. `e` as for make_loop_solver.
std::unique_ptr<LoopSolver> make_maximal_solver(const Mechanism& mechanism, Evaluation<double>& e);

/// Solves by the sweeps that carry loops. @pre mechanism.solver().sweeps() exists.
std::unique_ptr<LoopSolver> make_sweep_solver(const Mechanism& mechanism, Evaluation<double>& e);

}  // namespace momenta
