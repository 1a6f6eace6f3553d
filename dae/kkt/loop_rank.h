#pragma once
// Redundant loop equations at a pose: one verdict for all that ask. Judged on a matrix
// without units and without masses, for it is a matter of geometry,
//
//   A = D⁻¹ Φ_q C,
//
// D and C the units of equations and rates (loop_units.h): lengths in lengths of the scene, angles
// in
// radians. Turning the axes of a loop, its place in the scene and the order of the loops change no
// singular value. Those above
//
//   rank_tolerance = 1e-7
//
// of the largest count. Where no entry of A reaches 1e-12, no joint moves any loop: all is
// rounding, and nothing counts. Of an exactly redundant equation rounding leaves 10⁻¹⁵, of one
// whose numbers a file has rounded to 10⁻⁸ lengths some 10⁻⁸: both are redundant, and neither
// Newton's steps nor multipliers may be asked of them. At x rad from a singular pose x is left: a
// pose closer than 10⁻⁷ is singular. Joints or loops 10⁷ times smaller than others are out of reach
// of this matrix.
//
// Forces of the loops that move nothing, νᵀΦ_q = 0, are ν = D⁻¹ y with yᵀA = 0: λ and σ are
// determined but for these. Of the y the reduced basis is taken, one dependent row each, the last
// of the scene where there is a choice.
//
// Solvers of (7) fade pivots of Φ_q M⁻¹ Φ_qᵀ from about 3·10⁻⁴ of a singular value down, where
// squares lose their digits (kkt.h): all that is redundant here, and near singular poses more.

#include <momenta/dae/kkt/loop_units.h>

#include <Eigen/Core>
#include <vector>

namespace momenta {

inline constexpr double rank_tolerance = 1e-7;

/// Entries of A in the order of the pattern, at the configuration placed in `e`.
std::vector<double> scaled_entries(const Mechanism& mechanism, Evaluation<double>& e,
                                   const LoopUnits& units);

struct ScaledJacobian {
  Eigen::MatrixXd a;           ///< A, m × nv
  Eigen::VectorXd row_factor;  ///< D⁻¹, m
};
/// A at the configuration placed in `e`. O(m nv)
ScaledJacobian scaled_jacobian(const Mechanism& mechanism, Evaluation<double>& e);

struct RankAndIdle {
  int rank = 0;
  double kept = 0;                  ///< smallest singular value that counts
  double dropped = 0;               ///< largest that does not; 0 where all count
  Eigen::VectorXd singular_values;  ///< descending
  Eigen::MatrixXd left;             ///< null space of Aᵀ, columns
};
/// `largest`: singular value that others are compared with; 0: the largest of `a` itself. `rank`:
/// where it is known. `least`: as of loop_rank(). O((m + nv)³)
RankAndIdle rank_and_idle(const Eigen::MatrixXd& a, double largest = 0, int rank = -1,
                          double least = 0);

/// Reduces the columns of `left`: each has a row of its own where it is 1 and all others are 0.
/// Rows of `first` are taken before others, later ones before earlier. Returns these rows, by
/// column.
std::vector<int> reduce(Eigen::MatrixXd& left, const std::vector<int>& first = {});

struct LoopRank {
  int rank = 0;
  double kept = 0, dropped = 0;     ///< as of RankAndIdle; 0 where singular values are not known
  Eigen::VectorXd singular_values;  ///< singular values of A, descending; empty: not known
  std::vector<int> dependent;       ///< rows that follow from the others, ascending
};
/// Judgement asked for: singular values cost some ten times as much as to see that rows are far
/// from dependent.
enum class Judged { singular_values, dependence };

/// LeastNorm::judge() of A where `e` is placed: by singular values up to 10⁵ numbers of A; beyond,
/// or where dependence alone is asked for and is far away, by pivots of a QR factorisation of Aᵀ,
/// which agree far from the border. Rank 0, no dependent rows, where A is not finite. `least`: part
/// of the largest singular value that others have to exceed, if more than rank_tolerance.
LoopRank loop_rank(const Mechanism& mechanism, Evaluation<double>& e,
                   Judged judged = Judged::singular_values, double least = 0);

/// Forces of the loops (m × n, independent columns) that move nothing at (t, q): Φ_qᵀν = 0. None
/// where the equations are independent. O((m + nv)³)
Eigen::MatrixXd idle_forces(const Mechanism& mechanism, double t, const Eigen::VectorXd& q);

}  // namespace momenta
