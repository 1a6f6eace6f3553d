#pragma once
// Follows paths of a homotopy (homotopy.h), one after the other.

#include <momenta/dae/kinematics/start_system.h>

#include <Eigen/LU>
#include <utility>
#include <vector>

namespace momenta {

enum class PathEnd { finite, infinite, singular, lost };

class PathFollower {
 public:
  /// Follows t γ G + (1 − t) F; steps are `longest` times as long as possible.
  PathFollower(const PolynomialSystem& f, const StartSystem& g, Complex gamma, double longest)
      : f_(f), g_(g), gamma_(gamma), longest_(longest) {}
  /// End of the path from a solution at t = 1.
  std::pair<PathEnd, Eigen::VectorXcd> follow(Eigen::VectorXcd x);

 private:
  std::vector<double> proper(const Eigen::VectorXcd& x) const;
  PathEnd seems_infinite(const Eigen::VectorXcd& x, double t, const std::vector<double>& kept,
                         double since) const;
  void normalise(Eigen::VectorXcd& x) const;
  void evaluate(const Eigen::VectorXcd& x, double t);
  Eigen::VectorXcd slope(const Eigen::VectorXcd& x, double t);
  bool predict(Eigen::VectorXcd& x, double t, double h);
  bool correct(Eigen::VectorXcd& x, double t);
  double polish(Eigen::VectorXcd& x);

  const PolynomialSystem& f_;
  const StartSystem& g_;
  Complex gamma_;
  double longest_;
  Eigen::VectorXcd of_f_, of_g_, value_, by_t_, patch_;
  Eigen::MatrixXcd slopes_f_, slopes_g_, matrix_;
  Eigen::PartialPivLU<Eigen::MatrixXcd> lu_;
};

}  // namespace momenta
