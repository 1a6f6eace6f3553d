#pragma once
#include <momenta/dae/mechanism.h>

#include <vector>

namespace momenta {

/// Scale of each row of Φ_q M⁻¹ Φ_qᵀ (m) at the configuration placed in `e`: the mean of Σ_j Φ_ij²
/// / M_jj over its group, since a row may vanish in every entry; the natural one where a whole
/// group of axis rows does; the largest for rows that nothing moves. [1/kg, or 1/(kg m²)]
std::vector<double> row_scales(const Mechanism& mechanism, Evaluation<double>& e);

}  // namespace momenta
