#pragma once
// Base of the ODE forms in q, u: (3) with feedback of Φ and Φ̇, and corrections of q and u after
// steps. (3) is solved once or, with a softened solver, repeatedly, each time around the
// multipliers just found.

#include <momenta/dae/form/ode_form.h>

namespace momenta {

/// α, β of Φ̈ + 2αΦ̇ + β²Φ = 0 [1/s].
struct Feedback {
  double alpha = 0, beta = 0;
};

/// Size of a last position correction, whose square is rounding [rad or lengths].
inline constexpr double last_correction = 1e-8;
inline constexpr int most_corrections = 10;

class AccelerationForm : public OdeForm {
 public:
  AccelerationForm(std::string name, const Mechanism& mechanism, const FormOptions& options,
                   const Start& start, Feedback feedback = {}, int solutions = 1);

  bool momentum_like() const override { return false; }
  std::pair<double, double> baumgarte_gains() const override {
    return {feedback_.alpha, feedback_.beta};
  }

  std::vector<double> initial(const Start& start) override;
  bool rhs(double t, const double* y, double* ydot) override;
  bool has_after_step() const override { return corrects() || mechanism_.plan().quasi_velocities; }
  bool after_step(double t, double* y, bool& changed) override;
  void begin_step(double t, const double* y) override {
    OdeForm::begin_step(t, y);
    centre_ = multipliers_;
  }
  /// Forms that correct q and u after steps do so in stages next to a singular pose.
  SingularityHandling wanted_handling() const override {
    return corrects() && solutions_ == 1 ? handling_ : SingularityHandling::none;
  }
  void set_handling(SingularityHandling care) override {
    corrects_stages_ = care == SingularityHandling::position;
  }
  double motion_error_squared(double t, const double* y, const double* error, double rtol,
                              double atol) override;
  bool read(double t, const double* y, const double*, Snapshot& out) override;

 protected:
  bool corrects() const { return has_loops() && options_.project; }
  /// Corrects q, then u, after a step.
  virtual bool correct(double t, double* q, double* u) {
    return correct_position(t, q) && correct_velocity(t, q, u);
  }
  /// M v + Φ_qᵀν = M u, Φ_q v = −Φ_t: the nearest consistent velocity in the mass metric.
  bool correct_velocity(double t, const double* q, double* u);

 private:
  Feedback feedback_;
  int solutions_;  ///< solutions of (3) per evaluation, each around the last λ
  std::vector<double> nu_;
  bool corrects_stages_ = false;
  std::vector<double> state_;    ///< (q, u) where f is taken, with singularity handling
  std::vector<double> at_rest_;  ///< zeros (nv)
};

/// acceleration-index1 with feedback: the DAE that (3) with it solves.
std::unique_ptr<Form> make_acceleration_index1_with(Feedback feedback, const Mechanism& mechanism,
                                                    const FormOptions& options, const Start& start);

/// The gains given, or critically damped ones at the rate default_leak().
Feedback feedback_of(const Mechanism& mechanism, const FormOptions& options, const Start& start);

}  // namespace momenta
