#include <momenta/core/text/quoting.h>
#include <momenta/dae/study/fit/wanted_error.h>

#include <cmath>
#include <numbers>

namespace momenta {

using Eigen::MatrixXd;
using Eigen::VectorXd;

WantedError::WantedError(const ParametricMechanism& family, std::string sweep, WantedPoses wanted,
                         VectorXd sizes)
    : family_(family),
      sweep_(std::move(sweep)),
      wanted_(std::move(wanted)),
      derivatives_(family, std::move(sizes), wanted_.quantities) {
  for (Eigen::Index i = 0; i < wanted_.poses(); ++i)
    for (Eigen::Index k = 0; k < wanted_.values.cols(); ++k)
      if (!std::isnan(wanted_.values(i, k))) asked_.push_back({i, k});
  double squares = 0;
  for (Eigen::Index k = 0; k < wanted_.values.cols(); ++k) {
    if (wanted_.quantities[static_cast<std::size_t>(k)].unit == "rad") continue;
    double least = INFINITY, most = -INFINITY;
    for (const double y : wanted_.values.col(k))
      if (!std::isnan(y)) least = std::min(least, y), most = std::max(most, y);
    if (most > least) squares += (most - least) * (most - least);
  }
  if (squares > 0) extent_ = std::sqrt(squares);
}

double WantedError::weight(Eigen::Index quantity) const {
  return wanted_.quantities[static_cast<std::size_t>(quantity)].unit == "rad" ? 1 : extent_;
}

std::vector<double> WantedError::places(const VectorXd& x) const {
  if (!free()) return wanted_.swept;
  return {x.data() + parameters(), x.data() + x.size()};
}

bool WantedError::start(const VectorXd& parameters, VectorXd& x) {
  x.resize(unknowns());
  x.head(parameters.size()) = parameters;
  try {
    const std::unique_ptr<Mechanism> mechanism = family_.at(parameters);
    SweptPoses poses(*mechanism, sweep_);
    if (!free()) return true;
    constexpr int around = 360;
    std::vector<double> places;
    std::vector<VectorXd> q;
    const double by = poses.is_angle() ? 2 * std::numbers::pi / around : 0.01 * poses.unit();
    poses.sample(by, around, places, q);
    const auto e = mechanism->evaluation<double>();
    const auto markers = static_cast<int>(mechanism->scene().markers.size());
    VectorXd nearest = VectorXd::Constant(wanted_.poses(), INFINITY);
    for (std::size_t k = 0; k < q.size(); ++k) {
      const VectorXd y = quantities_at(*e, q[k], wanted_.quantities, markers);
      VectorXd apart = VectorXd::Zero(wanted_.poses());
      for (const WantedValue& a : asked_)
        apart[a.pose] +=
            std::pow((y[a.quantity] - wanted_.values(a.pose, a.quantity)) / weight(a.quantity), 2);
      for (Eigen::Index i = 0; i < apart.size(); ++i)
        if (apart[i] < nearest[i]) {
          nearest[i] = apart[i];
          x[parameters.size() + i] = places[k];
        }
    }
    if (nearest.allFinite()) return true;
    why_ = "positions of the path are not finite";
  } catch (const SceneError& e) {
    why_ = e.what();
  }
  return false;
}

bool WantedError::evaluate(const VectorXd& x, VectorXd& r, MatrixXd* jacobian) {
  try {
    const VectorXd values = x.head(parameters());
    const std::unique_ptr<Mechanism> mechanism = family_.at(values);
    SweptPoses poses(*mechanism, sweep_);
    std::vector<VectorXd> q;
    const std::vector<double> at = places(x);
    if (!poses.reach(at, q)) {
      why_ = poses.why();
      return false;
    }
    const auto e = mechanism->evaluation<double>();
    const auto markers = static_cast<int>(mechanism->scene().markers.size());
    MatrixXd y(wanted_.poses(), wanted_.values.cols());
    for (std::size_t i = 0; i < q.size(); ++i)
      y.row(static_cast<Eigen::Index>(i)) =
          quantities_at(*e, q[i], wanted_.quantities, markers).transpose();
    r.resize(residuals());
    for (Eigen::Index n = 0; n < r.size(); ++n) {
      const auto [i, k] = asked_[static_cast<std::size_t>(n)];
      r[n] = (y(i, k) - wanted_.values(i, k)) / weight(k);
    }
    if (!r.allFinite()) {
      why_ = "what is wanted has no finite value";
      return false;
    }
    if (jacobian) {
      std::vector<MatrixXd> by;
      std::size_t lost = 0;
      if (!derivatives_.at(values, *mechanism, poses.rate(), q, by, lost)) {
        why_ = "at " + sweep_ + " = " + reading::digits(at[lost]) +
               " the pose is a dead point or a change point, where it has no derivatives";
        return false;
      }
      jacobian->setZero(residuals(), unknowns());
      for (Eigen::Index n = 0; n < r.size(); ++n) {
        const auto [i, k] = asked_[static_cast<std::size_t>(n)];
        const MatrixXd& of = by[static_cast<std::size_t>(i)];
        jacobian->row(n).head(parameters()) = of.row(k).head(parameters()) / weight(k);
        if (free()) (*jacobian)(n, parameters() + i) = of(k, parameters()) / weight(k);
      }
      if (!jacobian->allFinite()) {
        why_ = "what is wanted has no finite derivatives";
        return false;
      }
    }
    reached_ = std::move(y);
    return true;
  } catch (const SceneError& e) {
    why_ = e.what();
    return false;
  }
}

WantedErrors errors_of(const WantedPoses& wanted, const MatrixXd& reached, const VectorXd& r) {
  WantedErrors errors;
  errors.cost = 0.5 * r.squaredNorm();
  for (const bool angles : {false, true}) {
    double squares = 0, most = 0;
    long count = 0;
    for (Eigen::Index k = 0; k < wanted.values.cols(); ++k) {
      if ((wanted.quantities[static_cast<std::size_t>(k)].unit == "rad") != angles) continue;
      for (Eigen::Index i = 0; i < wanted.poses(); ++i) {
        const double off = reached(i, k) - wanted.values(i, k);
        if (std::isnan(wanted.values(i, k))) continue;
        squares += off * off;
        most = std::max(most, std::abs(off));
        ++count;
      }
    }
    if (count == 0) continue;
    (angles ? errors.angle_rms : errors.length_rms) =
        std::sqrt(squares / static_cast<double>(count));
    (angles ? errors.angle_most : errors.length_most) = most;
  }
  return errors;
}

}  // namespace momenta
