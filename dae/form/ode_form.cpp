#include <momenta/dae/form/ode_form.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace momenta {

OdeForm::OdeForm(std::string name, const Mechanism& mechanism, const FormOptions& options)
    : name_(std::move(name)),
      mechanism_(mechanism),
      options_(options),
      e_(mechanism.evaluation<double>()) {
  const auto nv = static_cast<std::size_t>(mechanism.nv()),
             m = static_cast<std::size_t>(mechanism.m());
  if (has_loops()) kkt_ = make_kkt(mechanism);
  u_.resize(nv);
  r_.resize(nv);
  delta_.resize(nv);
  work_.resize(nv);
  g_.resize(m);
  multipliers_.assign(m, 0.0);
  centre_.assign(m, 0.0);
  phi_.resize(m);
  correction_.assign(static_cast<std::size_t>(mechanism.nq()), 0.0);
  scale_.assign(static_cast<std::size_t>(size()), 1.0);
}

bool OdeForm::fail_at(double t, const std::string& why) {
  char text[64];
  std::snprintf(text, sizeof text, "at t = %.9g s: ", t);
  return fail(text + why);
}

bool OdeForm::factor_at(double t, const double* q, double fade) {
  e_->place(t, q);
  if (kkt_->factor(*e_, fade)) return true;
  for (int i = 0; i < mechanism_.nq(); ++i)
    if (!std::isfinite(q[i])) return fail_at(t, "a joint coordinate is not finite");
  return fail_at(t, mechanism_.no_inertia(kkt_->stuck()));
}

void OdeForm::rheonomic_terms() {
  std::fill(g_.begin(), g_.end(), 0.0);
  if (!mechanism_.plan().drives) return;
  e_->move(nullptr);
  e_->momenta(nullptr, work_.data());
  for (std::size_t i = 0; i < r_.size(); ++i) r_[i] -= work_[i];
  e_->velocities(g_.data());
  for (double& g : g_) g = -g;
}

bool OdeForm::correct_position(double t, double* q) {
  if (!factor_at(t, q, fade_projection)) return false;
  e_->positions(phi_.data());
  for (double& phi : phi_) phi = -phi;
  std::fill(r_.begin(), r_.end(), 0.0);
  std::vector<double>& nu = g_;
  if (!kkt_->solve(r_.data(), phi_.data(), nullptr, delta_.data(), nu.data()))
    return fail_at(t, "the position correction is not finite");
  // q ← q + q̇(δ): exact for one-dof joints, to second order for quaternions.
  e_->coordinate_rates(q, delta_.data(), correction_.data());
  for (std::size_t i = 0; i < correction_.size(); ++i) q[i] += correction_[i];
  return true;
}

void OdeForm::normalise(double* q) const {
  if (!mechanism_.plan().quasi_velocities) return;
  for (const auto& b : mechanism_.tree().bodies) {
    if (b.nq < 4) continue;
    double* quaternion = q + b.q + (b.nq - 4);
    double norm = 0;
    for (int i = 0; i < 4; ++i) norm += quaternion[i] * quaternion[i];
    norm = std::sqrt(norm);
    for (int i = 0; i < 4; ++i) quaternion[i] /= norm;
  }
}

}  // namespace momenta
