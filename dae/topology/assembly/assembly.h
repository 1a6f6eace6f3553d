#pragma once
// A consistent start from the scene's guess: positions, then velocities, then accelerations and
// multipliers.

#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/mechanism/start.h>

#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// A consistent start, and how it was found.
struct Assembly {
  Start start;                   ///< positions, rates, accelerations and multipliers
  double position_residual = 0;  ///< |Φ|∞ reached
  double velocity_residual = 0;  ///< |Φ̇|∞ reached
  double moved = 0;    ///< largest change of a joint coordinate against the guess [rad or m]
  int iterations = 0;  ///< Newton's method on the positions
  int rank = 0;        ///< rank of Φ_q at the start (kkt/loop_rank.h)
  /// Smallest singular value of Φ_q that counts, lengths in lengths of the scene; 0: not known, as
  /// where no row is near to following from the others.
  double kept = 0;
  double dropped = 0;  ///< largest singular value that does not count; 0: the rows are independent
  std::vector<int> dependent_rows;  ///< rows of Φ that follow from the others at the start
  int mobility = 0;                 ///< nv − rank: number of free rates
  /// Number of free coordinates: nv less the rank of the holonomic rows.
  int free_positions = 0;
  /// The sentence of residue_in_words() where redundant equations contradict each other because a
  /// file has rounded numbers, so that no pose closes their loops; else empty.
  std::string residue;
  /// One sentence on which of several assemblies this is, where the guess alone does not decide;
  /// else empty.
  std::string branch;
};

/// One sentence on the residue `phi` (m) of a start, "loop 'C' stays open by 3e-9 m: its equations
/// and those of 'B' are redundant and differ by that …"; empty where there is none.
std::string residue_in_words(const Mechanism& mechanism, const Eigen::VectorXd& phi);

/// How much of a start is computed. `rates` leaves out accelerations and multipliers, which do not
/// exist where joints have no inertia; `motion` has them.
enum class Assembled { rates, motion };

/// Finds a consistent start. Positions: damped Gauss-Newton from the scene's positions, joints of
/// `held` fixed, by steps of minimal change, lengths in lengths of the scene. It ends at |Φ|∞ ≤
/// 1e-12, points in lengths of the scene, or at the rounding along the way from the ground. Rates:
/// the nearest to the scene's with Φ_q u + Φ_t = 0, rates of held joints kept.
///
/// Newton's steps may end in another assembly, for example the mirror image. So where they moved a
/// joint by more than 0.1, the gap is also closed continuously, δ' = −(JᵀJ + |Φ|²)⁻¹Jᵀ Φ in steps
/// of at most 0.05; if that ends clearly nearer to the guess, its result is taken. `branch` says
/// so, or that the continuous way got stuck where the equations lose rank, so that the guess does
/// not decide. @throws SceneError naming the loops that stay open and by how much, the held rates
/// that cannot be met, or a loop where no joint can move.
Assembly assemble(const Mechanism& mechanism, Assembled what = Assembled::motion);
/// Assembly at time t [s] from another guess: q (nq), u (nv).
Assembly assemble(const Mechanism& mechanism, double t, const Eigen::VectorXd& q,
                  const Eigen::VectorXd& u, Assembled what = Assembled::motion);

}  // namespace momenta
