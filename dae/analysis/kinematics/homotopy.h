#pragma once
// Follows paths of a homotopy, one after the other.

#include <momenta/dae/analysis/kinematics/polynomial_system.h>
#include <momenta/dae/analysis/kinematics/start_system.h>

#include <Eigen/LU>
#include <cstdint>
#include <utility>
#include <vector>

namespace momenta {

enum class PathEnd { finite, infinite, singular, lost };

class PathFollower {
 public:
  /// Follows t γ G + (1 − t) F; steps are `longest` times as long as possible.
  PathFollower(const PolynomialSystem& f, const StartSystem& g, Complex gamma, double longest)
      : f_(f), g_(g), gamma_(gamma), longest_(longest) {}
  /// End of the path from a solution at t = 1.
  std::pair<PathEnd, Eigen::VectorXcd> follow(Eigen::VectorXcd x);

 private:
  std::vector<double> proper(const Eigen::VectorXcd& x) const;
  PathEnd seems_infinite(const Eigen::VectorXcd& x, double t, const std::vector<double>& kept,
                         double since) const;
  void normalise(Eigen::VectorXcd& x) const;
  void evaluate(const Eigen::VectorXcd& x, double t);
  Eigen::VectorXcd slope(const Eigen::VectorXcd& x, double t);
  bool predict(Eigen::VectorXcd& x, double t, double h);
  bool correct(Eigen::VectorXcd& x, double t);
  double polish(Eigen::VectorXcd& x);

  const PolynomialSystem& f_;
  const StartSystem& g_;
  Complex gamma_;
  double longest_;
  Eigen::VectorXcd of_f_, of_g_, value_, by_t_, patch_;
  Eigen::MatrixXcd slopes_f_, slopes_g_, matrix_;
  Eigen::PartialPivLU<Eigen::MatrixXcd> lu_;
};

// All isolated solutions of polynomial equations F, by paths
//
//   H(x, t) = γ t G(x) + (1 − t) F(x) = 0,    t from 1 to 0.
//
// G has the degrees of F (polynomial_system.h); each equation is a product of linear forms, one
// group of variables each, with random complex coefficients. Its solutions are those of linear
// equations, one for each choice of factors that gives every group as many as its dimension: the
// Bézout number. γ is random on the unit circle. With probability one the paths are smooth on (0,
// 1], and every isolated solution of F is the end of as many as its multiplicity (Morgan, Sommese
// 1987; A. J. Sommese, C. W. Wampler, The Numerical Solution of Systems of Polynomials, 2005, ch.
// 8): the ends not at infinity are all solutions.
//
// In projective coordinates every group has length one and moves across itself, x̄_gᵀ ẋ_g = 0: paths
// to infinity have finite length. Steps: Runge and Kutta's classical method of order 4, then
// Newton's, halved where this takes more than three steps; t falls at most by a constant factor,
// down to t_end. There
//
//   finite       Newton's method on F converges at once, to a regular solution with `proper`
//                variables
//   infinite     |x_proper| falls like a power of t, or is zero at the end of Newton's method
//   singular     neither: a multiple solution, or one of a curve
//   lost         the steps became too small
//
// Two paths meet only by an error: where two have one regular end both are followed again with
// steps a tenth as long.

struct HomotopyEnds {
  std::vector<Eigen::VectorXcd> finite;  ///< each group of length one
  long paths = 0;                        ///< the Bézout number
  long infinite = 0, singular = 0, lost = 0;
  /// Whether every path ended at a known place.
  bool proved() const { return lost == 0 && singular == 0; }
};

/// Cost: some 300 to 3000 solutions of n linear equations a path. `threads` does not change the
/// result.
HomotopyEnds solve_by_homotopy(const PolynomialSystem& system, std::uint64_t seed, int threads);

}  // namespace momenta
