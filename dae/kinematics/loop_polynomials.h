#pragma once
// The loop equations of a mechanism with some coordinates held as polynomials, all of whose
// solutions can be found (homotopy.h). Three kinds of mechanisms are written so:
//
//   in a plane   joints that turn and slide: planar_polynomials.h
//   platforms    a body on six rods or legs: platform_polynomials.h
//   one loop     of hinges, slides and balls in space: space_loop_polynomials.h

#include <momenta/dae/kinematics/polynomial_system.h>
#include <momenta/dae/mechanism.h>

#include <memory>
#include <optional>
#include <vector>

namespace momenta {

class LoopPolynomials {
 public:
  virtual ~LoopPolynomials() = default;
  virtual const PolynomialSystem& system() const = 0;
  /// How many finite solutions there are of each pose over the complex numbers.
  virtual long copies() const { return 1; }
  /// Whether a finite solution closes the loops.
  virtual bool is_solution(const Eigen::VectorXcd&) const { return true; }
  /// The pose (nq) of one that does, where that is real.
  virtual std::optional<Eigen::VectorXd> pose(const Eigen::VectorXcd& x) const = 0;
};

/// What Φ = 0 asks at time t [s] of the coordinates that are not held (by rate, nv), `own` (nq)
/// being a pose that closes the loops.
/// @throws SceneError for other mechanisms, and where there are more equations than unknowns, or
/// more than `most_paths` paths
std::unique_ptr<LoopPolynomials> loop_polynomials(const Mechanism& mechanism, double t,
                                                  const Eigen::VectorXd& own,
                                                  const std::vector<bool>& held);

/// Freedoms that no solution is about: of rods and legs that turn about the line of their ends.
int idle_spins(const Mechanism& mechanism, double t, const Eigen::VectorXd& own,
               const std::vector<bool>& held);

inline constexpr long most_paths = 20'000;
/// Imaginary parts of real solutions, of what has size one.
inline constexpr double real_enough = 1e-7;

/// Every body frame in ground axes. @pre no joint of kind user
std::vector<Eigen::Isometry3d> poses_of_polynomials(const Mechanism& mechanism, double t,
                                                    const Eigen::VectorXd& q);
/// The point of a loop on its parent in the axes of that body, driven components at time t.
Eigen::Vector3d origin_of_loop(const Scene& scene, const LoopSpec& loop, double t);

}  // namespace momenta
