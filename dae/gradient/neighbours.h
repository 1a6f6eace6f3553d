#pragma once
// Mechanisms of neighbouring values θ + k h of one number of a scene (sixth_order.h). Widths h
// narrow on demand. Slopes by θ of rows, energies and places at a state are differences of their
// values in these mechanisms.

#include <momenta/core/scalar/sixth_order.h>
#include <momenta/core/scene/drive.h>
#include <momenta/dae/gradient/run_variable.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace momenta {

class Neighbours {
 public:
  /// Scenes at θ + k h, in the order of sixth_order::points. @throws SceneError
  using Scenes = std::function<std::vector<Scene>(double h)>;
  /// Neighbours by θ of the mechanism `own`, which must outlive it; h: the widest.
  Neighbours(RunVariable variable, double h, Scenes scenes, const Mechanism& own,
             MechanismOptions options);

  double h() const { return h_; }  ///< the widest that exists
  /// Scenes of the widest width that exists. @throws SceneError
  const std::vector<Scene>& scenes();
  /// Scenes of this width, until its mechanisms are made.
  const std::vector<Scene>& scenes(double h) { return width(h).scenes; }
  /// Makes the mechanisms of the widest width that exists. @throws SceneError where there is none,
  /// or one has other coordinates or equations
  void make();
  const Mechanism& mechanism(std::size_t point, double h) {
    return point == sixth_order::middle ? own_ : *at(h).mechanisms[point];
  }

  /// ∂/∂θ of f(evaluation, numbers), which fills numbers of this size at a state. Sums up the
  /// differences of the formulas of sixth_order.h. Cost: seven plain evaluations, six more for each
  /// further width that the state asks for
  template <class F>
  const Eigen::VectorXd& slope(Eigen::Index size, F&& f) {
    return slope(size, f, 0);
  }
  /// Slope of rows of equations. Rows of corrections vanish but for rounding: slopes are compared
  /// with the largest so far.
  template <class F>
  const Eigen::VectorXd& slope_of_rows(Eigen::Index size, F&& f) {
    slope(size, f, largest_);
    if (size > 0) largest_ = std::max(largest_, slope_.cwiseAbs().maxCoeff());
    return slope_;
  }
  /// Slopes of f, ḟ of a law of the tree's drives at t.
  const Eigen::VectorXd& law_slope(std::size_t drive, double t);

  /// Digits to which the formulas agree so far; 16: no slopes yet.
  double digits() const;

 private:
  struct Width {
    std::vector<Scene> scenes;
    std::vector<std::unique_ptr<Mechanism>> mechanisms;
    std::vector<std::unique_ptr<Evaluation<double>>> evaluations;
    std::vector<std::vector<MotionLaw>> laws;
  };
  Width& width(double h);
  Width& at(double h);
  void take(sixth_order::Slope slope);
  template <class F>
  const Eigen::VectorXd& slope(Eigen::Index size, F&& f, double usual) {
    plain_.resize(size);
    const auto there = [&](std::size_t i, double h) {
      f(i == sixth_order::middle ? own() : *at(h).evaluations[i], plain_);
      return plain_;
    };
    take(sixth_order::slope_of(h_, sixth_order::exact, there, usual));
    return slope_;
  }
  Evaluation<double>& own() {
    if (!here_) here_ = own_.evaluation<double>();
    return *here_;
  }

  RunVariable variable_;
  double h_;
  Scenes scenes_;
  const Mechanism& own_;
  MechanismOptions options_;
  std::array<Width, sixth_order::widths> widths_;
  std::unique_ptr<Evaluation<double>> here_;  ///< evaluation of `own_`
  Eigen::VectorXd plain_, slope_;
  double apart_ = 0, size_ = 0;  ///< sums
  double largest_ = 0;           ///< slope of rows
};

}  // namespace momenta
