#pragma once
// A reference solution made by the program itself. Its form and integrator differ from those that
// it judges: the acceleration form, projected at every step, with extrapolation in quadruple
// precision. A second solution with a looser tolerance gives an estimate of its error.
//
// Where an explicit method in doubles finds the motion stiff (solver/stiffness.h), steps of the
// extrapolated midpoint rule would be held by its stability, 10⁵ evaluations a second of motion and
// more; there Radau's method of order 17 takes its place (solver/radau_collocation.h).

#include <momenta/dae/form/form.h>
#include <momenta/dae/run/force_columns.h>
#include <momenta/dae/run/measure/reference.h>

#include <functional>
#include <string>
#include <vector>

namespace momenta {

struct OwnReference {
  Reference reference;
  double accuracy = 0;    ///< largest distance of the two solutions, as errors are measured
  bool implicit = false;  ///< stiff motion: made by the implicit method
};

/// Joint coordinates, rates and multipliers λ at `count` equal intervals up to `end` [s], bound to
/// measured_columns(). With `forces` also ∫λ dt, integrated beside q and u, where the loop
/// equations are independent at the start; and efforts, reactions, momenta and work
/// (own_reference.h). `going_on` (may be empty) takes the time reached; false stops. @throws
/// std::runtime_error with one sentence without a solution.
OwnReference own_reference(const Mechanism& mechanism, const Start& start, double end, int count,
                           const std::function<bool(double t)>& going_on = {}, bool forces = false);

/// "quadruple precision: acceleration form …; two tolerances agree to 2e-17"
std::string in_words(const OwnReference& own);

// Columns of a reference beside q, u and λ: efforts of drives and reactions of joints, by Newton's
// and Euler's equations with the u̇ and λ of quadruple precision at the state rounded to doubles; p
// = M u; and the work of drives and of what has no potential, as what T + V has grown by. A run
// integrates the power of the same forces, so that its work and this one share no formula.
//
// Values that redundant loops leave open at any time make no column, nor do loads out of the plane
// of planar mechanisms, nor work where nothing can do any.

class OwnReferenceForces {
 public:
  explicit OwnReferenceForces(const Mechanism& mechanism);

  /// Adds the values at the next time; u̇ (nv), λ (m) of (3) there.
  void add(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
           const Eigen::VectorXd& udot, const Eigen::VectorXd& lambda);
  /// Appends the columns, and their values to each row, in order of add().
  void append(std::vector<std::string>& columns, std::vector<std::vector<double>>& rows) const;

 private:
  const Mechanism& mechanism_;
  std::unique_ptr<Evaluation<double>> e_;
  std::unique_ptr<LoopSolver> solver_;  ///< null without loops
  ForceColumns forces_;
  bool works_;
  std::vector<std::string> columns_;
  std::vector<std::vector<double>> rows_;
  std::vector<double> momenta_;
};

}  // namespace momenta
