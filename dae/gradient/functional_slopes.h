#pragma once
// The slopes of a functional g(t, q, u; θ): g_q, g_u, and g_θ at constant q and u.

#include <momenta/dae/gradient/functional.h>

namespace momenta {

class FunctionalSlopes {
 public:
  /// `mechanism` without quaternions; it and `others` must outlive it. @throws as Functional
  FunctionalSlopes(const std::string& formula, const Mechanism& mechanism,
                   const std::vector<RunVariable>& variables,
                   const std::vector<OtherParameter>& others);

  /// g at t [s], q, u (nv each), its slopes by them (nv each) and by θ (variables). O(nv bodies)
  /// where the formula takes markers or the energy, else O(nv)
  double at(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u, Eigen::VectorXd& by_q,
            Eigen::VectorXd& by_u, Eigen::VectorXd& by_parameters);

  std::string corner() const { return of_state_.corner(); }

 private:
  Eigen::Index n_;
  std::vector<OtherParameter> none_;  ///< directions of the state
  Eigen::MatrixXd along_q_, along_u_, still_;
  Functional of_state_, of_parameters_;
  Eigen::VectorXd slopes_;
};

}  // namespace momenta
