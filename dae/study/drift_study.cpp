#include <momenta/dae/solver/integrators.h>
#include <momenta/dae/study/drift_study.h>
#include <momenta/dae/study/run_record.h>

#include <algorithm>

namespace momenta {
namespace {

std::vector<RunSettings> plan_runs(const Mechanism& mechanism, const DriftRequest& request) {
  RunSettings common;
  common.rtol = request.rtol;
  common.atol = request.atol;
  common.step = request.step;
  common.end_time = request.end_time;
  common.samples = request.samples;
  common.baumgarte_alpha = request.baumgarte_alpha;
  common.baumgarte_beta = request.baumgarte_beta;
  common.beta = request.beta;
  common.penalty = request.penalty;
  const std::string explicit_method =
      !request.integrator.empty() ? request.integrator : (request.step > 0 ? "rk4" : "dop853");
  const bool one_step = !integrator(explicit_method).multistep;
  const bool projects = integrator(explicit_method).projects;
  const std::string leak = mechanism.scene().run.leak
                               ? Gauge{Gauge::Kind::leak, *mechanism.scene().run.leak}.text()
                               : "leak";

  std::vector<RunSettings> runs;
  const auto add = [&](const std::string& form, const std::string& gauge, bool project) {
    RunSettings s = common;
    s.form = form;
    s.gauge = gauge;
    s.project = project && projects;
    s.integrator = is_dae_form(form) ? "ida" : explicit_method;
    runs.push_back(s);
  };
  const bool loops = mechanism.m() > 0;
  for (const std::string& form : request.forms.empty() ? form_names() : request.forms) {
    const bool asked = !request.forms.empty();
    // Without loops all forms are one of two ODEs.
    if (!loops && !asked && form != "momentum" && form != "acceleration") continue;
    // What a multistep method cannot take is refused where it was asked for.
    if (!one_step && !asked && needs_one_step_method(form)) continue;
    const bool gauged = takes_gauge(form);
    if (is_dae_form(form)) {
      add(form, !gauged ? "" : request.gauge.empty() ? leak : request.gauge, false);
      // Where there is a step, the methods of fixed steps that are made for this form too.
      for (const Integrator& method : integrators())
        if (request.step > 0 && method.step == Integrator::Step::fixed && !method.forms.empty() &&
            method.takes_form(form, true)) {
          runs.push_back(runs.back());
          runs.back().integrator = method.name;
        }
      continue;
    }
    if (!integrator(explicit_method).takes_form(form, false)) continue;
    if (form == "momentum" && request.gauge.empty() && loops) {
      add(form, leak, request.project);
      if (one_step) add(form, "reset", request.project);
      add(form, "none", request.project);
    } else if (gauged && loops) {
      add(form, request.gauge.empty() ? leak : request.gauge, request.project);
    } else if (form != "acceleration" || !request.project || !loops) {
      add(form, gauged ? "none" : "", request.project && !needs_one_step_method(form));
    } else if (asked) {
      add("projected", "", false);
    }
    // The projected twin of `acceleration` is the form `projected`.
    if (form == "momentum" && loops && projects && !request.project)
      add(form, !request.gauge.empty() ? request.gauge : one_step ? "reset" : leak, true);
  }
  return runs;
}

}  // namespace

std::vector<RunResult> run_drift_study(const Mechanism& mechanism, const Start& start,
                                       const DriftRequest& request) {
  const auto runs = plan_runs(mechanism, request);
  std::vector<RunResult> results;
  bool going = true;
  for (std::size_t i = 0; i < runs.size() && going; ++i) {
    RunRequest run;
    run.settings = runs[i];
    run.reference = request.reference;
    run.max_cpu_seconds = request.max_cpu_seconds;
    run.film_intervals = request.film_intervals;
    const std::string label = runs[i].form + (runs[i].gauge.empty() ? "" : " " + runs[i].gauge) +
                              (runs[i].project ? " projected" : "");
    if (request.progress)
      run.progress = [&](double t) {
        going = request.progress(static_cast<int>(i) + 1, static_cast<int>(runs.size()), label,
                                 t / request.end_time);
        return going;
      };
    const std::string key = key_of(runs[i]);
    if (auto known = recall<RunResult>(request.journal, key)) {
      results.push_back(*std::move(known));
      continue;
    }
    results.push_back(run_form(mechanism, start, run));
    if (request.journal && going) request.journal->add(key, record_of(results.back()));
  }
  if (going)
    time_runs(mechanism, start, results,
              {request.timing,
               3,
               request.journal,
               [&](std::size_t i) {
                 return !request.progress ||
                        request.progress(static_cast<int>(i) + 1, static_cast<int>(results.size()),
                                         "timing " + results[i].settings.form, 1);
               },
               {}});
  return results;
}

}  // namespace momenta
