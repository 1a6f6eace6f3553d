#include <momenta/dae/form/natural_sizes.h>
#include <momenta/dae/kkt/rate_units.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace momenta {
namespace {

/// Powers of ten change 10^−edge above or below themselves, where round numbers and their roots are
/// not: 1 m is 0.33 to 3.3 m, 1/s 1.9 to 19/s.
constexpr double length_edge = 0.48, rate_edge = -0.28;

/// By rate u [m or rad].
Eigen::VectorXd ways(const Mechanism& mechanism) {
  Eigen::VectorXd unit = rate_units(mechanism);
  for (double& x : unit) x = power_of_ten(x, length_edge);
  return unit;
}

/// √(g/ℓ) of weight on the length of the scene.
double rate_of_weight(const Mechanism& mechanism) {
  return std::sqrt(mechanism.scene().gravity.norm() / length_of(mechanism.scene()));
}

/// The larger of √(a/ℓ), a the accelerations that loops cause, without loops all, and of the rates
/// of what turns. How fast something slides says nothing: that is another in a room that moves.
double rate_at(const Mechanism& mechanism, const Start& start) {
  const Eigen::VectorXd way = ways(mechanism);
  const std::vector<bool> lengths = lengths_by_rate(mechanism);
  double acceleration = 0, rate = 0;
  if (mechanism.m() > 0 && start.lambda.size() == mechanism.m()) {
    const auto e = mechanism.evaluation<double>();
    const auto nv = static_cast<std::size_t>(mechanism.nv());
    std::vector<double> force(nv), inertia(nv);
    e->place(start.t, start.q.data());
    e->mass_diagonal(inertia.data());
    e->constraint_forces(start.lambda.data(), force.data());
    for (std::size_t i = 0; i < nv; ++i)
      if (inertia[i] > 0)
        acceleration = std::max(
            acceleration, std::abs(force[i]) / inertia[i] / way[static_cast<Eigen::Index>(i)]);
  } else if (start.udot.size() > 0) {  // none where drives move all there is
    acceleration = start.udot.cwiseQuotient(way).cwiseAbs().maxCoeff();
  }
  for (Eigen::Index i = 0; i < start.u.size(); ++i)
    if (!lengths[static_cast<std::size_t>(i)]) rate = std::max(rate, std::abs(start.u[i]));
  return std::max(std::sqrt(acceleration), rate);
}

/// That, or where nothing stirs, of weight; or ten in the time a run of the scene takes.
double own_rate(const Mechanism& mechanism, const Start& start) {
  for (const double rate : {rate_at(mechanism, start), rate_of_weight(mechanism)})
    if (rate > 0 && std::isfinite(rate)) return rate;
  const double end = mechanism.scene().run.end_time;
  return end > 0 ? 10 / end : 1;
}

}  // namespace

double power_of_ten(double x, double edge) {
  return std::pow(10, std::floor(std::log10(x) + edge));
}

double default_leak(const Mechanism& mechanism, const Start& start) {
  if (mechanism.m() == 0) return 0;
  // Two digits are more than the choice deserves, and make a rate that can be typed again.
  char digits[16];
  std::snprintf(digits, sizeof digits, "%.1e", own_rate(mechanism, start));
  return std::strtod(digits, nullptr);
}

NaturalSizes::NaturalSizes(const Mechanism& mechanism, const Start& start)
    : q(static_cast<std::size_t>(mechanism.nq()), 1.0) {
  const Eigen::VectorXd unit = ways(mechanism);
  way.assign(unit.begin(), unit.end());
  if (mechanism.scene().lagrangian) q = way;
  for (const auto& b : mechanism.tree().bodies)
    for (int i = 0; i < std::min(b.nv, b.nq - (b.has_quaternion() ? 4 : 0)); ++i)
      q[static_cast<std::size_t>(b.q + i)] = way[static_cast<std::size_t>(b.u + i)];
  // At rest loops may bear little, and next to an equilibrium a tree starts far slower than it goes
  // on.
  double own = std::max(own_rate(mechanism, start), rate_of_weight(mechanism));
  // What slides fast has forces rounded by its speed, v × p among them, however slow its motion is.
  if (start.u.size() > 0) fastest = start.u.cwiseQuotient(unit).cwiseAbs().maxCoeff();
  if (std::isfinite(fastest)) own = std::max(own, fastest);
  rate = power_of_ten(own, rate_edge);
  fastest = std::isfinite(fastest) ? std::max(fastest, rate) : rate;
}

void NaturalSizes::of_momenta(Evaluation<double>& e, double at_rate, double* sizes) const {
  e.mass_diagonal(sizes);
  double largest = 0;  // M_ii by lengths of one
  for (std::size_t i = 0; i < way.size(); ++i)
    largest = std::max(largest, sizes[i] * way[i] * way[i]);
  for (std::size_t i = 0; i < way.size(); ++i) {
    if (!(sizes[i] * way[i] * way[i] > 1e-14 * largest))
      sizes[i] = largest > 0 ? largest / (way[i] * way[i]) : 1;
    sizes[i] *= way[i] * at_rate;
  }
}

}  // namespace momenta
