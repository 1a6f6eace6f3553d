#pragma once
// The state of a linear model, with driven joints free.
//
// A drive prescribes a joint: q = f(t). The equations depend on f, ḟ and f̈ as on coordinate, rate
// and acceleration of a free joint. So driven joints are freed, and their columns of M, C, K, A
// become inputs; their rows of (1a) are the efforts of the drives. All is exact to rounding, by the
// same dual numbers.
//
// u̇ and λ at the state solve (1a) and (2), u̇ of driven joints being f̈:
//
//   r(t, q, u, u̇) + Φ_qᵀλ = 0 at free rates,   Φ̈ = 0
//
// Drives of spherical and free joints stay functions of time; those of loops are varied if possible
// (loop_drives.h).

#include <momenta/dae/form/form.h>

#include <memory>
#include <string>
#include <vector>

namespace momenta {

struct OperatingPoint {
  std::unique_ptr<const Mechanism> freed;  ///< driven joints are free
  std::vector<int> free;                   ///< undriven rates of `freed`
  std::vector<int> driven;                 ///< driven rates of `freed`
  double t = 0;                            ///< [s]
  Eigen::VectorXd q, u;                    ///< state of `freed`
  Eigen::VectorXd driven_accelerations;    ///< f̈, in the order of `driven`
};

/// @throws SceneError at or beyond a rigid stop (JointSpec::restitution): motions there, however
/// small, meet it. O(joints)
void expect_between_stops(const Mechanism& mechanism, const Eigen::VectorXd& q);

/// The point at a consistent state. @throws SceneError. O(bodies)
OperatingPoint operating_point(const Mechanism& mechanism, const Start& at);

/// Columns of forces by rate: "O.tau [N m]", "J.force_x [N]".
std::vector<Column> force_columns_of(const Mechanism& mechanism);

/// Displacements δ by rate: as coordinates for joints of one coordinate; for free and spherical
/// joints .dx .dy .dz [m] and .rx .ry .rz [rad] in child axes.
std::vector<Column> displacement_columns(const Mechanism& mechanism);

}  // namespace momenta
