#pragma once
// Base of the ODE forms in q, p: (7), (8), the gauge, and corrections of positions after steps. (7)
// is solved once or, with a softened solver, repeatedly, each time around the multipliers just
// found.
//
// Where redundant equations contradict each other (Start::residue), a part w of βΦ is that of no
// velocity, wᵀ Φ_q = 0: each of the k solutions adds the same α w to σ, and σ of one step's end as
// σ₀ of the next would grow with the number of steps. So the next step begins with σ₀ = σ_k − k
// (σ_k − σ_{k−1}).

#include <momenta/dae/form/ode_form.h>

namespace momenta {

class MomentumForm : public OdeForm {
 public:
  /// `beta`: feedback Φ̇ = −βΦ [1/s].
  MomentumForm(std::string name, const Mechanism& mechanism, const FormOptions& options,
               const Start& start, double beta, int solutions = 1);

  bool momentum_like() const override { return true; }
  Gauge gauge() const override { return gauge_; }
  double beta() const override { return beta_; }

  std::vector<double> initial(const Start& start) override;
  bool rhs(double t, const double* y, double* ydot) override;
  bool has_after_step() const override {
    return (has_loops() && (options_.project || gauge_.kind == Gauge::Kind::reset ||
                            gauge_.kind == Gauge::Kind::flip)) ||
           mechanism_.plan().quasi_velocities;
  }
  bool after_step(double t, double* y, bool& changed) override;
  bool first_derivative(double* ydot) override;
  void carry(Memory& memory) override;
  void begin_step(double t, const double* y) override;
  void set_handling(SingularityHandling care) override {
    corrects_ = care == SingularityHandling::position;
  }
  double motion_error_squared(double t, const double* y, const double* error, double rtol,
                              double atol) override;
  bool read(double t, const double* y, const double*, Snapshot& out) override;

 private:
  double leak() const { return gauge_.kind == Gauge::Kind::leak ? gauge_.kappa : 0.0; }
  /// (7): u_ and multipliers_; with `pdot` (8) too.
  bool solve(double t, const double* q, const double* p, double* pdot);
  /// Adds the friction of bearings at u_, whose reactions are forces: by λ and u̇ of (3), not by σ.
  bool add_friction(double t, const double* q, double* pdot);

  Gauge gauge_;
  double beta_;
  int solutions_;  ///< solutions of (7) per evaluation, each around the last σ
  bool corrects_ = false;
  bool reset_ = false;  ///< work_ and correction_ hold f after a reset
  std::vector<double> around_, place_;
  std::vector<double> not_closed_;  ///< k (σ_k − σ_{k−1}) of the last evaluation; empty: not asked
};

}  // namespace momenta
