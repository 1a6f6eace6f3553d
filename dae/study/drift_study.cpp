#include <momenta/dae/solver/integrators.h>
#include <momenta/dae/study/drift_study.h>

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
    const bool momentum = form.rfind("momentum", 0) == 0;
    if (is_dae_form(form)) {
      // Without loops every DAE form is the same ODE.
      if (loops || !request.forms.empty())
        add(form, momentum ? (request.gauge.empty() ? leak : request.gauge) : "", false);
      continue;
    }
    if (!integrator(explicit_method).takes_form(form, false)) continue;
    if (form == "baumgarte" && !loops && request.forms.empty()) continue;
    if (momentum && request.gauge.empty() && loops) {
      add(form, leak, request.project);
      if (one_step) add(form, "reset", request.project);
      add(form, "none", request.project);
    } else {
      add(form, momentum ? (request.gauge.empty() ? "none" : request.gauge) : "", request.project);
    }
    // The projected twin: an opponent's best honest chance, and ours.
    if (loops && projects && !request.project && form != "baumgarte") {
      const std::string gauge = one_step ? "reset" : leak;
      add(form, momentum ? (request.gauge.empty() ? gauge : request.gauge) : "", true);
    }
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
    const std::string label = runs[i].form + (runs[i].gauge.empty() ? "" : " " + runs[i].gauge) +
                              (runs[i].project ? " projected" : "");
    if (request.progress)
      run.progress = [&](double t) {
        going = request.progress(static_cast<int>(i) + 1, static_cast<int>(runs.size()), label,
                                 t / request.end_time);
        return going;
      };
    results.push_back(run_form(mechanism, start, run));
  }
  if (going)
    time_runs(mechanism, start, results, 5, 3, [&](std::size_t i) {
      return !request.progress ||
             request.progress(static_cast<int>(i) + 1, static_cast<int>(results.size()),
                              "timing " + results[i].settings.form, 1);
    });
  return results;
}

}  // namespace momenta
