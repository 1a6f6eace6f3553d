#pragma once
// The points of a Sobol' sequence in base 2.
//
// In dimension j the direction numbers are v_k = m_k / 2ᵏ, m_k odd and below 2ᵏ. With the primitive
// polynomial x^s + a_1 x^(s-1) + … + a_(s-1) x + 1 and m_1 … m_s given,
//
//     m_k = 2 a_1 m_(k-1) ⊕ 4 a_2 m_(k-2) ⊕ … ⊕ 2^(s-1) a_(s-1) m_(k-s+1) ⊕ 2^s m_(k-s) ⊕ m_(k-s),
//
// and coordinate j of point n is the sum ⊕ of those v_k for which bit k of the Gray code n ⊕ n/2 is
// set. The first 2ᵐ points are a (t, m, s)-net: each of the boxes of volume 2^(t-m), with sides cut
// in powers of two, holds 2ᵗ of them.
//
// Sources: I. M. Sobol', USSR Comput. Math. Math. Phys. 7 (1967), 86-112; Gray code: I. A. Antonov,
// V. M. Saleev, ibid. 19 (1979), 252-256; m and a: S. Joe, F. Y. Kuo, SIAM J. Sci. Comput. 30
// (2008), 2635-2654, the set that they call D(6).

#include <array>
#include <cstdint>
#include <vector>

namespace momenta {

class SobolSequence {
 public:
  static constexpr int most_dimensions = 64;

  /// @throws std::invalid_argument unless 1 <= dimensions <= most_dimensions
  explicit SobolSequence(int dimensions);

  /// Coordinate `dimension` of point `number` times 2³². Cost: one ⊕ for each bit of the number.
  std::uint32_t bits(std::uint32_t number, int dimension) const;
  /// v_k times 2³², k from 1 to 32.
  std::uint32_t direction(int dimension, int k) const;

 private:
  std::vector<std::array<std::uint32_t, 32>> directions_;
};

}  // namespace momenta
