#include <momenta/core/scalar/sixth_order.h>
#include <momenta/core/text/near_name.h>
#include <momenta/dae/assembly/scaled_loops.h>
#include <momenta/dae/dense/decompositions.h>
#include <momenta/dae/fit/pose_derivatives.h>

#include <cmath>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double independent = 1e-9;  // pivots of F_q, beside the largest

/// ∂Φ/∂θ_j and ∂y/∂θ_j of one pose, at the same q.
struct Partial {
  VectorXd phi, y;
};

}  // namespace

VectorXd quantities_at(Evaluation<double>& e, const VectorXd& q,
                       const std::vector<WantedPoses::Quantity>& quantities, int markers) {
  std::vector<double> places(6 * static_cast<std::size_t>(markers));
  e.place(0, q.data());
  e.move(nullptr);
  e.markers(places.data());
  VectorXd y(static_cast<Eigen::Index>(quantities.size()));
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    const auto& quantity = quantities[static_cast<std::size_t>(k)];
    y[k] = quantity.coordinate >= 0
               ? q[quantity.coordinate]
               : places[static_cast<std::size_t>(6 * quantity.marker + quantity.component)];
  }
  return y;
}

PoseDerivatives::PoseDerivatives(const ParametricMechanism& family, VectorXd sizes,
                                 std::vector<WantedPoses::Quantity> quantities)
    : family_(family), sizes_(std::move(sizes)), quantities_(std::move(quantities)) {}

bool PoseDerivatives::at(const VectorXd& values, const Mechanism& mechanism, int rate,
                         const std::vector<VectorXd>& poses, std::vector<MatrixXd>& derivatives,
                         std::size_t& lost) const {
  const int nv = mechanism.nv(), m = mechanism.m();
  const auto parameters = static_cast<int>(values.size());
  const auto markers = static_cast<int>(mechanism.scene().markers.size());
  const auto count = static_cast<Eigen::Index>(quantities_.size());
  std::vector<std::vector<Partial>> partials(
      poses.size(), std::vector<Partial>(static_cast<std::size_t>(parameters),
                                         {VectorXd::Zero(m), VectorXd::Zero(count)}));
  for (int j = 0; j < parameters; ++j) {
    const double h = sixth_order::part * sizes_[j];
    for (const auto& [k, of_point] : sixth_order::points) {
      VectorXd near = values;
      near[j] += k * h;
      const std::unique_ptr<Mechanism> other = family_.at(near);
      if (other->nq() != mechanism.nq() || other->nv() != nv || other->m() != m)
        throw SceneError("with " + family_.names()[static_cast<std::size_t>(j)] + " = " +
                         reading::digits(near[j]) +
                         " the mechanism has other coordinates or equations; expected a "
                         "parameter that changes numbers alone");
      const auto e = other->evaluation<double>();
      VectorXd phi(m);
      const double weight = of_point / h;
      for (std::size_t i = 0; i < poses.size(); ++i) {
        Partial& partial = partials[i][static_cast<std::size_t>(j)];
        partial.y += weight * quantities_at(*e, poses[i], quantities_, markers);
        e->positions(phi.data());
        partial.phi += weight * phi;
      }
    }
  }
  // A coordinate is no function of θ at the same q: its differences are rounding.
  for (auto& of_pose : partials)
    for (Partial& partial : of_pose)
      for (Eigen::Index k = 0; k < count; ++k)
        if (quantities_[static_cast<std::size_t>(k)].coordinate >= 0) partial.y[k] = 0;

  ScaledLoops loops(mechanism);
  Evaluation<double>& e = loops.evaluation();
  MatrixXd Fq(m + 1, nv);
  VectorXd right(m + 1), qdot(mechanism.nq());
  std::vector<double> moved(6 * static_cast<std::size_t>(markers));
  derivatives.assign(poses.size(), MatrixXd::Zero(count, parameters + 1));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    loops.gap(0, poses[i]);  // places it
    Fq.setZero();
    const std::vector<double> entries = loops.jacobian();
    for (std::size_t k = 0; k < entries.size(); ++k)
      Fq(loops.pattern()[k].row, loops.pattern()[k].column) += entries[k];
    Fq(m, rate) = 1;
    Eigen::ColPivHouseholderQR<MatrixXd> qr(Fq);
    qr.setThreshold(independent);
    if (qr.rank() < nv) {
      lost = i;
      return false;
    }
    for (int j = 0; j <= parameters; ++j) {
      right.setZero();
      if (j < parameters)
        right.head(m) = -loops.in_units(partials[i][static_cast<std::size_t>(j)].phi);
      else
        right[m] = 1 / loops.units().rates[rate];
      const VectorXd u = qr.solve(right).cwiseProduct(loops.units().rates);
      e.place(0, poses[i].data());
      e.move(u.data());
      e.markers(moved.data());
      qdot.setZero();
      e.coordinate_rates(poses[i].data(), u.data(), qdot.data());
      for (Eigen::Index k = 0; k < count; ++k) {
        const auto& quantity = quantities_[static_cast<std::size_t>(k)];
        derivatives[i](k, j) =
            quantity.coordinate >= 0
                ? qdot[quantity.coordinate]
                : moved[static_cast<std::size_t>(6 * quantity.marker + 3 + quantity.component)];
        if (j < parameters) derivatives[i](k, j) += partials[i][static_cast<std::size_t>(j)].y[k];
      }
    }
  }
  return true;
}

}  // namespace momenta
