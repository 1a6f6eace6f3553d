#pragma once
// All isolated solutions of polynomial equations F, by paths
//
//   H(x, t) = γ t G(x) + (1 − t) F(x) = 0,    t from 1 to 0.
//
// G has the degrees of F (polynomial_system.h), each equation a product of linear forms, one group
// of variables each, with random complex coefficients: its solutions are those of linear equations,
// one for each choice of factors that gives every group as many as it has dimensions, together the
// Bézout number. γ is random on the unit circle. With probability one the paths are smooth on (0,
// 1], and every isolated solution of F is the end of as many as its multiplicity (Morgan, Sommese
// 1987; A. J. Sommese, C. W. Wampler, The Numerical Solution of Systems of Polynomials, 2005, ch.
// 8): what does not end at infinity is all there is.
//
// In projective coordinates every group has length one and moves across itself, x̄_gᵀ ẋ_g = 0: a
// patch anew at every step, so that paths to infinity are of finite length. Steps: the classical
// method of Runge and Kutta of order 4, and Newton's, halved where Newton's take more than three; t
// falls by a constant factor at the most, down to t_end. There
//
//   finite       Newton's method on F converges at once, to a regular solution with `proper`
//                variables
//   infinite     |x_proper| falls like a power of t, or is zero at the end of Newton's method
//   singular     neither: a multiple solution, or one of a curve
//   lost         the steps became too small
//
// Two paths never meet but by an error: where two have one regular end both are followed again with
// steps a tenth as long.

#include <momenta/dae/kinematics/polynomial_system.h>

#include <cstdint>

namespace momenta {

struct HomotopyEnds {
  std::vector<Eigen::VectorXcd> finite;  ///< each group of length one
  long paths = 0;                        ///< the Bézout number
  long infinite = 0, singular = 0, lost = 0;
  /// Whether every path was followed to an end that is told, the regular ones apart.
  bool proved() const { return lost == 0 && singular == 0; }
};

/// Cost: some 300 to 3000 solutions of n linear equations a path. `threads` and their order have no
/// effect on what is found.
HomotopyEnds solve_by_homotopy(const PolynomialSystem& system, std::uint64_t seed, int threads);

}  // namespace momenta
