#pragma once
// A function of a motion, made smooth where it takes extremes. The largest of many functions has
// corners where two of them are equal. If f grows with such an extreme, it is below a number
// exactly if it is so with some τ in the extreme's place that bounds them all,
//
//   f(θ, τ),   g(q_i, θ) − τ ≤ 0  at each pose i,
//
// all smooth in (θ, τ); for a minimum that f falls with, τ − g ≤ 0. Other extremes are taken at the
// pose where they occur.

#include <momenta/dae/study/fit/motion_parts.h>

#include <vector>

namespace momenta {

/// f(θ, τ) and its bounds.
class BoundedFunction {
 public:
  /// `f` must outlive it.
  explicit BoundedFunction(const MotionFunction& f) : f_(&f) {}

  /// Chooses the extremes to bound: those that f grows with at this motion.
  void choose(const MotionValues& first);
  /// Entries of τ.
  Eigen::Index unknowns() const { return static_cast<Eigen::Index>(bounded_.size()); }
  Eigen::Index rows() const { return rows_; }  ///< bounds
  /// τ at the extremes, and its sizes, > 0.
  void start(const MotionValues& values, Eigen::Ref<Eigen::VectorXd> tau,
             Eigen::Ref<Eigen::VectorXd> sizes) const;
  /// f, and its derivatives unless null.
  double at(const MotionValues& values, const Eigen::VectorXd& tau, Eigen::VectorXd* by_theta,
            Eigen::VectorXd* by_tau) const;
  /// Bounds, and their derivatives by θ and τ unless null.
  void bounds(const MotionValues& values, const Eigen::VectorXd& tau,
              Eigen::Ref<Eigen::VectorXd> rows, Eigen::MatrixXd* by_theta,
              Eigen::MatrixXd* by_tau) const;

 private:
  const MotionFunction* f_;
  std::vector<std::size_t> bounded_;  ///< bounded parts of f
  Eigen::Index rows_ = 0;
};

}  // namespace momenta
