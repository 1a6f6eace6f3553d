#pragma once
// A quantity of a motion, g(t, q, u; θ), as a formula of t, parameters and names of trajectory.csv:
// coordinates, rates, positions and velocities of markers, `energy`. Its derivative along
// directions,
//
//   dg = Σ ∂g/∂z dz + ∂g/∂θ,
//
// with ∂g/∂z by tapes (core/expression/gradient.cpp), dz of coordinates and rates as they are, of
// markers by dual numbers, of the energy T + V by differences of sixth order.

#include <momenta/core/expression/expression.h>
#include <momenta/dae/gradient/row_derivatives.h>
#include <momenta/dae/gradient/run_variable.h>
#include <momenta/dae/mechanism/marker_motion.h>

#include <memory>
#include <string>
#include <vector>

namespace momenta {

class Functional {
 public:
  /// The mechanism must outlive it. @throws std::invalid_argument: one sentence on the formula
  Functional(const std::string& formula, const Mechanism& mechanism,
             const std::vector<RunVariable>& variables, const std::vector<OtherParameter>& others);
  ~Functional();

  /// g at t [s], q (nq), u (nv), and dg (variables) along dq, du (rows × variables). O(bodies) a
  /// variable with markers or the energy, else the formula alone
  double operator()(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                    const Eigen::MatrixXd& dq, const Eigen::MatrixXd& du, Eigen::VectorXd& dg);

  /// A function in the formula with corners or jumps; empty: none.
  std::string corner() const { return corner_; }

 private:
  struct Name;
  void take_markers(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                    const Eigen::MatrixXd& dq, const Eigen::MatrixXd& du);
  void take_energy(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                   const Eigen::MatrixXd& dq, const Eigen::MatrixXd& du);
  double energy(Evaluation<double>& e, double t, const Eigen::VectorXd& q,
                const Eigen::VectorXd& u) const;

  const Mechanism& mechanism_;
  const std::vector<OtherParameter>& others_;
  std::vector<Name> names_;  ///< variables of the formula
  std::unique_ptr<Expression> formula_;
  std::string corner_;
  std::vector<int> used_;
  std::unique_ptr<Evaluation<double>> e_;
  std::unique_ptr<MarkerMotion<Dual8>> markers_;
  Eigen::VectorXd marker_values_;
  Eigen::MatrixXd marker_tangents_;
  double energy_ = 0;
  Eigen::VectorXd energy_tangents_;
  bool takes_energy_ = false;
  std::vector<double> x_, line_, values_;
};

// The slopes of a functional g(t, q, u; θ): g_q, g_u, and g_θ at constant q and u.

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
