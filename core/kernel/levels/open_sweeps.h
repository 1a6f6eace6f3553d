#pragma once
// The two recursions compiled for several x86-64 levels in one library, chosen when a chain is made
// (level.h).

#include <momenta/core/kernel/branches/branches.h>
#include <momenta/core/kernel/levels/level.h>
#include <momenta/core/kernel/planar_joint.h>

#include <cstddef>
#include <memory>

namespace momenta {

class OpenSweeps {
 public:
  virtual ~OpenSweeps() = default;

  /// u (nv) and ṗ (nv), without forces between points of bodies.
  virtual bool momentum(double t, const double* q, const double* p, double* u, double* pdot) = 0;
  /// M⁻¹ x (nv).
  virtual bool inverse_mass_times(double t, const double* q, const double* x, double* result) = 0;
  /// The same at the place of the last momentum() or inverse_mass_times().
  /// @pre there was one, and it returned true
  virtual bool inverse_mass_times(const double* x, double* result) = 0;
  /// The derivative of (q̇, ṗ) along (δq, δp), forces between points of bodies included.
  virtual bool derivative(double t, const double* q, const double* p, const double* dq,
                          const double* dp, double* dqdot, double* dpdot) = 0;
  /// u̇ (nv) from all generalised forces τ (nv) but weights.
  virtual bool acceleration(double t, const double* q, const double* u, const double* tau,
                            double* udot) = 0;
  /// Two other classical algorithms, in space alone (false in a plane): u̇ by composite inertias and
  /// a sparse factorisation of M, and τ of given accelerations.
  virtual bool composite_acceleration(double t, const double* q, const double* u, const double* tau,
                                      double* udot) = 0;
  virtual bool inverse_dynamics(double t, const double* q, const double* u, const double* udot,
                                double* tau) = 0;
  virtual int level() const = 0;
  /// Body whose joint had no inertia in the last failed call.
  virtual int singular_joint() const = 0;
};

/// Branches of one state side by side. More than four seldom fill a register, and records of eight
/// leave the cache.
constexpr int branch_lanes_at(int level) {
  return level >= 3 ? 4 : 2;
}

/// `branches`: those of the tree, branch_lanes_at(level) at a time, for single states; null: body
/// by body.
/// @pre level_at_most(level) is level; tree and branches do not move.
std::unique_ptr<OpenSweeps> make_sweeps(const LinkTree& tree, int level,
                                        const Branches* branches = nullptr);
std::unique_ptr<OpenSweeps> make_sweeps(const PlanarTree& tree, int level);

}  // namespace momenta
