#pragma once
// How far drives can go: the time at which a prescribed motion asks for what loops cannot follow.
//
// A connected group of loop equations whose Φ_q has full column rank leaves its joints no freedom:
// drives alone move them, q(t) with Φ(q, t) = 0. It is followed by continuation,
//
//   predictor  q + h u,  Φ_q u = −Φ_t,    corrector  q − Φ_q⁺ Φ at t + h,
//
// with steps of at most a tenth of a radian or of the scene's length. At a dead point −Φ_t leaves
// the range of Φ_q, u grows like (t* − t)^(−1/2), and behind it no pose near by closes the loops:
// steps halve down to t*. At a change point or a fork, where the range shrinks but holds Φ_t, poses
// behind it close, and the way goes on. No dynamics enters, so every form and every integrator is
// told the same time.
//
// Groups with freedoms left move as forces say; there the continuation takes the least change, and
// what it finds holds near the state it starts from alone.

#include <momenta/dae/topology/assembly/assembly.h>

#include <string>

namespace momenta {

struct DriveReach {
  double until = 0;        ///< loops were closed up to here [s]
  std::string obstacle;    ///< one sentence: drives, time, loop; empty: none found up to `until`
  bool determined = true;  ///< drives alone move all joints of the loops
  Eigen::VectorXd q;       ///< at `until`; of the start where nothing was followed
};

/// Groups that are followed: those that drives determine, or all.
enum class Followed { determined, all };

/// Follows drives from a closed state to time `end` [s], or as far as 5000 steps go. Cost: two
/// least-norm factorisations of Φ_q a step. Without drives or loops: `end`, at once.
DriveReach drive_reach(const Mechanism& mechanism, double t, const Eigen::VectorXd& q, double end,
                       Followed followed = Followed::determined);

/// The start of the scene at time t: assembled at t = 0, then led along the drives with the least
/// change of what they leave free, to stay on the branch of the start; before t = 0 assembled at
/// once. Rates: the nearest to the scene's. @throws SceneError as assemble(), and where a drive
/// cannot go on before t.
Assembly assemble_at(const Mechanism& mechanism, double t, Assembled what = Assembled::motion);

}  // namespace momenta
