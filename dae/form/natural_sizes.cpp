#include <momenta/dae/form/natural_sizes.h>
#include <momenta/dae/kkt/loop_units.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace momenta {
namespace {

/// Bounds of powers of ten, off round numbers and their roots: 1 m is 0.25 to 2.5 m, 1/s is 1.36 to
/// 13.6/s.
constexpr double least_length = 0.2512, least_rate = 1.36;
/// Part of a natural displacement that a noticed rate covers in a run.
constexpr double unnoticed = 1e-3;
/// Least energy of the size of a momentum, relative to 2T.
constexpr double rounded = 1e-9;

/// Natural displacement of each rate u [m or rad].
Eigen::VectorXd ways(const Mechanism& mechanism) {
  Eigen::VectorXd way = rate_units(mechanism);
  for (double& x : way) x = power_of_ten(x, least_length);
  return way;
}

/// Natural displacements, of slides no less than the farthest start of one.
Eigen::VectorXd reaches(const Mechanism& mechanism) {
  Eigen::VectorXd way = ways(mechanism);
  const auto slides = [&](auto&& act) {
    for (const auto& b : mechanism.tree().bodies)
      for (int i = 0; i < b.nv; ++i)
        if (b.is_length(i)) act(b.q + i, b.u + i);
  };
  double farthest = 0;
  slides([&](int q, int) { farthest = std::max(farthest, std::abs(mechanism.tree().q0[q])); });
  if (!(farthest > 0)) return way;
  farthest = power_of_ten(farthest, least_length);
  slides([&](int, int u) { way[u] = std::max(way[u], farthest); });
  return way;
}

}  // namespace

double own_rate(const Mechanism& mechanism, const Start& start) {
  Eigen::VectorXd acceleration = start.udot;
  if (mechanism.m() > 0) {
    const auto e = mechanism.evaluation<double>();
    Eigen::VectorXd inertia(mechanism.nv());
    acceleration.resize(mechanism.nv());
    e->place(start.t, start.q.data());
    e->mass_diagonal(inertia.data());
    e->constraint_forces(start.lambda.data(), acceleration.data());
    acceleration = (inertia.array() > 0).select(acceleration.cwiseQuotient(inertia), 0);
  }
  const Eigen::VectorXd reach = reaches(mechanism);
  const auto largest = [&](const Eigen::VectorXd& x) {
    return x.size() > 0 ? x.cwiseQuotient(reach).cwiseAbs().maxCoeff() : 0;
  };
  const double rate = std::max(std::sqrt(largest(acceleration)), largest(start.u));
  if (rate > 0 && std::isfinite(rate)) return rate;
  const double end = mechanism.scene().run.end_time;
  return end > 0 ? 10 / end : 1;
}

namespace {

/// ρ: √(g/ℓ) under weight, whatever the start; else the mechanism's own rate, as far as a run
/// notices it.
double natural_rate(const Mechanism& mechanism, const Start& start) {
  const Scene& scene = mechanism.scene();
  const double weight = std::sqrt(scene.gravity.norm() / length_of_bodies(scene));
  if (weight > 0) return weight;
  const double own = own_rate(mechanism, start);
  return scene.run.end_time > 0 ? std::max(own, unnoticed / scene.run.end_time) : own;
}

}  // namespace

double power_of_ten(double x, double least) {
  return std::pow(10, std::floor(std::log10(x / least)));
}

double default_leak(const Mechanism& mechanism, const Start& start) {
  if (mechanism.m() == 0) return 0;
  // Two digits are more than the choice deserves, and make a rate that can be typed again.
  char digits[16];
  std::snprintf(digits, sizeof digits, "%.1e", own_rate(mechanism, start));
  return std::strtod(digits, nullptr);
}

NaturalSizes::NaturalSizes(const Mechanism& mechanism, const Start& start)
    : rate(power_of_ten(natural_rate(mechanism, start), least_rate)),
      q(static_cast<std::size_t>(mechanism.nq()), 1.0) {
  const Eigen::VectorXd by_rate = ways(mechanism);
  way.assign(by_rate.begin(), by_rate.end());
  u = way;
  for (double& x : u) x *= rate;
  if (mechanism.scene().lagrangian) q = way;
  for (const auto& b : mechanism.tree().bodies)
    for (int i = 0; i < std::min(b.nv, b.nq - (b.has_quaternion() ? 4 : 0)); ++i)
      q[static_cast<std::size_t>(b.q + i)] = way[static_cast<std::size_t>(b.u + i)];
}

void NaturalSizes::of_momenta(Evaluation<double>& e, const Start& start, double* sizes) const {
  const auto nv = u.size();
  e.move(start.u.data());
  e.momenta(nullptr, sizes);
  double twice_energy = 0, most = 0;
  for (std::size_t i = 0; i < nv; ++i)
    twice_energy += sizes[i] * start.u[static_cast<Eigen::Index>(i)];
  e.mass_diagonal(sizes);
  for (std::size_t i = 0; i < nv; ++i) most = std::max(most, sizes[i] * u[i] * u[i]);
  const double least = rounded * std::abs(twice_energy);
  for (std::size_t i = 0; i < nv; ++i) {
    const double size = sizes[i] * u[i] * u[i];  // [J]
    sizes[i] = most > 0 ? std::max(size > 1e-14 * most ? size : most, least) / u[i] : 1;
  }
}

}  // namespace momenta
