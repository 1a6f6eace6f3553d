#include <momenta/dae/kkt/rate_units.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace momenta {
namespace {

bool is_angle(const std::string& unit) {
  return unit.empty() || unit == "1" || unit == "rad" || unit == "deg" || unit == "°";
}

}  // namespace

std::vector<bool> lengths_by_rate(const Mechanism& mechanism) {
  std::vector<bool> lengths(static_cast<std::size_t>(mechanism.nv()), false);
  for (const auto& b : mechanism.tree().bodies)
    for (int i = 0; i < b.nv; ++i) lengths[static_cast<std::size_t>(b.u + i)] = b.is_length(i);
  if (const auto& formulas = mechanism.scene().lagrangian)
    for (std::size_t i = 0; i < lengths.size(); ++i)
      lengths[i] = !is_angle(formulas->coordinates[i].unit);
  return lengths;
}

Eigen::VectorXd rate_units(const Mechanism& mechanism) {
  const std::vector<bool> lengths = lengths_by_rate(mechanism);
  Eigen::VectorXd unit = Eigen::VectorXd::Ones(mechanism.nv());
  std::map<std::string, double> largest;
  const auto& formulas = mechanism.scene().lagrangian;
  if (formulas)
    for (const auto& c : formulas->coordinates)
      largest[c.unit] = std::max(largest[c.unit], std::abs(c.position));
  const double length = length_of(mechanism.scene());
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    if (!lengths[i]) continue;
    const double size = formulas ? largest[formulas->coordinates[i].unit] : length;
    if (size > 0) unit[static_cast<Eigen::Index>(i)] = size;
  }
  return unit;
}

}  // namespace momenta
