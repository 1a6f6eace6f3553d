#pragma once
// A given motion with its loops closed: the other coordinates follow. With d the way from the given
// coordinates to their target, N and δ_p of loop_islands.h,
//
//   Φ_q δ = −Φ(q, t),        min |E (δ_p + N z) − d|₂       positions, by Newton's steps
//   Φ_q u = −Φ_t,            min |E (u_p + N z) − v|₂       rates
//   Φ_q u̇ = −Φ̈(u, u̇ = 0),    min |E (u̇_p + N z) − a|₂       accelerations
//
// Redundant equations that differ by a file's rounding keep their Φ of the start (contradiction.h).
// E picks the given rates. Where E N has full column rank the motion is unique. Where it has more
// rows than columns, loops and motion must agree: the residual |E … − d| tells by how much they do
// not, and its E_Nᵀ which loop pulls.

#include <momenta/dae/analysis/effort/given_motion.h>
#include <momenta/dae/analysis/effort/loop_islands.h>
#include <momenta/dae/topology/assembly/contradiction.h>

namespace momenta {

class ClosedMotion {
 public:
  /// `start`: pose (nq). `within`: largest deviation of given coordinates, in units of the scene.
  /// The mechanism and the motion must outlive it.
  ClosedMotion(const Mechanism& mechanism, const GivenMotion& motion, Eigen::VectorXd start,
               double within);

  /// q, u and u̇ of a row of the motion, from the pose of the last row asked for. Factors the
  /// islands there, with all loop equations. @throws SceneError with the time, and the loop that
  /// cannot follow or the coordinates left open
  /// Cost: O(bodies), and a dense QR of each island for each of Newton's steps.
  void go_to(std::size_t row, Eigen::VectorXd& q, Eigen::VectorXd& u, Eigen::VectorXd& udot);

  /// Largest deviation so far, in units of the scene.
  double largest_gap() const { return gap_; }

  ScaledLoops& loops() { return loops_; }
  LoopIslands& islands() { return islands_; }

 private:
  Eigen::VectorXd gap(double t, const Eigen::VectorXd& q);
  bool close(double t, const Eigen::VectorXd& target, Eigen::VectorXd& q);
  bool close(double t, const Eigen::VectorXd& target, bool rank_kept, Eigen::VectorXd& q);
  Eigen::VectorXd nearest(const Eigen::VectorXd& right, const Eigen::VectorXd& wanted, double t);
  Eigen::VectorXd way_to(const Eigen::VectorXd& q, const Eigen::VectorXd& target);
  double missed(const Eigen::VectorXd& wanted, const Eigen::VectorXd& got, int* worst) const;
  Column coordinate_of(int rate) const;
  [[noreturn]] void refuse(double t, const Eigen::VectorXd& missing, int worst,
                           const Column& column);
  [[noreturn]] void refuse_open(double t, const LoopIsland& island);
  std::string at(double t) const;

  const Mechanism& mechanism_;
  const GivenMotion& motion_;
  ScaledLoops loops_;
  LoopIslands islands_;
  std::vector<Column> rates_;
  std::vector<bool> positions_, all_rows_;  ///< rows in Newton's steps; all rows
  std::vector<std::vector<int>> given_;     ///< places of given rates, by island
  Contradiction contradiction_;             ///< the start's
  Eigen::VectorXd q_;
  double within_, gap_ = 0, tolerance_;
};

}  // namespace momenta
