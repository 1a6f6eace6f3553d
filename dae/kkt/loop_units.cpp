#include <momenta/dae/kkt/factor/axis_scale.h>
#include <momenta/dae/kkt/loop_units.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace momenta {

namespace {

bool is_angle(const std::string& unit) {
  return unit.empty() || unit == "1" || unit == "rad" || unit == "deg" || unit == "°";
}

/// Natural size of the terms of a coupler's equation.
double size_of(const LoopSpec& l, const Tree& tree, const Eigen::VectorXd& rates) {
  double size = 0;
  for (std::size_t i = 0; i < l.joints.size(); ++i) {
    const int k = tree.part_of(l.joints[i], l.coordinates.empty() ? 0 : l.coordinates[i]);
    const Tree::Body& b = tree.bodies[static_cast<std::size_t>(k)];
    size = std::max(size, std::abs(l.ratios[i]) * (b.nv > 0 ? rates[b.u] : 1));
  }
  return size > 0 ? size : 1;
}

/// LoopUnits::rounding; `length` of the scene.
double rounding_of(const Tree& tree, double length) {
  double rounding = 0;
  std::vector<double> reach;
  std::vector<int> depth;
  for (const auto& b : tree.bodies) {
    const double step = b.placement.translation().norm();
    const auto parent = static_cast<std::size_t>(b.parent);
    reach.push_back(b.parent < 0 ? step : reach[parent] + step);
    depth.push_back(b.parent < 0 ? 1 : depth[parent] + 1);
    rounding = std::max(rounding, 4 * std::numeric_limits<double>::epsilon() *
                                      std::sqrt(depth.back()) * reach.back() / length);
  }
  return rounding;
}

/// By row of a formula the largest |∂Φ/∂u_j| times the unit of u_j at q0; zero for other rows and
/// where it is not finite. Empty: no formulas.
std::vector<double> sizes_of_equations(const Mechanism& mechanism, const Eigen::VectorXd& rates) {
  std::set<std::string> names;
  for (const LoopSpec& l : mechanism.scene().loops)
    if (has_equation(l)) names.insert(l.name);
  if (mechanism.scene().lagrangian)
    for (const auto& c : mechanism.scene().lagrangian->constraints) names.insert(c.name);
  if (names.empty()) return {};
  std::vector<double> sizes(static_cast<std::size_t>(mechanism.m()), 0.0);
  const auto& pattern = mechanism.constraint_pattern();
  std::vector<double> entries(pattern.size());
  const auto e = mechanism.evaluation<double>();
  e->place(0, mechanism.tree().q0.data());
  e->constraint_entries(entries.data());
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const auto row = static_cast<std::size_t>(pattern[k].row);
    if (!names.contains(mechanism.rows()[row].loop)) continue;
    const double size = std::abs(entries[k]) * rates[pattern[k].column];
    if (std::isfinite(size)) sizes[row] = std::max(sizes[row], size);
  }
  return sizes;
}

}  // namespace

Eigen::VectorXd rate_units(const Mechanism& mechanism) {
  Eigen::VectorXd unit = Eigen::VectorXd::Ones(mechanism.nv());
  if (const auto& formulas = mechanism.scene().lagrangian) {
    std::map<std::string, double> largest;
    for (const auto& c : formulas->coordinates)
      if (!is_angle(c.unit)) largest[c.unit] = std::max(largest[c.unit], std::abs(c.position));
    for (Eigen::Index i = 0; i < unit.size(); ++i)
      if (const double size = largest[formulas->coordinates[static_cast<std::size_t>(i)].unit];
          size > 0)
        unit[i] = size;
    return unit;
  }
  const double length = length_of(mechanism.scene());
  for (const auto& b : mechanism.tree().bodies)
    for (int i = 0; i < b.nv; ++i)
      if (b.is_length(i)) unit[b.u + i] = length;
  return unit;
}

LoopUnits::LoopUnits(const Mechanism& mechanism) {
  const Tree& tree = mechanism.tree();
  const double length = length_of(mechanism.scene());
  rounding = rounding_of(tree, length);
  rates = rate_units(mechanism);
  equations.setOnes(mechanism.m());
  const std::vector<double> of_equations = sizes_of_equations(mechanism, rates);
  std::map<std::string, const LoopSpec*> couplers;
  for (const LoopSpec& l : mechanism.scene().loops)
    if (l.kind == LoopKind::coupler) couplers.emplace(l.name, &l);
  for (int i = 0; i < mechanism.m(); ++i)
    if (mechanism.row_groups()[static_cast<std::size_t>(i)] % 2 == 0) {
      const auto coupler = couplers.find(mechanism.rows()[static_cast<std::size_t>(i)].loop);
      equations[i] = coupler == couplers.end() ? length : size_of(*coupler->second, tree, rates);
      if (!of_equations.empty() && of_equations[static_cast<std::size_t>(i)] > 0)
        equations[i] = of_equations[static_cast<std::size_t>(i)];
    }
}

std::vector<double> row_scales(const Mechanism& mechanism, Evaluation<double>& e) {
  std::vector<double> constraint(mechanism.constraint_pattern().size()),
      inertia(static_cast<std::size_t>(mechanism.nv())), scale(mechanism.row_groups().size());
  e.constraint_entries(constraint.data());
  e.mass_diagonal(inertia.data());
  AxisScale(mechanism).of_groups(inertia, constraint, scale);
  scale_idle_rows(scale);
  return scale;
}

}  // namespace momenta
