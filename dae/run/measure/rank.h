#pragma once
// Dependent loop equations, at a pose and at poses nearby on Φ = 0: some are redundant everywhere,
// some only here, at a singular pose.
//
// The verdict at the pose itself is that of kkt/loop_rank.h, at others by the same singular values.
//
// Walks of several steps of a tenth of a radian reach nearby poses, along the mechanism's own
// velocities and along random ones that loops allow, each step brought back to Φ = 0.

#include <momenta/dae/kkt/loop_rank.h>
#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/mechanism/start.h>

#include <string>
#include <vector>

namespace momenta {

/// A row of Φ that follows from others.
struct Dependency {
  int row = 0;
  std::vector<int> on;     ///< rows it follows from, ascending; empty: it demands nothing
  bool only_here = false;  ///< independent at the poses nearby
};

/// A loop that could do with fewer equations.
struct SimplerLoop {
  std::string loop;
  std::string kind;  ///< empty: no loop is needed
  int fewer = 0;     ///< equations saved
};

struct RankReport {
  int rank = 0;
  double kept = 0;                       ///< smallest singular value of A that counts
  double dropped = 0;                    ///< largest that does not count; 0: all count
  int poses = 0;                         ///< tried nearby; 0: the mechanism cannot move
  int rank_nearby = 0;                   ///< largest nearby; without poses that of the pose itself
  std::vector<Dependency> dependencies;  ///< by row
  std::vector<SimplerLoop> simpler;      ///< changes that together keep the ranks nearby
  /// Forces of loops that move nothing, m × dependencies; λ and σ are determined but for these.
  Eigen::MatrixXd idle;
  Eigen::VectorXd units;  ///< of the rows (m), LoopUnits::equations

  bool singular_here() const { return rank < rank_nearby; }
  /// Whether a row's multiplier is unique.
  bool unique(int row) const;
};

/// Report at a consistent pose; only the direction of rates matters. Cost O((n + m)³), for some
/// hundred equations.
RankReport rank_report(const Mechanism& mechanism, const Start& start);

/// "loop 'C' row 3, axis 3 against axis 1"
std::string row_in_words(const Mechanism& mechanism, int row);

/// "loop 'C' row 3, axis 3 against axis 1, follows from loop 'B' rows 1, 2"
std::string in_words(const Mechanism& mechanism, const Dependency& dependency);

}  // namespace momenta
