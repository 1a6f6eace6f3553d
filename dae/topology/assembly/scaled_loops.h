#pragma once
// The loop equations in the units of an assembly: D⁻¹ Φ, and D⁻¹ Φ_q C with respect to steps
// δ = C⁻¹ u, lengths counted in the length of the scene. Rows and columns can be left out.

#include <momenta/dae/kkt/loop_units.h>

#include <memory>
#include <vector>

namespace momenta {

class ScaledLoops {
 public:
  explicit ScaledLoops(const Mechanism& mechanism);

  /// Leaves out the columns of joints that the scene's assembly holds.
  void hold_joints();

  /// D⁻¹ Φ at time t [s] and q (nq), m; zero in rows that are left out. Places the evaluation.
  Eigen::VectorXd gap(double t, const Eigen::VectorXd& q);
  /// Entries of D⁻¹ Φ_q C where gap() was taken last, in the order of pattern(); zero in columns
  /// and rows that are left out.
  std::vector<double> jacobian();
  /// q after a step δ (nv).
  Eigen::VectorXd moved(const Eigen::VectorXd& q, const Eigen::VectorXd& step);
  /// D⁻¹ x (m), zero in rows that are left out.
  Eigen::VectorXd in_units(Eigen::VectorXd x) const;
  /// Largest change of a coordinate between two poses, in units.
  double apart(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const;

  const Mechanism& mechanism() const { return mechanism_; }
  Evaluation<double>& evaluation() { return *e_; }
  const std::vector<KktPattern::Entry>& pattern() const { return pattern_; }
  const LoopUnits& units() const { return units_; }

  std::vector<bool> columns,
      rows;  ///< in use; at first all columns and the rows of positions

 private:
  const Mechanism& mechanism_;
  std::unique_ptr<Evaluation<double>> e_;
  const std::vector<KktPattern::Entry>& pattern_;  ///< pattern of Φ_q
  LoopUnits units_;
};

}  // namespace momenta
