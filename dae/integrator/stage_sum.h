#pragma once
// Linear combinations of stages, Σ_j w_j k_j, with the weights w known to the compiler: zero
// weights cost nothing, and the whole sum of one component stays in a register. This is all the
// arithmetic a Runge-Kutta method has beside f, so it decides its overhead: 2 flops per nonzero
// weight and unknown. The newest stage comes last: what the older ones contribute can run while f
// still computes it.
//
// Stages stand one after another, `stride` doubles apart, a multiple of every register width. The
// packs are the vector extension of GCC and Clang, because loops of this shape are not vectorised
// reliably.

#include <momenta/dae/integrator/aligned_array.h>

#include <array>
#include <cstddef>
#include <utility>

namespace momenta::explicit_rk {

/// Index of the first nonzero weight of a row, or its length.
template <std::size_t N>
constexpr std::size_t first_nonzero(const std::array<double, N>& w) {
  std::size_t j = 0;
  while (j < N && w[j] == 0) ++j;
  return j;
}

/// Doubles in a register of the target; arithmetic on a pack is elementwise. Eight (AVX-512) lose
/// at a dozen unknowns: a load as wide as that waits for all the narrow stores f has just made.
#if defined(__AVX__)
inline constexpr std::size_t width = 4;
#else
inline constexpr std::size_t width = 2;
#endif
typedef double Pack __attribute__((vector_size(width * sizeof(double)), may_alias));

inline Pack load(const double* x) {
  return *reinterpret_cast<const Pack*>(x);
}
inline void store(double* x, Pack v) {
  *reinterpret_cast<Pack*>(x) = v;
}
inline Pack abs(Pack v) {
  return v < 0 ? -v : v;
}
inline Pack max(Pack v, Pack w) {
  return v > w ? v : w;
}

template <const auto& weights, std::size_t row, std::size_t... j>
inline Pack stage_sum_of(const double* k, std::size_t stride, std::index_sequence<j...>) {
  constexpr std::size_t first = first_nonzero(weights[row]);
  Pack sum = weights[row][first] * load(k + first * stride);
  (
      [&] {
        if constexpr (j > first && weights[row][j] != 0)
          sum += weights[row][j] * load(k + j * stride);
      }(),
      ...);
  return sum;
}

/// Σ_j weights[row][j] k_j for one pack of components; k points at them in stage 0.
template <const auto& weights, std::size_t row>
inline Pack stage_sum(const double* k, std::size_t stride) {
  return stage_sum_of<weights, row>(k, stride, std::make_index_sequence<weights[row].size()>{});
}

/// out = y + h Σ_j weights[row][j] k_j, over `size` unknowns, a whole number of cache lines.
template <const auto& weights, std::size_t row>
inline void stage_state(const double* __restrict y, double h, const double* __restrict k,
                        std::size_t size, double* __restrict out) {
  for (std::size_t i = 0; i < size; i += width)
    store(out + i, load(y + i) + h * stage_sum<weights, row>(k + i, size));
}

}  // namespace momenta::explicit_rk
