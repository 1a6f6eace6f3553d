#include <momenta/core/open_chain/parallel_for.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/study/drift_study.h>
#include <momenta/dae/study/run_record.h>
#include <momenta/dae/topology/cut/integrated_scene.h>

#include <atomic>
#include <mutex>
#include <stdexcept>

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
    // Forms that a multistep method cannot take are left out, unless asked for.
    if (!one_step && !asked && needs_one_step_method(form)) continue;
    const bool gauged = takes_gauge(form);
    if (is_dae_form(form)) {
      add(form, !gauged ? "" : request.gauge.empty() ? leak : request.gauge, false);
      // With a step, also the fixed-step methods made for this form.
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
  if (runs.empty())
    throw std::invalid_argument("integrator '" + explicit_method +
                                "' takes none of the forms asked for, expected one that does");
  return runs;
}

}  // namespace

std::vector<RunResult> run_drift_study(const Mechanism& mechanism, const Start& start,
                                       const DriftRequest& request) {
  const auto runs = plan_runs(mechanism, request);
  const IntegratedScene integrated(mechanism, start);
  const int total = static_cast<int>(runs.size());
  std::vector<RunResult> results(runs.size());
  std::vector<char> there(runs.size(), 0);
  std::atomic<bool> going{true};
  std::mutex turn;
  const auto tell = [&](std::size_t i, const std::string& label, double fraction) {
    const std::lock_guard lock(turn);
    if (going && request.progress &&
        !request.progress(static_cast<int>(i) + 1, total, label, fraction))
      going = false;
    return going.load();
  };
  // Runs are watched side by side, and timed afterwards, one at a time.
  parallel_for(request.threads, runs.size(), [&](std::size_t i) {
    if (!going) return;
    const std::string key = key_of(runs[i]);
    auto result = recall<RunResult>(request.journal, key);
    if (!result) {
      RunRequest run;
      run.settings = runs[i];
      run.integrated = &integrated;
      run.reference = request.reference;
      run.multipliers = true;
      run.max_cpu_seconds = request.max_cpu_seconds;
      run.film_intervals = request.film_intervals;
      const std::string label = runs[i].form + (runs[i].gauge.empty() ? "" : " " + runs[i].gauge) +
                                (runs[i].project ? " projected" : "");
      run.progress = [&](double t) { return tell(i, label, t / request.end_time); };
      result = run_form(mechanism, start, run);
      if (request.journal && going) request.journal->add(key, record_of(*result));
    }
    results[i] = *std::move(result);
    there[i] = 1;
  });
  // An interrupted study keeps the runs that were begun.
  std::size_t kept = 0;
  for (std::size_t i = 0; i < results.size(); ++i)
    if (there[i]) {
      if (kept != i) results[kept] = std::move(results[i]);
      ++kept;
    }
  results.resize(kept);
  if (going)
    time_runs(integrated.mechanism(), integrated.start(), results,
              {request.timing,
               0.8,
               request.journal,
               request.max_cpu_seconds,
               [&](std::size_t i) { return tell(i, "timing " + results[i].settings.form, 1); },
               {}});
  return results;
}

}  // namespace momenta
