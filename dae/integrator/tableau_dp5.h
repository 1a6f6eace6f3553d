#pragma once
// Dormand and Prince's 5(4) pair: six stages, the seventh is f at the end of the step and serves
// the error estimate and the next step (first same as last).
//
// e = b - b^: the local error is h Σ e_j k_j, of order 4 in the norm.
// d: Shampine's dense output of order 4 in Hairer's form (contd5), the term over the Hermite cubic.
// Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, II.5 (table 5.2),
// II.6; Dormand, Prince, J. Comp. Appl. Math. 6 (1980) 19-26; Shampine, Math. Comp. 46 (1986)
// 135-150.

#include <array>

namespace momenta::explicit_rk {

/// A rational coefficient, divided in extended precision and rounded once more.
constexpr double ratio(long numerator, long denominator) {
  return static_cast<double>(static_cast<long double>(numerator) /
                             static_cast<long double>(denominator));
}

/// Row `stages` of a is b: that stage is f at the end of the step.
struct TableauDp5 {
  static constexpr const char* name = "dp5";
  static constexpr int order = 5;
  static constexpr int stages = 6;
  static constexpr int dense_stages = 0;
  static constexpr int estimates = 1;
  static constexpr int dense_rows = 1;
  static constexpr bool end_derivative_always = true;

  // Step control, the authors' own: factor = safety · err^-(1/5 - 3β/4) · err_old^β, within
  // [shrink, grow].
  static constexpr double exponent = 0.2 - 0.75 * 0.04;
  static constexpr double beta = 0.04;
  static constexpr double safety = 0.9, shrink = 0.2, grow = 10;

  static constexpr std::array<double, 7> c{0, 0.2, 0.3, 0.8, ratio(8, 9), 1, 1};
  static constexpr std::array<std::array<double, 6>, 7> a{{
      {0, 0, 0, 0, 0, 0},
      {0.2, 0, 0, 0, 0, 0},
      {ratio(3, 40), ratio(9, 40), 0, 0, 0, 0},
      {ratio(44, 45), ratio(-56, 15), ratio(32, 9), 0, 0, 0},
      {ratio(19372, 6561), ratio(-25360, 2187), ratio(64448, 6561), ratio(-212, 729), 0, 0},
      {ratio(9017, 3168), ratio(-355, 33), ratio(46732, 5247), ratio(49, 176), ratio(-5103, 18656),
       0},
      {ratio(35, 384), 0, ratio(500, 1113), ratio(125, 192), ratio(-2187, 6784), ratio(11, 84)},
  }};
  static constexpr std::array<std::array<double, 7>, 1> e{{
      {ratio(71, 57600), 0, ratio(-71, 16695), ratio(71, 1920), ratio(-17253, 339200),
       ratio(22, 525), ratio(-1, 40)},
  }};
  static constexpr std::array<std::array<double, 7>, 1> d{{
      {ratio(-12715105075, 11282082432), 0, ratio(87487479700, 32700410799),
       ratio(-10690763975, 1880347072), ratio(701980252875, 199316789632),
       ratio(-1453857185, 822651844), ratio(69997945, 29380423)},
  }};
};

}  // namespace momenta::explicit_rk
