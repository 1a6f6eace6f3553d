#pragma once
// A form's system with its tangents: y, the integral J of a functional, and their derivatives along
// directions, as one system for every explicit method,
//
//   (y, J, Y, dJ)' = (f, g, f_y Y + f_θ, dg),
//
// by the method's own stages: Y is the derivative of the y that the method finds. All count in the
// norm of the local error, in their units over those of θ: a motion that rests, or whose fast modes
// do, lets steps grow until Y is unstable; an integrand may be faster than the motion; and where f
// has corners f_y jumps, and a step over one leaves an error of first order in Y. The tolerance is
// that of n unknowns among all, tol √(n/N). Step sizes are held: they depend on θ by as little as
// the local error.

#include <momenta/dae/gradient/form_tangents.h>
#include <momenta/dae/gradient/functional.h>
#include <momenta/dae/gradient/singular_passages.h>

namespace momenta {

class TangentSystem final : public OdeSystem {
 public:
  /// `integrand` null: no J. All must outlive it. `sizes` of θ; `tangents_scale`: scale of Y beside
  /// that of y in the norm of the error.
  TangentSystem(OdeForm& form, FormTangents& tangents, Functional* integrand, Eigen::VectorXd sizes,
                double tangents_scale);

  int size() const override { return all_; }
  /// Factor for rtol and atol.
  double tolerance_factor() const;
  /// y, then its tangents column by column, J and its tangents.
  std::vector<double> initial(const std::vector<double>& y0, const Eigen::MatrixXd& Y0) const;
  /// Tangents in a whole state: size of y × directions.
  Eigen::MatrixXd tangents(const double* y) const;
  /// Why the last trial of a step had no derivatives, one sentence; empty: it had.
  const std::string& lost() const { return lost_; }
  const std::vector<double>& singular_passages() {
    passages_.end_step();
    return passages_.times();
  }
  double integral(const double* y) const { return y[n_]; }
  Eigen::VectorXd integral_tangents(const double* y) const;

  /// q, u and their tangents at a whole state.
  struct Motion {
    Eigen::VectorXd q, u;
    Eigen::MatrixXd dq, du;
  };
  bool motion(double t, const double* y, Motion& out);

  bool rhs(double t, const double* y, double* ydot) override;
  bool after_step(double t, double* y, bool& changed) override;
  bool has_after_step() const override { return form_.has_after_step(); }
  void begin_step(double t, const double* y) override {
    passages_.end_step();
    form_.begin_step(t, y);
  }
  SingularityHandling wanted_handling() const override { return form_.wanted_handling(); }
  void set_handling(SingularityHandling handling) override;
  double motion_error_squared(double t, const double* y, const double* error, double rtol,
                              double atol) override;
  void set_observing(bool looking) override {
    looking_ += looking ? 1 : -1;
    form_.set_observing(looking);
  }
  double scale(int i) const override;
  double time_scale() const override { return form_.time_scale(); }
  double horizon() const override { return form_.horizon(); }

 private:
  int extra() const { return integrand_ ? 1 : 0; }
  bool fail_at(double t, const std::string& why);

  OdeForm& form_;
  FormTangents& tangents_;
  Functional* integrand_;
  int n_, directions_, all_;
  Eigen::VectorXd sizes_;
  double tangents_scale_;
  bool corrected_stages_ = false;
  int looking_ = 0;  ///< depth of trials
  SingularPassages passages_;
  std::string lost_;
  std::vector<double> before_;
  Eigen::MatrixXd Y_, Ydot_;
};

}  // namespace momenta
