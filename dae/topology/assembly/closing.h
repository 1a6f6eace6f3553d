#pragma once
// Positions that close the loops, Φ(q, t) = 0, from a guess: the pose the guess means where it is
// near, else one that exists. In units of the assembly, J = D⁻¹ Φ_q C, φ = D⁻¹ Φ:
//
//   damped      δ = −J⁺ φ, shortened until |φ| shrinks; where J⁺ asks, through pivots as small as
//               the gap, for steps that lead nowhere, δ = −(JᵀJ + |φ|²)⁻¹ Jᵀ φ. It stays near the
//               guess, and ends where |φ| has a least value other than zero.
//   continued   q' = −(JᵀJ + |φ|²)⁻¹ Jᵀ φ in steps of at most 0.05: the gap closes continuously.
//   undamped    δ = −J⁺ φ whether |φ| shrinks or not. At a stretched pose, q = 0 of many parallel
//               robots, no short step closes the loops further, and long ones leave it.
//   least squares   where the equations are redundant and the numbers of the scene, rounded in its
//               file, contradict each other by 10⁻⁶ at the most, no pose closes the loops: one where
//               nothing of φ can be closed, J J⁺ φ = 0, then stands for it. Rows that lose rank
//               because rods are stretched contradict nothing (bending.h): the pose beside it that
//               closes is taken, or the loop is too short.
//   seeds       damped from starts around the guess, 0.3, 1 and 3 radians or lengths away: of the
//               first distance at which some close the one nearest to the guess.
//
// The first two are tried wherever Newton's steps go far, the others only where both stay open.

#include <momenta/dae/kkt/least_norm.h>
#include <momenta/dae/topology/assembly/scaled_loops.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace momenta {

class Closing {
 public:
  /// Steps solved by `steps`; joints whose columns `loops` leaves out stay.
  Closing(ScaledLoops& loops, LeastNorm& steps, double t);

  struct Pose {
    Eigen::VectorXd q;
    double gap = 0;  ///< |Φ|∞, points in lengths
    bool is_closed = false;
    bool is_least = false;      ///< closed in the least-squares sense alone
    bool is_stretched = false;  ///< open, and no motion closes it further
  };
  /// One of Newton's steps, q ← moved(q, s δ) with the whole δ = −J⁺φ: s = part, and where δ was
  /// cut to a longest length part / |δ|∞.
  struct NewtonStep {
    Eigen::VectorXd q, whole;
    double part = 1;
    bool is_cut = false;
  };
  /// From the guess q. Cost: least-norm factorisations of Φ_q, 10 to 200 where it closes; up to
  /// 5000 where nothing does.
  Pose close(const Eigen::VectorXd& guess);
  /// The `wanted` pose nearest to the guess of those that close from seeds; open where there is
  /// none.
  Pose from_seeds(const Eigen::VectorXd& guess, const std::function<bool(const Pose&)>& wanted);
  /// From q by damped steps alone: the pose beside it, where there is one.
  Pose beside(const Eigen::VectorXd& q) { return damped(q, seed_iterations); }

  /// The steps of the last close(), from the guess to the pose; none where others were among them.
  const std::optional<std::vector<NewtonStep>>& newton_steps() const { return newton_; }
  double tolerance() const { return tolerance_; }  ///< for |Φ|∞, in units
  int iterations() const { return iterations_; }
  /// One sentence on which of several assemblies this is, where the guess does not decide it at
  /// once; else empty.
  const std::string& branch() const { return branch_; }

 private:
  struct Trial;
  static constexpr int seed_iterations = 60;
  Eigen::VectorXd gap(const Eigen::VectorXd& q) { return loops_.gap(t_, q); }
  Trial along(const Eigen::VectorXd& q, double norm, Eigen::VectorXd step);
  Eigen::VectorXd damped_step(const std::vector<double>& j, const Eigen::VectorXd& phi);
  Pose damped(Eigen::VectorXd q, int most_iterations);
  bool is_redundant(const std::vector<double>& j);
  bool is_least(const Eigen::VectorXd& q, double gap);
  bool is_stretched(const Eigen::VectorXd& q);
  Pose bent(const Pose& open);
  bool follow(Eigen::VectorXd& q);
  Pose undamped(Eigen::VectorXd q);
  Pose anywhere(const Eigen::VectorXd& guess, Pose open);

  ScaledLoops& loops_;
  LeastNorm& steps_;
  double t_, tolerance_;
  int iterations_ = 0;
  std::string branch_;
  std::optional<std::vector<NewtonStep>> newton_;  ///< steps of the last damped()
};

}  // namespace momenta
