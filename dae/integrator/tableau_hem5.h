#pragma once
// A half-explicit method of order 5 on the stages of Dormand and Prince's 5(4) pair, for
// y' = f(t, y, z), 0 = g(t, y) of index 2:
//
//   Y_i = y_0 + h Σ_{j<i} a_ij f(Y_j, Z_j)                  the stages, a of TableauDp5
//   Ȳ_i = y_0 + h Σ_{j≤i} ā_ij f(Y_j, Z_j),  g(Ȳ_i) = 0      determines Z_i, i = 2 … 6
//   y_1 = Ȳ_6 (ā_6 = b)
//
// at t_0 + c_i h and t_0 + c̄_i h; Z_1 comes from the hidden constraint. So does Z_7 at y_1, the Z_1
// of the next step, for the error estimate.
//
// ā. Dormand-Prince's second stage alone is of low order; b_2 = Σ b_i a_i2 = Σ b_i c_i a_i2 = 0
// make it harmless, and with ā_i2 = 0 for i > 2 the errors of Z_i it causes are ∝ a_i2 too,
// harmless by the same sums. The other entries are weights of quadrature on [0, c̄_i] with the nodes
// c_j: exact for degree 2 in row 3, which fixes c̄_3 = 9/20, and in row 4, for degree 3 in row 5.
// The defects δ of degree 3 in rows 3 and 4 leave errors ζ = Ā⁻¹δ in Z; Σ b_i c_i ζ_i = 0 is the
// last condition of order 5, met by c̄_4 = 4/5 and c̄_5 = (58 + 4√19)/85, a root of 85x² − 116x + 36.
// Then Σ b̂_i ζ_i = 0 too: the embedded method keeps its order 4. Row 2, exact for degree 1, has c̄_2
// free.
//
// Source: the idea, Murua, Computing 59 (1997), and Arnold, BIT 38 (1998), whose HEDOP5 stands on
// the same stages; half-explicit methods and their order, Brasey, Hairer, SIAM J. Numer. Anal. 30
// (1993) (HEM4), Brasey, Computing 48 (1992) (HEM5); Hairer, Wanner, Solving Ordinary Differential
// Equations II, VII.6. The coefficients are our own, by the conditions above.

#include <momenta/dae/integrator/tableau_dp5.h>

namespace momenta {

struct TableauHem5 {
  static constexpr int stages = 6;
  static constexpr double root19 = 4.35889894354067355223698198386;
  /// By stage; the first is not used.
  static constexpr std::array<double, stages> c_bar{0, 0.3, 0.45, 0.8, (58 + 4 * root19) / 85, 1};
  static constexpr std::array<std::array<double, stages>, stages> a_bar{{
      {0, 0, 0, 0, 0, 0},
      {explicit_rk::ratio(3, 40), explicit_rk::ratio(9, 40), 0, 0, 0, 0},
      {explicit_rk::ratio(9, 80), 0, explicit_rk::ratio(27, 80), 0, 0, 0},
      {explicit_rk::ratio(2, 45), 0, explicit_rk::ratio(128, 225), explicit_rk::ratio(14, 75), 0,
       0},
      {(7100489 - 167578 * root19) / 75168900, 0, (419310944 + 11462912 * root19) / 995987925,
       (1466359 + 346957 * root19) / 6264075, (-29745873 - 7794954 * root19) / 442661300, 0},
      explicit_rk::TableauDp5::a[6],
  }};

  /// Stages before stage i that foresee f there: k_i ≈ Σ_j ℓ_j(c_i) k_j by the polynomial through
  /// them. The second, off by O(h²), serves the third alone.
  static constexpr std::array<std::array<bool, stages>, stages> foresees{{
      {},
      {true},
      {true, true},
      {true, false, true},
      {true, false, true, true},
      {true, false, true, true, true},
  }};
  /// ℓ_j(c_i), zero for other stages j.
  static constexpr std::array<std::array<double, stages>, stages> foreseen = [] {
    std::array<std::array<double, stages>, stages> all{};
    const auto& c = explicit_rk::TableauDp5::c;
    for (std::size_t i = 1; i < stages; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        if (!foresees[i][j]) continue;
        all[i][j] = 1;
        for (std::size_t k = 0; k < i; ++k)
          if (foresees[i][k] && k != j) all[i][j] *= (c[i] - c[k]) / (c[j] - c[k]);
      }
    return all;
  }();
};

}  // namespace momenta
