#pragma once
// The derivatives of ∂T/∂q, at constant q, and of p = M u along rates, for transposed derivatives
// of p = M u: D_v T_q and M v at (q, u), by (8) in dual numbers of one direction, without forces
// and σ.

#include <momenta/core/scalar/power_series.h>
#include <momenta/dae/gradient/levels/mixed_sweep.h>
#include <momenta/dae/gradient/momentum_rows.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <memory>

namespace momenta {

/// One object serves one thread; no call allocates.
class KineticRates {
 public:
  virtual ~KineticRates() = default;
  /// D_v T_q and M v (nv each) at t [s], q, u along v (nv each). O(bodies)
  virtual void along(double t, const double* q, const double* u, const double* v, double* rates,
                     double* momenta) = 0;
};

/// @pre bodies, no quaternions
std::unique_ptr<KineticRates> make_kinetic_rates(const Mechanism& mechanism);

// The second derivatives of the augmented Lagrangian L* = T − V + σᵀΦ̇ in the transposed derivative
// of (3), one of them along the motion. With P = L*_u = M u + Φ_qᵀσ, R = L*_q, both at σ = 0, and
// D_c along the curve (q + u s, u + u̇ s, λ s, t + s),
//
//   by_q = D_c D_(0,ν,μ) R − D_(ν,0,0) R + 2α Φ̇_qᵀμ + β² Φ_qᵀμ
//   by_u = D_c D_(0,ν,μ) P + D_(0,ν,μ) R − D_(ν,0,0) P + 2α Φ_qᵀμ
//
// are the gradients of S = νᵀr1 + μᵀr2 of acceleration_adjoint.h, with directions of (q, u, σ).
// Ways:
//
//   series     rows in power series along the curve with dual directions (0, ν, μ), (ν, 0, 0)
//   polarised  P and R are of degree two in (u, σ) together, so that differences are exact,
//                D_(0,ν,μ) R(q, u, 0) = ( R(q, u + sν, sμ) − R(q, u − sν, −sμ) ) / 2s,
//              and rows in dual numbers with one direction, (u, u̇, λ), have D_c. Time is no direction
//              there: only where nothing is prescribed. s brings sν to the size of u and of √u̇
//              (forces at rest).
//
//   swept      the same in four lanes of one sweep (levels/mixed_sweep.h), where only weights,
//              forces of joints, and loops of points, axes and distances act
//
// Polarised takes 3 evaluations of rows in dual numbers, a fraction of the time of series; swept a
// fraction of that.

class MixedRates {
 public:
  /// `forces`: some have no potential and are not in R; `at_points`: some of these act at points of
  /// bodies (transposed_forces.h). The mechanism has neither quaternions nor nonholonomic rows, and
  /// must outlive it.
  MixedRates(const Mechanism& mechanism, double alpha, double beta, bool forces, bool at_points);

  /// t [s], q, u, u̇ (nv each), λ (m).
  struct At {
    double t;
    const Eigen::VectorXd &q, &u, &udot, &lambda;
  };
  /// by_q, by_u (nv) along ν (nv), μ (m), by the fitting way. O(bodies + m)
  void operator()(const At& at, const Eigen::VectorXd& nu, const Eigen::VectorXd& mu);
  /// The same by series.
  void by_series(const At& at, const Eigen::VectorXd& nu, const Eigen::VectorXd& mu);
  /// @pre nothing is prescribed
  void polarised(const At& at, const Eigen::VectorXd& nu, const Eigen::VectorXd& mu);

  bool swept() const { return swept_ != nullptr; }
  /// s that brings sν and sμ to the size of u, u̇ in a polarised difference.
  static double reach(const At& at, const Eigen::VectorXd& nu);

  // Results of the last call.
  Eigen::VectorXd by_q, by_u;

 private:
  /// The sweep with its model, which stays in place.
  struct Swept {
    virtual ~Swept() = default;
    std::unique_ptr<MixedSweep> sweep;
  };
  template <class Space>
  struct SweptOf;
  template <class Space>
  static std::unique_ptr<Swept> made(const Mechanism& mechanism, Model<Space> model,
                                     bool joint_forces);
  void sweep(const At& at, const Eigen::VectorXd& nu, const Eigen::VectorXd& mu);
  void feed_back(const Eigen::VectorXd& force, const Eigen::VectorXd& rate);

  const Mechanism& mechanism_;
  LagrangianSlopes rows_;
  double alpha_, beta_;
  bool driven_;
  std::unique_ptr<Swept> swept_;             ///< null: no sweep fits
  std::unique_ptr<Evaluation<Dual8>> dual_;  ///< this and series_ are made on demand
  std::unique_ptr<Evaluation<Jet>> series_;
  std::vector<Dual8> x_, out_, mu_, force_;
  Eigen::VectorXd force_rate_, loop_force_;
};

}  // namespace momenta
