#pragma once
// Total derivatives of rows of the equations, r(x; θ), along directions j:
//
//   dr_j = (∂r/∂x) dx_j + ∂r/∂θ_j,
//
// the first exact, by dual numbers, eight directions at a time; the second by sixth_order.h, from
// evaluations of the mechanism with other θ_j at the same x.

#include <momenta/core/scalar/sixth_order.h>
#include <momenta/core/scene/drive.h>
#include <momenta/dae/mechanism.h>

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <vector>

namespace momenta {

/// Evaluations at θ_j + k h, in the order of sixth_order::points; none: nothing depends on θ_j but
/// where the motion starts, or numbers that are taken at once. `numbers`: derivatives by θ_j of the
/// numbers of number_slopes.h, where θ_j changes these alone; else empty.
struct OtherParameter {
  double h = 0;
  Eigen::VectorXd numbers;
  bool of_places = false;  ///< places of joints, loops or springs are among these, or `laws`
  /// The laws of the tree's drives at θ_j + k h, in the order of sixth_order::points, where θ_j
  /// changes some; else empty. Numbers of drives are left out of `numbers`.
  std::vector<std::vector<MotionLaw>> laws;
  Eigen::VectorXd at_start;     ///< the same where the start alone is made of them, rows are not
  bool starts_at_once = false;  ///< what the start has of θ_j is that of start_adjoint.h
  std::vector<std::unique_ptr<Mechanism>> mechanisms;
  std::vector<std::unique_ptr<Evaluation<double>>> evaluations;
};

/// sum_j += weightsᵀ ∂r/∂θ_j of those that are not taken by numbers. `plain`: a workspace.
template <class Rows>
void add_by_parameters(const std::vector<OtherParameter>& others, const Rows& rows,
                       const Eigen::VectorXd& x, const Eigen::VectorXd& weights,
                       Eigen::VectorXd& plain, Eigen::VectorXd& sum) {
  plain.resize(weights.size());
  for (std::size_t j = 0; j < others.size(); ++j) {
    const OtherParameter& other = others[j];
    if (other.numbers.size() > 0) continue;
    for (std::size_t k = 0; k < other.evaluations.size(); ++k) {
      rows(static_cast<EquationRows<double>&>(*other.evaluations[k]), x.data(), plain.data());
      sum[static_cast<Eigen::Index>(j)] +=
          sixth_order::points[k].weight / other.h * weights.dot(plain);
    }
  }
}

class RowDerivatives {
 public:
  /// The mechanism and `others`, one a direction, must outlive it.
  RowDerivatives(const Mechanism& mechanism, const std::vector<OtherParameter>& others)
      : others_(others), dual_(mechanism.evaluation<Dual8>()), elsewhere_(others.size()) {}

  /// By these parameters ∂r/∂θ stays zero: it is added by somebody else.
  void leave_out(const std::vector<bool>& parameters) { elsewhere_ = parameters; }
  /// Whether some parameter is taken by evaluations of other mechanisms.
  bool any_parameters() const {
    for (std::size_t j = 0; j < others_.size(); ++j)
      if (!elsewhere_[j] && !others_[j].evaluations.empty()) return true;
    return false;
  }

  Eigen::Index directions() const { return static_cast<Eigen::Index>(others_.size()); }

  /// (∂r/∂x) dx, size × directions, of `rows(e, x, out)`, rows of any scalar, `size` of them; dx:
  /// x's size × directions. Cost: an evaluation in dual numbers for eight directions.
  template <class Rows>
  Eigen::MatrixXd along(const Rows& rows, const Eigen::VectorXd& x, const Eigen::MatrixXd& dx,
                        Eigen::Index size) {
    Eigen::MatrixXd d(size, directions());
    x_.resize(static_cast<std::size_t>(x.size()));
    out_.resize(static_cast<std::size_t>(size));
    for (Eigen::Index first = 0; first < d.cols(); first += width) {
      const Eigen::Index count = std::min(width, d.cols() - first);
      for (std::size_t i = 0; i < x_.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        x_[i] = Dual8(x[at]);
        for (Eigen::Index k = 0; k < count; ++k)
          x_[i].b[static_cast<std::size_t>(k)] = dx(at, first + k);
      }
      rows(static_cast<EquationRows<Dual8>&>(*dual_), x_.data(), out_.data());
      for (std::size_t i = 0; i < out_.size(); ++i)
        for (Eigen::Index k = 0; k < count; ++k)
          d(static_cast<Eigen::Index>(i), first + k) = out_[i].b[static_cast<std::size_t>(k)];
    }
    return d;
  }

  /// ∂r/∂θ, size × directions. Cost: six plain evaluations for each parameter.
  template <class Rows>
  Eigen::MatrixXd by_parameters(const Rows& rows, const Eigen::VectorXd& x, Eigen::Index size) {
    Eigen::MatrixXd d = Eigen::MatrixXd::Zero(size, directions());
    plain_.resize(size);
    for (Eigen::Index j = 0; j < d.cols(); ++j) {
      const OtherParameter& other = others_[static_cast<std::size_t>(j)];
      if (elsewhere_[static_cast<std::size_t>(j)]) continue;
      for (std::size_t k = 0; k < other.evaluations.size(); ++k) {
        rows(static_cast<EquationRows<double>&>(*other.evaluations[k]), x.data(), plain_.data());
        d.col(j) += sixth_order::points[k].weight / other.h * plain_;
      }
    }
    return d;
  }

  /// Both.
  template <class Rows>
  Eigen::MatrixXd operator()(const Rows& rows, const Eigen::VectorXd& x, const Eigen::MatrixXd& dx,
                             Eigen::Index size) {
    return along(rows, x, dx, size) + by_parameters(rows, x, size);
  }

 private:
  static constexpr Eigen::Index width = 8;
  const std::vector<OtherParameter>& others_;
  std::unique_ptr<Evaluation<Dual8>> dual_;
  std::vector<bool> elsewhere_;
  std::vector<Dual8> x_, out_;
  Eigen::VectorXd plain_;
};

}  // namespace momenta
