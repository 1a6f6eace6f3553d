#include <momenta/dae/form/impulse_gauge.h>

#include <algorithm>
#include <cmath>

namespace momenta {

ImpulseGauge::Measure::Measure(const Mechanism& mechanism) : e(mechanism.evaluation<double>()) {
  if (mechanism.m() > 0) solver = make_loop_solver(mechanism, *e);
  const auto nq = static_cast<std::size_t>(mechanism.nq()),
             nv = static_cast<std::size_t>(mechanism.nv());
  for (auto* x : {&q, &coordinate_weight}) x->resize(nq);
  for (auto* x : {&u, &v, &p, &rate_weight}) x->resize(nv);
}

ImpulseGauge::ImpulseGauge(const Mechanism& mechanism, const DaeLayout& layout, Gauge gauge,
                           const NaturalSizes& natural)
    : of_(mechanism), places_(layout), rule_(gauge), natural_(natural) {}

ImpulseGauge::Measure& ImpulseGauge::measure() {
  if (!measure_) measure_ = std::make_shared<Measure>(of_);
  return *measure_;
}

int ImpulseGauge::direction_entries() const {
  return static_cast<int>(of_.constraint_pattern().size());
}

void ImpulseGauge::gauge_directions(double t, const double* y, double* entries) {
  Measure& w = measure();
  w.e->place(t, y);
  w.e->constraint_entries(entries);
}

void ImpulseGauge::shift(const double* entries, const double* c, double* y) const {
  double *p = y + places_.x(), *sigma = y + places_.s();
  for (const auto& at : of_.constraint_pattern()) p[at.column] += *entries++ * c[at.row];
  for (int i = 0; i < places_.m; ++i) sigma[i] += c[i];
}

void ImpulseGauge::reset(double t, double* y, double* ydot) {
  Measure& w = measure();
  double *sigma = y + places_.s(), *p = y + places_.x(), *pdot = ydot + places_.x();
  w.e->place(t, y);
  w.e->joint_rates(y, ydot, w.u.data());
  w.e->move(w.u.data());
  // (8) without Φ̇_qᵀσ.
  w.e->momenta(nullptr, w.p.data());
  w.e->momentum_rates(y, w.u.data(), nullptr, 0, pdot);
  w.e->constraint_forces(sigma, w.p.data());
  for (std::size_t i = 0; i < w.p.size(); ++i) p[i] -= w.p[i];
  std::fill_n(sigma, places_.m, 0.0);
}

void ImpulseGauge::measure_at(double t, const double* y, const double* ydot, double rtol,
                              double atol) {
  Measure& w = measure();
  w.t = t;
  std::copy_n(y, w.q.size(), w.q.data());
  w.e->joint_rates(y, ydot, w.u.data());
  const auto weight = [&](double x, double size) { return 1 / (atol * size + rtol * std::abs(x)); };
  for (std::size_t i = 0; i < w.q.size(); ++i)
    w.coordinate_weight[i] = weight(w.q[i], natural_.q[i]);
  for (std::size_t i = 0; i < w.u.size(); ++i) w.rate_weight[i] = weight(w.u[i], natural_.u[i]);
}

double ImpulseGauge::coordinate_squares(const double* e) {
  const Measure& w = measure();
  double sum = 0;
  for (std::size_t i = 0; i < w.q.size(); ++i) {
    const double x = w.coordinate_weight[i] * e[i];
    sum += x * x;
  }
  return sum / static_cast<double>(w.q.size());
}

double ImpulseGauge::motion_squares(const double* e) {
  Measure& w = measure();
  if (!w.solver->free_velocity(w.t, w.q.data(), e + places_.x(), w.v.data()))
    return std::numeric_limits<double>::quiet_NaN();
  double sum = coordinate_squares(e) * static_cast<double>(w.q.size());
  for (std::size_t i = 0; i < w.v.size(); ++i) {
    const double x = w.rate_weight[i] * w.v[i];
    sum += x * x;
  }
  return sum / static_cast<double>(w.q.size() + w.v.size());
}

}  // namespace momenta
