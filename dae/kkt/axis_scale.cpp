#include <momenta/dae/kkt/axis_scale.h>

#include <algorithm>

namespace momenta {

AxisScale::AxisScale(const Mechanism& mechanism)
    : pattern_(mechanism.kkt_pattern()),
      groups_(mechanism.row_groups()),
      least_(mechanism.least_scales()),
      diagonal_(static_cast<std::size_t>(mechanism.nv())) {
  for (std::size_t i = 0; i < pattern_.mass.size(); ++i)
    if (pattern_.mass[i].row == pattern_.mass[i].column)
      diagonal_[static_cast<std::size_t>(pattern_.mass[i].row)] = i;
  std::vector<bool> turns(diagonal_.size(), false);
  for (const auto& b : mechanism.tree().bodies) {
    const int angular = b.nv == 6 ? 3 : 0;
    if (b.nv == 1 && b.kind == JointKind::prismatic) continue;
    for (int i = angular; i < b.nv; ++i) turns[static_cast<std::size_t>(b.u + i)] = true;
  }
  for (const auto& entry : pattern_.constraint) {
    const auto row = static_cast<std::size_t>(entry.row),
               column = static_cast<std::size_t>(entry.column);
    const bool ties_axes = groups_[row] % 2 == 1;  // each loop: points, then axes
    if (ties_axes && turns[column]) hanging_.push_back({row, diagonal_[column]});
  }
  std::stable_sort(hanging_.begin(), hanging_.end(),
                   [](const Hanging& a, const Hanging& b) { return a.row < b.row; });
}

void AxisScale::measure(const std::vector<double>& mass, std::vector<double>& scale) const {
  scale = least_;
  for (const auto& h : hanging_)
    if (mass[h.mass] > 0) scale[h.row] += 1 / mass[h.mass];
}

void AxisScale::of_groups(const std::vector<double>& mass, const std::vector<double>& constraint,
                          std::vector<double>& scale) const {
  std::fill(scale.begin(), scale.end(), 0.0);
  for (std::size_t i = 0; i < constraint.size(); ++i) {
    const auto& entry = pattern_.constraint[i];
    const double own = mass[diagonal_[static_cast<std::size_t>(entry.column)]];
    if (own > 0) scale[static_cast<std::size_t>(entry.row)] += constraint[i] * constraint[i] / own;
  }
  for (std::size_t h = 0, row = 0; row < scale.size(); ++row) {
    double natural = least_[row];
    for (; h < hanging_.size() && hanging_[h].row == row; ++h)
      if (mass[hanging_[h].mass] > 0) natural += 1 / mass[hanging_[h].mass];
    scale[row] = std::max(scale[row], natural);
  }
  for (std::size_t first = 0; first < groups_.size();) {
    std::size_t last = first;
    double sum = 0;
    for (; last < groups_.size() && groups_[last] == groups_[first]; ++last) sum += scale[last];
    std::fill(scale.begin() + static_cast<std::ptrdiff_t>(first),
              scale.begin() + static_cast<std::ptrdiff_t>(last),
              sum / static_cast<double>(last - first));
    first = last;
  }
}

std::vector<double> row_scales(const Mechanism& mechanism, Evaluation<double>& e) {
  const auto& pattern = mechanism.kkt_pattern();
  std::vector<double> constraint(pattern.constraint.size()), mass(pattern.mass.size()),
      scale(mechanism.row_groups().size());
  e.constraint_entries(constraint.data());
  e.mass_entries(mass.data());
  AxisScale(mechanism).of_groups(mass, constraint, scale);
  return scale;
}

}  // namespace momenta
