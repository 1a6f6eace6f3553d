#pragma once
// Which loop equations depend on which: at a pose, and at poses nearby on Φ = 0, which tells what
// is redundant wherever the mechanism goes from what is so only here, at a singular pose.
//
// At the pose itself by the verdict of kkt/loop_rank.h, at others by the same singular values.
//
// Nearby poses are reached by steps of a tenth of a radian, along the mechanism's own velocities
// and along random ones that the loops allow, in several walks, each step brought back to Φ = 0.

#include <momenta/dae/form/form.h>
#include <momenta/dae/kkt/loop_rank.h>

#include <string>
#include <vector>

namespace momenta {

/// One row of Φ that follows from others.
struct Dependency {
  int row = 0;
  std::vector<int> on;     ///< rows it follows from, ascending; empty: it says nothing by itself
  bool only_here = false;  ///< not at the poses nearby
};

/// A loop that would tie as much with fewer equations.
struct SimplerLoop {
  std::string loop;
  std::string kind;  ///< empty: none is needed
  int fewer = 0;     ///< equations
};

struct RankReport {
  int rank = 0;
  double kept = 0;      ///< smallest singular value of A that counts
  double dropped = 0;   ///< largest that does not; 0 where all count
  int poses = 0;        ///< tried nearby; 0: the mechanism cannot move
  int rank_nearby = 0;  ///< largest rank there; that of the pose itself without any
  std::vector<Dependency> dependencies;  ///< by row
  std::vector<SimplerLoop> simpler;      ///< changes that together leave nearby ranks as they are
  /// m × dependencies: forces of the loops that move nothing, by column; λ and σ are determined but
  /// for these.
  Eigen::MatrixXd idle;

  bool singular_here() const { return rank < rank_nearby; }
  /// Whether the multiplier of a row is unique.
  bool unique(int row) const;
};

/// At a consistent pose; of its rates only the direction matters. Cost O((n + m)³), for mechanisms
/// of some hundred equations.
RankReport rank_report(const Mechanism& mechanism, const Start& start);

/// "loop 'C' row 3, axis 3 against axis 1"
std::string row_in_words(const Mechanism& mechanism, int row);

/// "loop 'C' row 3, axis 3 against axis 1, follows from loop 'B' rows 1, 2"
std::string in_words(const Mechanism& mechanism, const Dependency& dependency);

}  // namespace momenta
