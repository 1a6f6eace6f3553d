#pragma once
// What a step back over a run evaluates at each of its stages, along one direction: compiled for
// several x86-64 levels as the sweeps of a run are, and chosen when it is made. No call allocates;
// one object serves one thread.

#include <momenta/core/kernel/link.h>
#include <momenta/core/kernel/model.h>
#include <momenta/core/kernel/planar_link.h>
#include <momenta/dae/sweeps/levels/loop_sweeps.h>

#include <memory>

namespace momenta {

/// (q, p, t) → (u, σ, ṗ), eqs. (7)-(8), and its derivative along (δq, δp), without leak and β.
class TangentSweeps {
 public:
  /// Plain arrays of nv numbers, σ of m.
  struct Result {
    double *u, *du, *dpdot;
    double *sigma, *dsigma;  ///< of the rows as they are swept
  };
  virtual ~TangentSweeps() = default;
  /// False where a joint has no inertia or a branch is weak. O(bodies + m)
  virtual bool operator()(double t, const double* q, const double* p, const double* dq,
                          const double* dp, const Result& result) = 0;
};

/// The derivative of ∂(T − V)/∂(number of a body) along (δq, δu): inertia_slopes.h.
class InertiaSweep {
 public:
  virtual ~InertiaSweep() = default;
  /// slopes += factor times it; arrays of nv, and of as many slopes as there are numbers. O(bodies)
  virtual void add(double factor, double t, const double* q, const double* u, const double* dq,
                   const double* du, double* slopes) = 0;
};

/// D_v T_q, kinetic_rates.h.
class KineticSweep {
 public:
  virtual ~KineticSweep() = default;
  /// result (nv) at t [s], q, u along v (nv each). O(bodies)
  virtual void along(double t, const double* q, const double* u, const double* v,
                     double* result) = 0;
};

/// All of one mechanism, by the level of best_level(); what they are made of stays where it is.
/// `fade`: where pivots fade. @pre swept.plan.fits()
std::unique_ptr<TangentSweeps> make_tangent_sweeps(const PlanarTree& tree,
                                                   const SweptLoops<Planar>& swept, double fade,
                                                   bool body_forces);
std::unique_ptr<TangentSweeps> make_tangent_sweeps(const LinkTree& tree,
                                                   const SweptLoops<Spatial>& swept, double fade,
                                                   bool body_forces);
std::unique_ptr<InertiaSweep> make_inertia_sweep(const Model<Planar>& model);
std::unique_ptr<InertiaSweep> make_inertia_sweep(const Model<Spatial>& model);
std::unique_ptr<KineticSweep> make_kinetic_sweep(const Model<Planar>& model);
std::unique_ptr<KineticSweep> make_kinetic_sweep(const Model<Spatial>& model);

}  // namespace momenta
