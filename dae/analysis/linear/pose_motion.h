#pragma once
// Poses on Φ = 0 near a pose: q ∘ exp δ, then corrections of least change in the mass metric.
//
// Where numbers contradict each other (contradiction.h), Φ returns to its value at the first pose
// instead, by damped steps, −(JᵀJ + λ²)⁻¹ Jᵀ φ, λ a singular value of J that does not count:
// equations independent by rounding alone have no effect. The mass metric removes each step's part
// in the free motions.

#include <momenta/dae/form/coordinate_motion.h>
#include <momenta/dae/kkt/least_norm.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/topology/assembly/contradiction.h>

#include <Eigen/Core>
#include <memory>
#include <optional>

namespace momenta {

class PoseMotion {
 public:
  explicit PoseMotion(const Mechanism& mechanism);

  /// False where the loops do not close; `q` is then invalid.
  bool move(double t, const Eigen::VectorXd& from, const Eigen::VectorXd& delta,
            Eigen::VectorXd& q);
  /// u̇ (nv) and λ (m) of (3) at rest. False where something has no inertia.
  bool let_go(double t, const Eigen::VectorXd& q, Eigen::VectorXd& udot, Eigen::VectorXd& lambda);

  /// Free part y (nv) of a momentum: M y + Φ_qᵀσ = p, Φ_q y = 0. False where something has no
  /// inertia.
  bool free_velocity(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& p,
                     Eigen::VectorXd& y);

  /// M y (nv) at the pose of the evaluation.
  Eigen::VectorXd momentum(const Eigen::VectorXd& y);

  Evaluation<double>& evaluation() { return *e_; }
  /// Relative; larger singular values of Φ_q at the first pose count.
  double pivot() const { return contradiction_ ? contradiction_->pivot : 0; }
  /// Place in u where let_go() failed.
  int singular_joint() const { return solver_ ? solver_->singular_joint() : e_->singular_joint(); }

 private:
  bool close(double t, Eigen::VectorXd& q);
  bool close_least(double t, Eigen::VectorXd& q);

  const Mechanism& mechanism_;
  std::unique_ptr<Evaluation<double>> e_;
  std::unique_ptr<LoopSolver> solver_;  ///< null without loops
  CoordinateMotion motion_;
  Eigen::VectorXd phi_, delta_, rest_;
  double closed_;
  ScaledLoops loops_;
  std::optional<Contradiction> contradiction_;  ///< the first pose's
};

}  // namespace momenta
