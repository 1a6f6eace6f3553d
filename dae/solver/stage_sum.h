#pragma once
// Linear combinations of stages, Σ_j w_j k_j, with the weights w known to the compiler: zero
// weights cost nothing, and the whole sum of one component stays in a register. This is all the
// arithmetic a Runge-Kutta method has beside f, so it decides its overhead: 2 flops per nonzero
// weight and unknown.
//
// Stages stand one after another, `stride` doubles apart. `block` starts a cache line of unknowns;
// the constant inner trip count lets the compiler vectorise without a remainder loop.

#include <momenta/dae/solver/aligned_array.h>

#include <array>
#include <cstddef>
#include <utility>

namespace momenta {

/// Index of the first nonzero weight of a row, or its length.
template <std::size_t N>
constexpr std::size_t first_nonzero(const std::array<double, N>& w) {
  std::size_t j = 0;
  while (j < N && w[j] == 0) ++j;
  return j;
}

template <const auto& weights, std::size_t row, std::size_t... j>
inline double stage_sum_of(const double* k, std::size_t stride, std::index_sequence<j...>) {
  constexpr std::size_t first = first_nonzero(weights[row]);
  double sum = weights[row][first] * k[first * stride];
  (
      [&] {
        if constexpr (j > first && weights[row][j] != 0) sum += weights[row][j] * k[j * stride];
      }(),
      ...);
  return sum;
}

/// Σ_j weights[row][j] k_j for one component; k points at that component of stage 0.
template <const auto& weights, std::size_t row>
inline double stage_sum(const double* k, std::size_t stride) {
  return stage_sum_of<weights, row>(k, stride, std::make_index_sequence<weights[row].size()>{});
}

/// out = y + h Σ_j weights[row][j] k_j, over `size` unknowns, a multiple of `lanes`.
template <const auto& weights, std::size_t row>
inline void stage_state(const double* __restrict y, double h, const double* __restrict k,
                        std::size_t size, double* __restrict out) {
  for (std::size_t block = 0; block < size; block += lanes)
    for (std::size_t i = block; i < block + lanes; ++i)
      out[i] = y[i] + h * stage_sum<weights, row>(k + i, size);
}

}  // namespace momenta
