#pragma once
// A consistent start from the scene's guess: positions, then velocities, then accelerations and
// multipliers.

#include <momenta/dae/form/form.h>

#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// A consistent start, and what it took to find it.
struct Assembly {
  Start start;                   ///< positions, rates, accelerations and multipliers
  double position_residual = 0;  ///< |Φ|∞ reached
  double velocity_residual = 0;  ///< |Φ̇|∞ reached
  double moved = 0;    ///< largest change of a joint coordinate against the guess [rad or m]
  int iterations = 0;  ///< of Newton's method on the positions
  int rank = 0;        ///< of Φ_q at the start (kkt/loop_rank.h)
  double kept = 0;     ///< smallest singular value that counts, lengths in lengths of the scene
  double dropped = 0;  ///< and the largest that does not (0: the rows are independent)
  std::vector<int> dependent_rows;  ///< rows of Φ that follow from the others at the start
  int mobility = 0;                 ///< nv − rank
  /// Where redundant equations contradict each other by what a file has rounded, so that no pose
  /// closes their loops: residue_in_words(), or empty.
  std::string residue;
  /// Which of several assemblies this is, where the guess does not decide it at once: one sentence,
  /// or empty.
  std::string branch;
};

/// "loop 'C' stays open by 3e-9 m: its equations and those of 'B' are redundant and differ by that
/// …", of what a start leaves open (m); empty where nothing is.
std::string residue_in_words(const Mechanism& mechanism, const Eigen::VectorXd& phi);

/// What of a start is asked for: `rates` leaves out accelerations and multipliers, which joints
/// without inertia do not have.
enum class Assembled { rates, motion };

/// Damped Gauss-Newton from the scene's positions, joints of `held` unmoved; steps of minimal
/// change, lengths counted in the length of the scene, so that units do not matter; then the rates
/// nearest to the scene's with Φ_q u + Φ_t = 0, held ones kept. |Φ|∞ ≤ 1e-12, points in lengths of
/// the scene, or what rounding leaves on the way from the ground.
///
/// Far from the guess Newton's steps may end in another assembly, the mirror image say. So where
/// they moved a joint by more than 0.1 the gap is also closed continuously, δ' = −(JᵀJ + |Φ|²)⁻¹Jᵀ
/// Φ in steps of at most 0.05; if that ends clearly nearer to the guess it is taken. `branch` says
/// so, or that it got stuck where the equations lose rank, so that the guess does not tell.
/// @throws SceneError naming the loops that stay open and by how much, the held rates that cannot
/// be met, or a loop where no joint can move.
Assembly assemble(const Mechanism& mechanism, Assembled what = Assembled::motion);
/// The same at time t [s], from another guess: q (nq), u (nv).
Assembly assemble(const Mechanism& mechanism, double t, const Eigen::VectorXd& q,
                  const Eigen::VectorXd& u, Assembled what = Assembled::motion);

}  // namespace momenta
