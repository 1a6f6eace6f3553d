#pragma once
// Eigenvalues and shapes of the small motions about an equilibrium,
//
//   (s² M + s C + K) φ + Φ_qᵀν = 0,   Φ_q φ = 0,        δ(t) = Re(φ e^{st})
//
// With the columns of N an M-orthonormal basis of the motions that loops allow, φ = N y, this is
// (s² + s C̃ + K̃) y = 0, K̃ = NᵀKN, C̃ = NᵀCN. K̃ is the same for all choices of the loop forces λ,
// unless the pose is singular.
//
//   C = 0, K̃ symmetric    K̃ y = −s² y: self-adjoint
//   else                  the first-order system of (y, ẏ), without y that nothing holds: their
//                         s = 0 is double, and rounding would split it by √ε
//
//   N      few unknowns: from the singular values of Φ_q; many: projections of random vectors by
//          LocalPencil, as many as the mobility
//   many degrees of freedom: the modes nearest to s = 0 by (K + σM)⁻¹ of LocalPencil, Lanczos and
//          Arnoldi (Spectra), without K̃

#include <momenta/dae/analysis/linear/equilibrium.h>

#include <complex>
#include <string>
#include <vector>

namespace momenta {

struct Mode {
  enum class Kind { oscillation, rigid, growth, decay };
  std::complex<double> s;  ///< [1/s]; of a conjugate pair the one with Im s > 0, of ±γ the growing
  Eigen::VectorXcd shape;  ///< φ (nv), by rates [rad, m]: φᴴMφ = 1 kg m²; the largest entry > 0
  bool real = true;        ///< all joints pass the equilibrium at once

  Kind kind() const;
  double angular_frequency() const { return s.imag(); }  ///< [rad/s]
  double frequency() const;                              ///< [Hz]
  double damping_ratio() const;                          ///< −Re s/|s|; NaN for a rigid mode
};
const char* name_of(Mode::Kind kind);

enum class Route { automatic, dense, sparse };

struct Spectrum {
  std::vector<Mode> modes;   ///< growing ones first, then by |s|
  int mobility = 0;          ///< nv − rank of Φ_q
  int rank = 0;              ///< rank of Φ_q
  bool conservative = true;  ///< neither dampers nor gyroscopic terms nor forces without potential
  bool complete = true;      ///< all modes are there
  bool dense = true;
  std::vector<int> dependent_rows;  ///< rows of Φ, at the equilibrium
};

/// `count` of many modes, those of least |s|; 0: all up to 300, else 20.
/// @throws SceneError where something moves without inertia, or a spring has no length
Spectrum spectrum(const Mechanism& mechanism, const Equilibrium& equilibrium, int count = 0,
                  Route route = Route::automatic);

}  // namespace momenta
