#pragma once
// Islands: rates that share loop equations, and these equations. In units of the scene, δ = C⁻¹ u,
// each island has
//
//   J = D⁻¹ Φ_q C,      Jᵀ P = ( Y  N ) ( R₁₁ R₁₂ ; 0 0 )      QR with pivots P, rank r
//
//   J N = 0:  N, orthonormal, the motions that the loops leave,
//   J δ = b:  δ = Y R₁₁⁻ᵀ (Pᵀ b)₁ + N z,  by the r rows that are independent,
//   Jᵀλ = f:  λ = P (R₁₁⁻¹ Yᵀ f; 0),      λ of the rows that follow from others zero.
//
// A rate in no equation is an island of itself with N = 1, so that a tree costs O(bodies).

#include <momenta/dae/topology/assembly/scaled_loops.h>

#include <Eigen/QR>
#include <vector>

namespace momenta {

/// Relative pivot or singular value that counts.
inline constexpr double independent_pivot = 1e-9;

struct LoopIsland {
  std::vector<int> rates, rows;  ///< places in u and Φ, ascending
  Eigen::MatrixXd Y, N;          ///< bases of the last factor()
  Eigen::MatrixXd R;             ///< (R₁₁ R₁₂)
  Eigen::VectorXi order;         ///< P: places among `rows`, independent ones first
  int rank() const { return static_cast<int>(Y.cols()); }
  int freedoms() const { return static_cast<int>(N.cols()); }

  /// δ of least norm with J δ = b; b by `rows`.
  Eigen::VectorXd particular(const Eigen::VectorXd& b) const;
  /// λ with Jᵀλ = f, or nearest; f by `rates`.
  Eigen::VectorXd multipliers(const Eigen::VectorXd& f) const;
  /// Independent ν with Jᵀν = 0, as many as dependent rows.
  Eigen::MatrixXd idle() const;
  /// Entries at `places`, which are `rates` or `rows`.
  static Eigen::VectorXd part(const std::vector<int>& places, const Eigen::VectorXd& all);
  static void put(const std::vector<int>& places, const Eigen::VectorXd& part,
                  Eigen::VectorXd& all);
};

class LoopIslands {
 public:
  /// The mechanism must outlive it. O(bodies + length of all loops)
  explicit LoopIslands(const Mechanism& mechanism);

  /// J, Y, N and R at the last pose of `loops`; pivots above this part of the largest count, with
  /// `rank_kept` no more of an island than at the last factor(). Cost: a dense QR of each island.
  void factor(ScaledLoops& loops, double pivot = independent_pivot, bool rank_kept = false);

  const std::vector<LoopIsland>& all() const { return islands_; }
  const LoopIsland& of(int rate) const {
    return islands_[static_cast<std::size_t>(island_[static_cast<std::size_t>(rate)])];
  }

 private:
  std::vector<LoopIsland> islands_;
  std::vector<int> island_, column_, row_;  ///< by rate: island, place there; by row: place there
  std::vector<int> of_entry_;               ///< by entry of Φ_q: island
};

}  // namespace momenta
