#pragma once
// A given motion with its loops closed: the coordinates that are not given follow. With d the way
// from the given coordinates to where they are to be, N and δ_p of loop_islands.h,
//
//   Φ_q δ = −Φ(q, t),        min |E (δ_p + N z) − d|₂       positions, by Newton's steps
//   Φ_q u = −Φ_t,            min |E (u_p + N z) − v|₂       rates
//   Φ_q u̇ = −Φ̈(u, u̇ = 0),    min |E (u̇_p + N z) − a|₂       accelerations
//
// Of redundant equations that a file's rounding lets differ Φ stays what it is at the start
// (contradiction.h). E picks the given rates. Where E N has full column rank the motion is one
// motion. Where it has more rows than columns, loops and motion must agree: what is left of |E … −
// d| tells by how much they do not, and E_Nᵀ of it which loop pulls.

#include <momenta/dae/assembly/contradiction.h>
#include <momenta/dae/effort/given_motion.h>
#include <momenta/dae/effort/loop_islands.h>

namespace momenta {

class ClosedMotion {
 public:
  /// From the pose `start` (nq) on. `within`: how far the loops may keep given coordinates from
  /// where they are to be, in units of the scene. The mechanism and the motion must outlive it.
  ClosedMotion(const Mechanism& mechanism, const GivenMotion& motion, Eigen::VectorXd start,
               double within);

  /// q, u and u̇ of a row of the motion, from the pose of the row asked for before. The islands are
  /// factored there, of all loop equations. @throws SceneError naming the time, and the loop that
  /// cannot follow or the coordinates that are left open
  /// Cost: O(bodies), and a dense QR of each island for each of Newton's steps.
  void go_to(std::size_t row, Eigen::VectorXd& q, Eigen::VectorXd& u, Eigen::VectorXd& udot);

  /// The largest changes to what was given, so far, in units of the scene.
  double largest_gap() const { return gap_; }
  double largest_rate_gap() const { return rate_gap_; }  ///< [1/s]

  ScaledLoops& loops() { return loops_; }
  LoopIslands& islands() { return islands_; }

 private:
  Eigen::VectorXd gap(double t, const Eigen::VectorXd& q);
  bool close(double t, const Eigen::VectorXd& target, Eigen::VectorXd& q);
  Eigen::VectorXd nearest(const Eigen::VectorXd& right, const Eigen::VectorXd& wanted, double t);
  Eigen::VectorXd way_to(const Eigen::VectorXd& q, const Eigen::VectorXd& target);
  double missed(const Eigen::VectorXd& wanted, const Eigen::VectorXd& got, int* worst) const;
  [[noreturn]] void refuse(double t, const Eigen::VectorXd& missing, int worst,
                           const std::string& unit);
  [[noreturn]] void refuse_open(double t, const LoopIsland& island);
  std::string at(double t) const;

  const Mechanism& mechanism_;
  const GivenMotion& motion_;
  ScaledLoops loops_;
  LoopIslands islands_;
  std::vector<Column> rates_;
  std::vector<bool> positions_, all_rows_;  ///< rows of Φ in Newton's steps; all
  std::vector<std::vector<int>> given_;     ///< by island: places of given rates among its rates
  Contradiction contradiction_;             ///< at the start
  Eigen::VectorXd q_;
  double within_, gap_ = 0, rate_gap_ = 0, tolerance_;
};

}  // namespace momenta
