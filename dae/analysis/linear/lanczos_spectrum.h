#pragma once
// The modes nearest to s = 0 of mechanisms with many degrees of freedom, without full matrices.

#include <momenta/dae/analysis/linear/spectrum.h>

namespace momenta {

/// At most `count` modes of least |s|, by Lanczos' method on M-self-adjoint
///
///   (K − τM)⁻¹ M    restricted to Φ_q φ = 0, τ < 0 a little below zero
///
/// or, with C or without a potential, by Arnoldi's on ((s² M + s C + K) linearised − τ)⁻¹, τ > 0.
/// Each product is one solution by LocalPencil, O(bodies) where its factors are. Fills modes,
/// `conservative`, `complete`. @pre more than `count` + 2 degrees of freedom; found.dependent_rows
/// @throws SceneError where the method does not converge
void lanczos_spectrum(const Mechanism& mechanism, const Equilibrium& equilibrium, int count,
                      Spectrum& found);

}  // namespace momenta
