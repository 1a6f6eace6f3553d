#include <momenta/dae/gradient/tangent_system.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace momenta {

using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;

TangentSystem::TangentSystem(OdeForm& form, FormTangents& tangents, Functional* integrand,
                             VectorXd sizes, double tangents_scale)
    : form_(form),
      tangents_(tangents),
      integrand_(integrand),
      n_(form.size()),
      directions_(static_cast<int>(sizes.size())),
      all_((n_ + extra()) * (1 + directions_)),
      sizes_(std::move(sizes)),
      tangents_scale_(tangents_scale),
      before_(static_cast<std::size_t>(n_)) {}

double TangentSystem::tolerance_factor() const {
  return std::sqrt(static_cast<double>(n_) / all_);
}

double TangentSystem::scale(int i) const {
  if (i < n_) return form_.scale(i);
  const int k = i - n_ - extra();
  if (k < 0) return 1;  // J
  if (k >= n_ * directions_) return tangents_scale_ / sizes_[k - n_ * directions_];
  return tangents_scale_ * form_.scale(k % n_) / sizes_[k / n_];
}

std::vector<double> TangentSystem::initial(const std::vector<double>& y0,
                                           const MatrixXd& Y0) const {
  std::vector<double> all(static_cast<std::size_t>(all_), 0.0);
  std::copy(y0.begin(), y0.end(), all.begin());
  Map<MatrixXd>(all.data() + n_ + extra(), n_, directions_) = Y0;
  return all;
}

MatrixXd TangentSystem::tangents(const double* y) const {
  return Map<const MatrixXd>(y + n_ + extra(), n_, directions_);
}

VectorXd TangentSystem::integral_tangents(const double* y) const {
  return Map<const VectorXd>(y + (n_ + 1) + n_ * directions_, directions_);
}

bool TangentSystem::fail_at(double t, const std::string& why) {
  char text[48];
  std::snprintf(text, sizeof text, "at t = %.9g s: ", t);
  lost_ = text + why;
  return fail(lost_);
}

void TangentSystem::set_handling(SingularityHandling handling) {
  corrected_stages_ = handling == SingularityHandling::position;
  form_.set_handling(handling);
}

bool TangentSystem::rhs(double t, const double* y, double* ydot) {
  lost_.clear();
  if (!form_.rhs(t, y, ydot)) return fail(form_.failure());
  if (corrected_stages_) return fail_at(t, too_near_to_pose);
  if (looking_ == 0) passages_.take(t, form_.pivots());
  Y_ = Map<const MatrixXd>(y + n_ + extra(), n_, directions_);
  if (!tangents_.rates(t, y, ydot, Y_, Ydot_)) return fail_at(t, dependent_loops);
  Map<MatrixXd>(ydot + n_ + extra(), n_, directions_) = Ydot_;
  if (!integrand_) return true;
  const Eigen::Index nq = n_ - tangents_.u().size();
  VectorXd slope;
  ydot[n_] = (*integrand_)(t, Map<const VectorXd>(y, nq), tangents_.u(), Y_.topRows(nq),
                           tangents_.velocity(), slope);
  Map<VectorXd>(ydot + (n_ + 1) + n_ * directions_, directions_) = slope;
  return true;
}

bool TangentSystem::motion(double t, const double* y, Motion& out) {
  std::vector<double> rates(static_cast<std::size_t>(all_));
  if (!rhs(t, y, rates.data())) return false;
  const Eigen::Index nq = n_ - tangents_.u().size();
  out = {Map<const VectorXd>(y, nq), tangents_.u(), Y_.topRows(nq), tangents_.velocity()};
  return true;
}

bool TangentSystem::after_step(double t, double* y, bool& changed) {
  std::copy_n(y, n_, before_.begin());
  if (!form_.after_step(t, y, changed)) return fail(form_.failure());
  Y_ = tangents(y);
  if (!tangents_.after_step(t, before_.data(), y, Y_)) return fail_at(t, dependent_loops);
  Map<MatrixXd>(y + n_ + extra(), n_, directions_) = Y_;
  return true;
}

double TangentSystem::motion_error_squared(double t, const double* y, const double* error,
                                           double rtol, double atol) {
  return form_.motion_error_squared(t, y, error, rtol / tolerance_factor(),
                                    atol / tolerance_factor());
}

}  // namespace momenta
