#pragma once
// The spectrum on a basis of all motions that loops allow.

#include <momenta/dae/analysis/linear/spectrum.h>

namespace momenta {

/// Columns of N (nv × mobility): Φ_q N = 0. Cost O(bodies · mobility + mobility³). Fills modes and
/// `conservative`. @throws SceneError where something moves without inertia
void reduced_spectrum(const Mechanism& mechanism, const Equilibrium& equilibrium,
                      const Eigen::MatrixXd& N, Spectrum& found);

/// Scales to length 1 in M, φᴴMφ = `squared`; largest entry real and positive.
void normalise(Mode& mode, double squared);

/// Sorts growing modes first, then by |s|.
void sort_modes(std::vector<Mode>& modes);

}  // namespace momenta
