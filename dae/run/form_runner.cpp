#include <momenta/core/scene/bearings_refused.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/integrator/stopping.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/run/event/scene_inputs.h>
#include <momenta/dae/run/form_runner.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/run/run_settings.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <tuple>

namespace momenta {

namespace {

/// Reason why a method cannot take the form so set, one sentence; empty: it can.
std::string refusal(const Mechanism& mechanism, const Integrator& method, const RunSettings& s) {
  const bool dae = is_dae_form(s.form);
  const auto wanted = dae ? Integrator::Takes::dae : Integrator::Takes::ode;
  if (method.takes != wanted)
    return "form '" + s.form + "' is " + (dae ? "a DAE" : "an ODE") + ": expected integrator " +
           integrator_names(wanted) + ", found '" + method.name + "'";
  if (!method.takes_form(s.form, dae))
    return "'" + method.name + "' is for form " + listed(method.forms) + ", found '" + s.form + "'";
  if (method.multistep && needs_one_step_method(s.form))
    return "form '" + s.form + "' alters its state after steps, and '" + method.name +
           "' is a multistep method: expected rk4, dp5, dop853 or vern9";
  if (s.project && !dae && !method.projects)
    return "'" + method.name + "' takes no correction after each step: expected no --project" +
           (method.multistep ? ", it would spoil the method's history" : "");
  if (dae && takes_gauge(s.form) && s.gauge == "reset" && !method.resets)
    return "gauge reset alters p after each step, and '" + method.name +
           "' cannot follow: expected integrator " + resetting_names() + ", or gauge none or leak";
  if (!dae && method.multistep && (s.gauge == "reset" || s.gauge == "flip"))
    return "'" + method.name + "' is a multistep method: gauge " + s.gauge +
           " after each step would spoil its history; use leak or none";
  if (const JointSpec* joint = with_bearing(mechanism.scene()); joint && method.hamiltonian)
    return "joint '" + joint->name +
           "' has a bearing, whose friction takes accelerations and forces of loops, and '" +
           method.name + "' finds none: expected another integrator";
  if (mechanism.has_nonholonomic() && method.closes_form(s.form)) {
    const auto& all = mechanism.nonholonomic();
    const auto row =
        static_cast<std::size_t>(std::find(all.begin(), all.end(), true) - all.begin());
    return "loop '" + mechanism.rows()[row].loop + "' (" + mechanism.rows()[row].what +
           ") ties rates and no coordinates, and '" + method.name + "' with form '" + s.form +
           "' solves for positions alone: expected another integrator";
  }
  return "";
}

}  // namespace

FormRunner::FormRunner(const Mechanism& mechanism, const Start& start, RunSettings& s,
                       double max_cpu_seconds)
    : mechanism_(mechanism), start_(start) {
  expect_numbers(s);
  const bool dae = is_dae_form(s.form);
  if (s.integrator.empty()) s.integrator = default_integrator(s.form, s.rtol);
  const Integrator& method = integrator(s.integrator);
  if (const std::string reason = refusal(mechanism, method, s); !reason.empty())
    throw std::invalid_argument(reason);
  if (method.hamiltonian) s.gauge = "reset";
  FormOptions options;
  options.gauge = parse_gauge(s.gauge.empty() ? "none" : s.gauge);
  options.project = s.project;
  options.baumgarte_alpha = s.baumgarte_alpha;
  options.baumgarte_beta = s.baumgarte_beta;
  options.beta = s.beta;
  options.penalty = s.penalty;
  form_ = make_form(s.form, mechanism, options, start);
  s.form = form_->name();
  if (needs_one_step_method(s.form)) s.project = false;  // these forms correct by themselves
  s.gauge = form_->momentum_like() && mechanism.m() > 0 ? form_->gauge().text() : "";
  std::tie(s.baumgarte_alpha, s.baumgarte_beta) = form_->baumgarte_gains();
  s.beta = form_->beta();
  s.penalty = form_->penalty();
  s.kkt = mechanism.m() == 0 || dae ? "" : name_of(mechanism.solver().kkt());
  if (method.step == Integrator::Step::adaptive) s.step = 0;
  integrator_ = s.integrator;
  options_.rtol = s.rtol;
  options_.atol = s.atol;
  options_.step = s.step;
  options_.spectral_radius = s.spectral_radius;
  options_.max_cpu_seconds = max_cpu_seconds;
  if (s.step == 0) options_.stops = input_times(mechanism.scene(), start.t, s.end_time);
  if (!s.when_stiff.empty() && !may_change(s)) s.when_stiff.clear();
  when_stiff_ = s.when_stiff;
  options_.until_stiff = !when_stiff_.empty();
}

IntegrationResult FormRunner::integrate(const std::vector<double>& times,
                                        const Observer& observer) {
  if (DaeSystem* dae = form_->dae())
    return momenta::integrate(integrator_, *dae, start_.t, times, options_, observer);
  const auto y0 = form_->initial(start_);
  const double began = thread_seconds();
  IntegrationResult run =
      momenta::integrate(integrator_, *form_->ode(), start_.t, y0, times, options_, observer);
  changed_at_ = not_measured;
  if (run.ended_stiff)
    go_on(run, times, observer, options_.spent_cpu_seconds + thread_seconds() - began);
  return run;
}

bool FormRunner::may_change(const RunSettings& s) {
  constexpr int most_unknowns = 500;  // a larger dense Newton matrix may cost more than short steps
  return !is_dae_form(s.form) && s.step == 0 && form_->ode()->size() <= most_unknowns &&
         refusal(mechanism_, integrator(s.when_stiff), s).empty();
}

void FormRunner::go_on(IntegrationResult& run, const std::vector<double>& times,
                       const Observer& observer, double cpu_s) {
  changed_at_ = run.end_time;
  std::vector<double> left;
  std::copy_if(times.begin(), times.end(), std::back_inserter(left),
               [&](double t) { return t > run.end_time * (1 + 1e-14); });
  IntegrationOptions options = options_;
  options.carried = nullptr;
  options.spent_cpu_seconds = cpu_s;
  const std::vector<double> y = std::move(run.y);
  IntegrationResult rest =
      momenta::integrate(when_stiff_, *form_->ode(), changed_at_, y, left, options, observer);
  rest.stiff_from = run.stiff_from;
  rest.counters += run.counters;
  run = std::move(rest);
}

}  // namespace momenta
