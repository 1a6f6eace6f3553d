#pragma once
// The classical Runge-Kutta method of order 4 (Kutta 1901): four stages, no error estimate.
//
//   0   |
//   1/2 | 1/2
//   1/2 | 0    1/2
//   1   | 0    0    1
//   ----+--------------------
//       | 1/6  1/3  1/3  1/6
//
// Dense output: the cubic Hermite polynomial on both ends' values and derivatives, of order 3.
// Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, II.1 (table 1.2),
// II.6.

#include <array>

namespace momenta::explicit_rk {

/// Row `stages` of a is b: that stage is f at the end of the step, whoever needs it.
struct TableauRk4 {
  static constexpr const char* name = "rk4";
  static constexpr int order = 4;
  static constexpr int stages = 4;  ///< needed for the end value
  static constexpr int dense_stages =
      0;                                ///< further ones after the end derivative, for dense output
  static constexpr int estimates = 0;   ///< rows of e
  static constexpr int dense_rows = 0;  ///< rows of d
  static constexpr bool end_derivative_always = false;

  static constexpr std::array<double, 5> c{0, 0.5, 0.5, 1, 1};
  static constexpr std::array<std::array<double, 4>, 5> a{{
      {0, 0, 0, 0},
      {0.5, 0, 0, 0},
      {0, 0.5, 0, 0},
      {0, 0, 1, 0},
      {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6},
  }};
  static constexpr std::array<std::array<double, 5>, 0> e{};
  static constexpr std::array<std::array<double, 5>, 0> d{};
};

}  // namespace momenta::explicit_rk
