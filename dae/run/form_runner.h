#pragma once
// A form with its integrator, and with the integrator that takes over where the first finds the
// problem stiff.

#include <momenta/dae/form/ode_form.h>
#include <momenta/dae/integrator/integration.h>
#include <momenta/dae/run/run_result.h>

#include <memory>
#include <string>
#include <vector>

namespace momenta {

/// Shared by watched and timed runs.
class FormRunner {
 public:
  /// Completes the settings: default integrator, the gauge in force, gains, how (7) is solved.
  FormRunner(const Mechanism& mechanism, const Start& start, RunSettings& s,
             double max_cpu_seconds);

  Form& form() { return *form_; }
  /// Systems solved by an ODE form.
  long factorizations() const {
    const auto* ode = dynamic_cast<const OdeForm*>(form_.get());
    return ode ? ode->factorizations() : 0;
  }

  /// The first step [s] of methods with error control; 0: chosen by the method.
  void begin_with_step(double first_step) { options_.initial_step = first_step; }
  IntegrationResult integrate(const std::vector<double>& times, const Observer& observer);
  double changed_at() const { return changed_at_; }
  /// CPU time [s] that counts towards the limit beside that of the next integration.
  void count_spent(double seconds) { options_.spent_cpu_seconds = seconds; }
  /// Lets the next integration continue another one.
  void go_on_from(const Memory& carried, double spent_cpu_seconds) {
    options_.carried = &carried;
    count_spent(spent_cpu_seconds);
  }

 private:
  /// Whether `when_stiff`, a method with memory, takes the form as it is set.
  bool may_change(const RunSettings& s);

  /// The implicit method takes over where the explicit one ended.
  void go_on(IntegrationResult& run, const std::vector<double>& times, const Observer& observer,
             double cpu_s);

  const Mechanism& mechanism_;
  Start start_;
  std::unique_ptr<Form> form_;
  std::string integrator_, when_stiff_;
  IntegrationOptions options_;
  double changed_at_ = not_measured;
};

}  // namespace momenta
