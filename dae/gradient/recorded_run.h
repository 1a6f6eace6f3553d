#pragma once
// A form's run whose steps are kept for a sweep back: start and length of each and, while memory
// lasts, the states of its stages, with u of (7) on demand. Steps follow one tangent too
// (tangent_system.h): the λ of a sweep back is as fast. Memory: a state a stage, up to 1 GB, from
// there on a state a step, up to 4 GB.
//
// Stages are told from other evaluations by their times: the last s − 1 of a step, in a row at t0 +
// c_i h. Where none are, trials of singular poses lie between.

#include <momenta/dae/form/ode_form.h>
#include <momenta/dae/gradient/singular_passages.h>
#include <momenta/dae/gradient/step_arena.h>

#include <functional>
#include <string>
#include <vector>

namespace momenta {

class RecordedRun final : public OdeSystem {
 public:
  /// A step over [t0, t1], h as the method took it [s]; `altered`: the form's change after it
  /// changes f.
  struct Step {
    double t0 = 0, t1 = 0, h = 0;
    bool altered = false;
  };

  /// `system`: the form alone or with tangents after its state. `fixed_step`: 0 with error control.
  /// `end` of the run [s]. `c`: the method's abscissas. `with_rates`: keeps u of stages.
  RecordedRun(OdeForm& form, OdeSystem& system, double fixed_step, double end,
              std::vector<double> c, bool with_rates = false)
      : form_(form),
        system_(system),
        fixed_step_(fixed_step),
        end_(end),
        c_(std::move(c)),
        with_rates_(with_rates),
        last_(c_.size()) {}

  const std::vector<Step>& steps() const { return steps_; }
  const double* start(std::size_t i) const { return kept_[i].states; }
  /// Whether states of stages are kept too.
  bool has_stages(std::size_t i) const { return kept_[i].has_stages; }
  /// Stage j of step i, 0 its start. @pre has_stages(i)
  const double* stage(std::size_t i, std::size_t j) const { return start(i) + j * width(); }
  /// State to which the stages led, before the form's change. @pre has_stages(i), has_after_step()
  const double* reached(std::size_t i) const { return stage(i, c_.size()); }
  /// u of stage j of step i (nv); null: not kept.
  const double* rates(std::size_t i, std::size_t j) const {
    return kept_[i].rates ? kept_[i].rates + j * form_.rates().size() : nullptr;
  }
  /// Keeps a step just taken; false where memory is at its limit.
  bool keep(double t0, double t1);
  const std::vector<double>& singular_passages() {
    passages_.end_step();
    return passages_.times();
  }
  /// Whether rows of Φ are redundant in all stages.
  bool redundant() const { return faded_ > 0; }
  /// Why the last trial of a step had no derivatives, one sentence; empty: it had.
  const std::string& lost() const { return lost_; }

  int size() const override { return system_.size(); }
  bool rhs(double t, const double* y, double* ydot) override;
  bool after_step(double t, double* y, bool& changed) override;
  bool has_after_step() const override { return system_.has_after_step(); }
  void begin_step(double t, const double* y) override {
    passages_.end_step();
    evaluated_ = 0;
    system_.begin_step(t, y);
    start_.assign(y, y + width());
    if (with_rates_) find_first_rates();
    reset_ = false;
  }
  bool first_derivative(double* ydot) override { return reset_ = system_.first_derivative(ydot); }
  SingularityHandling wanted_handling() const override { return system_.wanted_handling(); }
  void set_handling(SingularityHandling handling) override {
    corrected_stages_ = handling == SingularityHandling::position;
    system_.set_handling(handling);
  }
  double motion_error_squared(double t, const double* y, const double* error, double rtol,
                              double atol) override {
    return system_.motion_error_squared(t, y, error, rtol, atol);
  }
  void set_observing(bool looking) override {
    looking_ += looking ? 1 : -1;
    system_.set_observing(looking);
  }
  double scale(int i) const override { return system_.scale(i); }
  double time_scale() const override { return system_.time_scale(); }
  double horizon() const override { return system_.horizon(); }

 private:
  std::size_t width() const { return static_cast<std::size_t>(form_.size()); }
  bool lost_at(double t, const char* why);
  void find_first_rates();
  void keep_rates(std::size_t ago);
  /// Evaluations since the step's last stage; −1 where its stages are not the last evaluations, or
  /// the last but for f at its end.
  int stages_ago(const Step& step) const;

  OdeForm& form_;
  OdeSystem& system_;
  double fixed_step_, end_;
  std::vector<double> c_;
  bool with_rates_;
  /// The last evaluations, one for each stage of the method.
  struct Evaluated {
    double t = 0;
    std::vector<double> y, u;
  };
  const Evaluated& evaluated(std::size_t ago) const {
    return last_[(next_ + 2 * last_.size() - 1 - ago) % last_.size()];
  }
  std::vector<Evaluated> last_;
  std::size_t next_ = 0, evaluated_ = 0;  ///< evaluated_: this step's
  bool corrected_stages_ = false;
  int looking_ = 0;  ///< depth of trials
  int faded_ = -1;   ///< redundant rows in the first stage, and so in all
  SingularPassages passages_;
  std::string lost_;
  std::vector<Step> steps_;
  std::vector<double> start_, first_rates_;  ///< this step's; first_rates_ empty: f is not
                                             ///< evaluated yet
  bool reset_ = false;                       ///< f at the start is the form's own
  /// A step: start, stages, their end; u of stages, null: not kept.
  struct Kept {
    double* states;
    bool has_stages;
    double* rates;
  };
  std::vector<Kept> kept_;
  StepArena numbers_;
  std::size_t count_ = 0;  ///< numbers kept
};

}  // namespace momenta
