#pragma once
// A function of a motion, made smooth where it takes extremes. The largest of many functions has
// corners where two of them are equal. f with an extreme that it grows with is less than a number
// exactly if f is with some τ in its place that bounds them all,
//
//   f(θ, τ),   g(q_i, θ) − τ ≤ 0  at each pose i,
//
// all smooth in (θ, τ); of a smallest one that it falls with, τ − g ≤ 0. Other extremes are taken
// at the pose where they are.

#include <momenta/dae/fit/motion_parts.h>

#include <vector>

namespace momenta {

/// f(θ, τ) and its bounds.
class BoundedFunction {
 public:
  /// Which must outlive it.
  explicit BoundedFunction(const MotionFunction& f) : f_(&f) {}

  /// Which extremes are bounded: those that f grows with at this motion.
  void choose(const MotionValues& first);
  Eigen::Index unknowns() const { return static_cast<Eigen::Index>(bounded_.size()); }  ///< of τ
  Eigen::Index rows() const { return rows_; }  ///< of bounds
  /// τ where the extremes are, and what it counts in, > 0.
  void start(const MotionValues& values, Eigen::Ref<Eigen::VectorXd> tau,
             Eigen::Ref<Eigen::VectorXd> sizes) const;
  /// f, and its derivatives where these are asked for.
  double at(const MotionValues& values, const Eigen::VectorXd& tau, Eigen::VectorXd* by_theta,
            Eigen::VectorXd* by_tau) const;
  /// Bounds; their derivatives, by θ and by τ, where these are not null.
  void bounds(const MotionValues& values, const Eigen::VectorXd& tau,
              Eigen::Ref<Eigen::VectorXd> rows, Eigen::MatrixXd* by_theta,
              Eigen::MatrixXd* by_tau) const;

 private:
  const MotionFunction* f_;
  std::vector<std::size_t> bounded_;  ///< among its parts
  Eigen::Index rows_ = 0;
};

}  // namespace momenta
