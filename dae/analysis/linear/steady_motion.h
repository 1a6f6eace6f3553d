#pragma once
// Small motions about a motion at constant rates: a bicycle that runs straight, a disc or a car in
// a circle, a top. A motion is steady if u̇ = 0 and λ is constant, and its equations are the same
// all along it: then, by linearise_moving(),
//
//   δ̇ = δu + B δ,    M δu̇ + C δu + K δ + Aᵀ δλ = 0,    A δu + V δ = 0,    Φ_q δ = 0
//
// has constant coefficients. Columns of P span the δ that the rows of positions allow, columns of N
// the δu that all rows allow: with nonholonomic rows P has more columns. So, δ = P y,
//
//   δu = N w + S y,    S = −A⁺ V P,
//   ẏ = P⁺(N w + (S + B P) y),
//   NᵀM N ẇ = −Nᵀ((K P + C S) y + C N w + M S ẏ)
//
// Some y, such as places on a plane, headings and angles of wheels, stand in no equation and are
// left out: with O = (D; D E; D E² …), ẏ = E y + …, ẇ = D y + …, they are the null space of O. They
// follow from w without acting on it. Double zeros, which rounding splits by √ε, go with them.
//
// Source: Meijaard, Papadopoulos, Ruina, Schwab, Proc. R. Soc. A 463 (2007) 1955, for the bicycle.

#include <momenta/dae/analysis/linear/spectrum.h>

namespace momenta {

struct SteadyMotion {
  double t = 0;
  Eigen::VectorXd q, u, lambda;  ///< nq, nv, m
  int positions = 0;             ///< nv − rank of the rows of positions
  int rates = 0;                 ///< nv − rank of all rows
  int left_out = 0;              ///< positions in no equation
};

/// Eigenvalues about the motion with the rates of `start`, `udot` and `lambda` of (3); shapes δ
/// with φᴴMφ = 1, or δu where s = 0. O((nv + m)³)
/// @throws SceneError where rates or equations change along the motion, or something has no inertia
Spectrum steady_spectrum(const Mechanism& mechanism, const Start& start, SteadyMotion& motion);

}  // namespace momenta
