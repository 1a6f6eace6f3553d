#include <momenta/dae/kkt/axis_scale.h>

#include <algorithm>

namespace momenta {

AxisScale::AxisScale(const Mechanism& mechanism) {
  const auto& pattern = mechanism.kkt_pattern();
  std::vector<std::size_t> diagonal(static_cast<std::size_t>(mechanism.nv()));
  for (std::size_t i = 0; i < pattern.mass.size(); ++i)
    if (pattern.mass[i].row == pattern.mass[i].column)
      diagonal[static_cast<std::size_t>(pattern.mass[i].row)] = i;
  std::vector<bool> turns(diagonal.size(), false);
  for (const auto& b : mechanism.tree().bodies) {
    const int angular = b.nv == 6 ? 3 : 0;
    if (b.nv == 1 && b.kind == JointKind::prismatic) continue;
    for (int i = angular; i < b.nv; ++i) turns[static_cast<std::size_t>(b.u + i)] = true;
  }
  for (const auto& entry : pattern.constraint) {
    const auto row = static_cast<std::size_t>(entry.row),
               column = static_cast<std::size_t>(entry.column);
    const bool ties_axes = mechanism.row_groups()[row] % 2 == 1;  // each loop: points, then axes
    if (ties_axes && turns[column]) hanging_.push_back({row, diagonal[column]});
  }
}

void AxisScale::measure(const std::vector<double>& mass, std::vector<double>& scale) const {
  std::fill(scale.begin(), scale.end(), 0.0);
  for (const auto& h : hanging_)
    if (mass[h.mass] > 0) scale[h.row] += 1 / mass[h.mass];
}

std::vector<double> row_scales(const Mechanism& mechanism, Evaluation<double>& e) {
  const auto& pattern = mechanism.kkt_pattern();
  const auto& groups = mechanism.row_groups();
  std::vector<double> entries(pattern.constraint.size()), masses(pattern.mass.size()),
      inertia(static_cast<std::size_t>(mechanism.nv())), natural(groups.size()),
      own(groups.size(), 0.0), scales;
  e.constraint_entries(entries.data());
  e.mass_entries(masses.data());
  e.mass_diagonal(inertia.data());
  AxisScale(mechanism).measure(masses, natural);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto& entry = pattern.constraint[i];
    const double mass = inertia[static_cast<std::size_t>(entry.column)];
    if (mass > 0) own[static_cast<std::size_t>(entry.row)] += entries[i] * entries[i] / mass;
  }
  for (std::size_t first = 0; first < groups.size();) {
    std::size_t last = first;
    double sum = 0;
    for (; last < groups.size() && groups[last] == groups[first]; ++last)
      sum += std::max(own[last], natural[last]);
    scales.insert(scales.end(), last - first, sum / static_cast<double>(last - first));
    first = last;
  }
  return scales;
}

}  // namespace momenta
