#include <momenta/dae/factor/filtered_matrix.h>

#include <cmath>
#include <utility>

namespace momenta {

FilteredMatrix::FilteredMatrix(const KktPattern& pattern, AxisScale scale, int nv,
                               const std::vector<int>& groups)
    : scale_(std::move(scale)),
      diagonal_of_mass_(pattern, nv),
      factor_(pattern, nv, groups),
      mass_(pattern.mass.size()),
      constraint_(pattern.constraint.size()),
      tau_(groups.size()) {}

bool FilteredMatrix::factor(const double* compliance, double fade) {
  scale_.of_groups(diagonal_of_mass_.of(mass_), constraint_, tau_);
  for (double& tau : tau_) {
    tau = compliance ? 0 : tau * scale_.fading(fade);
    if (!std::isfinite(tau)) return false;
  }
  return factor_.factor(mass_, constraint_, compliance, tau_.data());
}

}  // namespace momenta
