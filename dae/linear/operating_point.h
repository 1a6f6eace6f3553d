#pragma once
// The state about which a linear model is taken, of the mechanism with its drives let loose.
//
// A drive prescribes a joint: q = f(t). What the equations owe to f, ḟ and f̈ is what they owe to
// the coordinate, the rate and the acceleration of the joint were it free. So the joints that have
// drives are freed, and their columns of M, C, K, A become inputs; their rows of (1a) are the
// efforts of the drives. All of it stays exact to rounding, by the same dual numbers.
//
// u̇ and λ at the state solve (1a) and (2), u̇ of driven joints being f̈:
//
//   r(t, q, u, u̇) + Φ_qᵀλ = 0 at free rates,   Φ̈ = 0
//
// Drives of spherical and of free joints stay what they are, functions of time; those of loops are
// varied where they are (loop_drives.h).

#include <momenta/dae/form/form.h>

#include <memory>
#include <string>
#include <vector>

namespace momenta {

struct OperatingPoint {
  std::unique_ptr<const Mechanism> freed;  ///< joints that drives prescribe are free in it
  std::vector<int> free;                   ///< places in its u of rates that no drive prescribes
  std::vector<int> driven;                 ///< and of those that one does
  double t = 0;                            ///< [s]
  Eigen::VectorXd q, u;                    ///< of `freed`
  Eigen::VectorXd driven_accelerations;    ///< f̈, in the order of `driven`
};

/// At a consistent state of the mechanism. @throws SceneError. O(bodies)
OperatingPoint operating_point(const Mechanism& mechanism, const Start& at);

/// The forces with their names (by rate): "O.tau [N m]", "J.force_x [N]".
std::vector<Column> force_columns_of(const Mechanism& mechanism);

/// Displacements δ along the rates, by name: as coordinates for joints of one coordinate, of free
/// and spherical joints .dx .dy .dz [m] and .rx .ry .rz [rad] in child axes.
std::vector<Column> displacement_columns(const Mechanism& mechanism);

}  // namespace momenta
