#pragma once
// Sobol' indices: which part of the variance of f(x_1, …, x_d), x_i independent, comes from which
// x_i.
//
//     S_i  = V(E(f | x_i)) / V            of x_i alone, first order
//     S_Ti = E(V(f | x_j, j ≠ i)) / V     of x_i and all it does together with others, total
//
// Estimated from f at the rows of A, B and A_B^(i) (sample.h), f less its mean over A and B:
//
//     S_i  ≈ 1/N Σ_j f(B)_j (f(A_B^(i))_j - f(A)_j) / V        (Saltelli et al. 2010)
//     S_Ti ≈ 1/2N Σ_j (f(A)_j - f(A_B^(i))_j)² / V             (Jansen 1999)
//
// with V the variance of f over the rows of A and B. Their errors: the standard deviation of the
// same estimates of samples of N rows drawn from the N with replacement (bootstrap). The bootstrap
// takes the rows as independent, which those of a Latin hypercube or a Sobol' sequence are not:
// their true error is smaller as a rule.
//
// Sources: I. M. Sobol', Math. Comput. Simul. 55 (2001), 271-280; A. Saltelli et al., Comput. Phys.
// Commun. 181 (2010), 259-270; M. J. W. Jansen, ibid. 117 (1999), 35-43; T. Homma, A. Saltelli,
// Reliab. Eng. Syst. Safety 52 (1996), 1-17.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace momenta {

struct SobolIndex {
  double first, first_error, total, total_error;
};

struct SobolIndices {
  std::size_t rows = 0;        ///< rows whose d + 2 values are all finite; others are left out
  double variance;             ///< V
  std::vector<SobolIndex> of;  ///< by quantity; NaN where f is constant or rows < 2
};

/// `f`: values of the N (d + 2) cases in the order of sample.h, not finite for failed ones. Cost: N
/// d times `resamples`. @throws std::invalid_argument for another number of values
SobolIndices sobol_indices(const std::vector<double>& f, std::size_t quantities,
                           std::uint64_t seed = 1, int resamples = 500);

}  // namespace momenta
