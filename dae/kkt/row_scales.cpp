#include <momenta/dae/factor/axis_scale.h>
#include <momenta/dae/kkt/row_scales.h>

namespace momenta {

std::vector<double> row_scales(const Mechanism& mechanism, Evaluation<double>& e) {
  std::vector<double> constraint(mechanism.constraint_pattern().size()),
      inertia(static_cast<std::size_t>(mechanism.nv())), scale(mechanism.row_groups().size());
  e.constraint_entries(constraint.data());
  e.mass_diagonal(inertia.data());
  mechanism.axis_scale().of_groups(inertia, constraint, scale);
  scale_idle_rows(scale);
  return scale;
}

}  // namespace momenta
