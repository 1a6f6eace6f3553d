#include <momenta/core/scalar/sixth_order.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/algebra/dense/decompositions.h>
#include <momenta/dae/study/fit/pose_derivatives.h>
#include <momenta/dae/topology/assembly/scaled_loops.h>

#include <cmath>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double independent = 1e-9;  // least pivot of F_q over the largest

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
  const Eigen::Index whole = count + m;  // y and Φ of a pose
  std::vector<VectorXd> partials;        // by θ_j, at the same q, pose by pose
  for (int j = 0; j < parameters; ++j) {
    const double widest = sixth_order::part * sizes_[j];
    const auto at_point = [&](std::size_t point, double h) {
      VectorXd near = values;
      near[j] += sixth_order::k_of(point) * h;
      const std::unique_ptr<Mechanism> other = family_.at(near);
      if (other->nq() != mechanism.nq() || other->nv() != nv || other->m() != m)
        throw SceneError("with " + family_.names()[static_cast<std::size_t>(j)] + " = " +
                         reading::digits(near[j]) +
                         " the mechanism has other coordinates or equations; expected a "
                         "parameter that changes numbers alone");
      const auto e = other->evaluation<double>();
      VectorXd all(whole * static_cast<Eigen::Index>(poses.size()));
      for (std::size_t i = 0; i < poses.size(); ++i) {
        const auto first = whole * static_cast<Eigen::Index>(i);
        all.segment(first, count) = quantities_at(*e, poses[i], quantities_, markers);
        e->positions(all.data() + first + count);
      }
      return all;
    };
    partials.push_back(sixth_order::slope_of(widest, sixth_order::exact, at_point).by);
  }

  ScaledLoops loops(mechanism);
  Evaluation<double>& e = loops.evaluation();
  MatrixXd Fq(m + 1, nv);
  VectorXd right(m + 1), qdot(mechanism.nq());
  std::vector<double> moved(6 * static_cast<std::size_t>(markers));
  derivatives.assign(poses.size(), MatrixXd::Zero(count, parameters + 1));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto first = whole * static_cast<Eigen::Index>(i);
    loops.gap(0, poses[i]);  // places e
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
        right.head(m) =
            -loops.in_units(partials[static_cast<std::size_t>(j)].segment(first + count, m));
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
        // A coordinate is no function of θ at the same q: its differences are rounding.
        if (j < parameters && quantity.coordinate < 0)
          derivatives[i](k, j) += partials[static_cast<std::size_t>(j)][first + k];
      }
    }
  }
  return true;
}

}  // namespace momenta
