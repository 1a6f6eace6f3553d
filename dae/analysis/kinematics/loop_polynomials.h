#pragma once
// The loop equations of a mechanism with some coordinates held, as polynomials whose solutions can
// all be found (homotopy.h). Three kinds of mechanisms have them:
//
//   in a plane   joints that turn and slide: planar_polynomials.h
//   platforms    a body on six rods or legs: platform_polynomials.h
//   one loop     of hinges, slides and balls in space: space_loop_polynomials.h

#include <momenta/dae/analysis/kinematics/polynomial_system.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <memory>
#include <optional>
#include <vector>

namespace momenta {

class LoopPolynomials {
 public:
  virtual ~LoopPolynomials() = default;
  virtual const PolynomialSystem& system() const = 0;
  /// Finite complex solutions for each pose.
  virtual long copies() const { return 1; }
  /// Whether a finite solution closes the loops.
  virtual bool is_solution(const Eigen::VectorXcd&) const { return true; }
  /// The pose (nq) of such a solution, if real.
  virtual std::optional<Eigen::VectorXd> pose(const Eigen::VectorXcd& x) const = 0;
};

/// Φ = 0 at time t [s] for the coordinates that are not held (by rate, nv); the pose `own` (nq)
/// closes the loops.
/// @throws SceneError for other mechanisms, for more equations than unknowns, and for more than
/// `most_paths` paths
std::unique_ptr<LoopPolynomials> loop_polynomials(const Mechanism& mechanism, double t,
                                                  const Eigen::VectorXd& own,
                                                  const std::vector<bool>& held);

/// Freedoms without effect on solutions: rods and legs turn about the line of their ends.
int idle_spins(const Mechanism& mechanism, double t, const Eigen::VectorXd& own,
               const std::vector<bool>& held);

inline constexpr long most_paths = 20'000;
/// Largest imaginary part of a real solution of size one.
inline constexpr double real_enough = 1e-7;

/// Body frames in ground axes. @pre no joint of kind user
std::vector<Eigen::Isometry3d> poses_of_polynomials(const Mechanism& mechanism, double t,
                                                    const Eigen::VectorXd& q);
/// Point of a loop on its parent in body axes, driven components at time t.
Eigen::Vector3d origin_of_loop(const Scene& scene, const LoopSpec& loop, double t);

}  // namespace momenta
