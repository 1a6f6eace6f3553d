#pragma once
// A form's run whose steps are kept, for a sweep back over them: where each began, and how long it
// was. The steps are those of the run alone. Memory: a state a step.

#include <momenta/dae/form/ode_form.h>
#include <momenta/dae/gradient/singular_passages.h>

#include <functional>
#include <string>
#include <vector>

namespace momenta {

class RecordedRun final : public OdeSystem {
 public:
  /// A step over [t0, t1], h = t1 - t0 as the method took it [s].
  struct Step {
    double t0 = 0, t1 = 0, h = 0;
  };

  /// `fixed_step`: 0 with error control. `end`: of the run [s].
  RecordedRun(OdeForm& form, double fixed_step, double end)
      : form_(form), fixed_step_(fixed_step), end_(end) {}

  const std::vector<Step>& steps() const { return steps_; }
  /// The state in which step i began.
  const double* start(std::size_t i) const { return starts_.data() + i * width(); }
  /// To be told of each step taken, before the next begins. False where no more can be kept.
  bool keep(double t0, double t1);
  /// When stages came near to a singular pose.
  const std::vector<double>& singular_passages() {
    passages_.end_step();
    return passages_.times();
  }
  /// Whether loop equations depend on others, in all stages.
  bool redundant() const { return faded_ > 0; }
  /// Why the last trial of a step had no derivatives, one sentence; empty: it had.
  const std::string& lost() const { return lost_; }

  int size() const override { return form_.size(); }
  bool rhs(double t, const double* y, double* ydot) override;
  bool after_step(double t, double* y, bool& changed) override {
    return form_.after_step(t, y, changed) || fail(form_.failure());
  }
  bool has_after_step() const override { return form_.has_after_step(); }
  void begin_step(double t, const double* y) override {
    passages_.end_step();
    form_.begin_step(t, y);
    start_.assign(y, y + width());
  }
  bool first_derivative(double* ydot) override { return form_.first_derivative(ydot); }
  SingularityHandling wanted_handling() const override { return form_.wanted_handling(); }
  void set_handling(SingularityHandling handling) override {
    corrected_stages_ = handling == SingularityHandling::position;
    form_.set_handling(handling);
  }
  double motion_error_squared(double t, const double* y, const double* error, double rtol,
                              double atol) override {
    return form_.motion_error_squared(t, y, error, rtol, atol);
  }
  void look_on(bool looking) override {
    looking_ += looking ? 1 : -1;
    form_.look_on(looking);
  }
  double scale(int i) const override { return form_.scale(i); }

 private:
  std::size_t width() const { return static_cast<std::size_t>(form_.size()); }
  bool lost_at(double t, const char* why);

  OdeForm& form_;
  double fixed_step_, end_;
  bool corrected_stages_ = false;
  int looking_ = 0;  ///< depth
  int faded_ = -1;   ///< rows that are redundant in the first stage, and so in all
  SingularPassages passages_;
  std::string lost_;
  std::vector<Step> steps_;
  std::vector<double> start_, starts_;
};

}  // namespace momenta
