#pragma once
// Columns of a reference beside q, u and λ: efforts of drives and reactions of joints, by Newton's
// and Euler's equations with the u̇ and λ of quadruple precision at the state rounded to doubles; p
// = M u; and the work of drives and of what has no potential, as what T + V has grown by. A run
// integrates the power of the same forces, so that its work and this one share no formula.
//
// Values that redundant loops leave open at any time make no column, nor do loads out of the plane
// of planar mechanisms, nor work where nothing can do any.

#include <momenta/dae/study/force_columns.h>

#include <string>
#include <vector>

namespace momenta {

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
