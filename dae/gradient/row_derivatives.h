#pragma once
// Total derivatives of rows of the equations, r(x; θ), along directions j:
//
//   dr_j = (∂r/∂x) dx_j + ∂r/∂θ_j,
//
// the first exact, by dual numbers, eight directions at a time; the second from mechanisms with
// other θ_j at the same x (neighbours.h), whose formulas are linear in θ_j (linear_formulas.h).

#include <momenta/dae/gradient/neighbours.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <vector>

namespace momenta {

/// A run's knowledge about θ_j beside its own mechanism.
struct OtherParameter {
  double h = 0;  ///< widest
  /// Slopes by θ_j of the numbers of number_slopes.h, where θ_j changes these alone; else empty.
  Eigen::VectorXd numbers;
  bool of_places = false;  ///< places of joints, loops or springs are among these, or `laws`
  /// Drives of the tree, if θ_j changes laws; their numbers are not in `numbers`.
  std::size_t drives = 0;
  Eigen::VectorXd at_start;     ///< like `numbers`, where only the start is made of them
  bool starts_at_once = false;  ///< start_adjoint.h has the start's slope by θ_j
  /// Null: only the start, or numbers taken at once, depend on θ_j.
  std::unique_ptr<Neighbours> near;
  bool by_mechanisms = false;  ///< `near` has mechanisms; else laws alone
  /// Whether rows are differenced.
  bool by_rows() const { return by_mechanisms && numbers.size() == 0; }
};

/// ∂r/∂θ of `size` rows at x.
template <class Rows>
const Eigen::VectorXd& slope_of_rows(Neighbours& near, const Rows& rows, const Eigen::VectorXd& x,
                                     Eigen::Index size) {
  return near.slope_of_rows(size, [&](Evaluation<double>& e, Eigen::VectorXd& out) {
    rows(static_cast<EquationRows<double>&>(e), x.data(), out.data());
  });
}

/// sum_j += weightsᵀ ∂r/∂θ_j of the θ_j with by_rows().
template <class Rows>
void add_by_parameters(const std::vector<OtherParameter>& others, const Rows& rows,
                       const Eigen::VectorXd& x, const Eigen::VectorXd& weights,
                       Eigen::VectorXd& sum) {
  for (std::size_t j = 0; j < others.size(); ++j) {
    if (others[j].by_rows())
      sum[static_cast<Eigen::Index>(j)] +=
          weights.dot(slope_of_rows(*others[j].near, rows, x, weights.size()));
  }
}

class RowDerivatives {
 public:
  /// The mechanism and `others`, one a direction, must outlive it.
  RowDerivatives(const Mechanism& mechanism, const std::vector<OtherParameter>& others)
      : others_(others), dual_(mechanism.evaluation<Dual8>()), elsewhere_(others.size()) {}

  /// Leaves ∂r/∂θ of these zero: others add it.
  void leave_out(const std::vector<bool>& parameters) { elsewhere_ = parameters; }
  /// Whether other mechanisms are evaluated for some parameter.
  bool any_parameters() const {
    for (std::size_t j = 0; j < others_.size(); ++j)
      if (!elsewhere_[j] && others_[j].by_mechanisms) return true;
    return false;
  }

  Eigen::Index directions() const { return static_cast<Eigen::Index>(others_.size()); }

  /// (∂r/∂x) dx, size × directions, of the rows that `rows(e, x, out)` fills for any scalar; dx:
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

  /// ∂r/∂θ, size × directions. Cost: seven plain evaluations or more for each parameter.
  template <class Rows>
  Eigen::MatrixXd by_parameters(const Rows& rows, const Eigen::VectorXd& x, Eigen::Index size) {
    Eigen::MatrixXd d = Eigen::MatrixXd::Zero(size, directions());
    for (Eigen::Index j = 0; j < d.cols(); ++j) {
      const OtherParameter& other = others_[static_cast<std::size_t>(j)];
      if (!elsewhere_[static_cast<std::size_t>(j)] && other.by_mechanisms)
        d.col(j) = slope_of_rows(*other.near, rows, x, size);
    }
    return d;
  }

  /// (∂r/∂x) dx + ∂r/∂θ.
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
};

}  // namespace momenta
