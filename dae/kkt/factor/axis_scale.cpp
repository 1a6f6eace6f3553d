#include <momenta/dae/kkt/factor/axis_scale.h>
#include <momenta/dae/kkt/factor/faded_pivot.h>
#include <momenta/dae/mechanism/loop/loop_weights.h>

#include <algorithm>
#include <cmath>

namespace momenta {

void scale_idle_rows(std::vector<double>& scale) {
  double most = 0;
  for (const double s : scale) most = std::max(most, s);
  for (double& s : scale)
    if (s == 0) s = most > 0 ? most : 1;
}

AxisScale::AxisScale(const Mechanism& mechanism)
    : pattern_(mechanism.constraint_pattern()),
      groups_(mechanism.row_groups()),
      least_(mechanism.least_scales()),
      far_apart_(std::max(1.0, mechanism.mass_spread() / masses_far_apart)),
      apart_(mechanism.masses_apart()) {
  const Tree& tree = mechanism.tree();
  std::vector<bool> turns(static_cast<std::size_t>(tree.nv), false);
  for (const auto& b : tree.bodies) {
    for (int i = 0; i < b.nv; ++i) turns[static_cast<std::size_t>(b.u + i)] = !b.is_length(i);
  }
  for (const auto& entry : pattern_) {
    const auto row = static_cast<std::size_t>(entry.row),
               column = static_cast<std::size_t>(entry.column);
    const bool ties_axes = groups_[row] % 2 == 1;  // each loop: points, then axes
    if (ties_axes && turns[column]) hanging_.push_back({row, column});
  }
  std::stable_sort(hanging_.begin(), hanging_.end(),
                   [](const Hanging& a, const Hanging& b) { return a.row < b.row; });
}

double AxisScale::fading(double fade) const {
  return fade_beside(fade, apart_);
}

void AxisScale::measure(const std::vector<double>& inertia, std::vector<double>& scale) const {
  scale = least_;
  for (const auto& h : hanging_)
    if (inertia[h.rate] > 0) scale[h.row] += 1 / inertia[h.rate];
}

void AxisScale::of_groups(const std::vector<double>& inertia, const std::vector<double>& constraint,
                          std::vector<double>& scale) const {
  std::fill(scale.begin(), scale.end(), 0.0);
  for (std::size_t i = 0; i < constraint.size(); ++i) {
    const auto& entry = pattern_[i];
    const double own = inertia[static_cast<std::size_t>(entry.column)];
    if (own > 0) scale[static_cast<std::size_t>(entry.row)] += constraint[i] * constraint[i] / own;
  }
  for (std::size_t h = 0, row = 0; row < scale.size(); ++row) {
    double natural = least_[row];
    for (; h < hanging_.size() && hanging_[h].row == row; ++h)
      if (inertia[hanging_[h].rate] > 0) natural += 1 / inertia[hanging_[h].rate];
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

bool AxisScale::fade_groups(const std::vector<double>& inertia,
                            const std::vector<double>& constraint, const double* compliance,
                            double fade, std::vector<double>& tau) const {
  of_groups(inertia, constraint, tau);
  for (double& t : tau) {
    t = compliance ? 0 : t * fading(fade);
    if (!std::isfinite(t)) return false;
  }
  return true;
}

void AxisScale::softness(const std::vector<double>& inertia, const std::vector<double>& constraint,
                         double fade, std::vector<double>& epsilon) const {
  of_groups(inertia, constraint, epsilon);
  scale_idle_rows(epsilon);
  for (double& e : epsilon) e *= 1e-2 * fade / far_apart_;
}

MassDiagonal::MassDiagonal(const KktPattern& pattern, int nv)
    : place_(static_cast<std::size_t>(nv)), inertia_(place_.size()) {
  for (std::size_t i = 0; i < pattern.mass.size(); ++i)
    if (pattern.mass[i].row == pattern.mass[i].column)
      place_[static_cast<std::size_t>(pattern.mass[i].row)] = i;
}

const std::vector<double>& MassDiagonal::of(const std::vector<double>& mass) {
  for (std::size_t j = 0; j < place_.size(); ++j) inertia_[j] = mass[place_[j]];
  return inertia_;
}

}  // namespace momenta
