#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/run/departures.h>
#include <momenta/dae/run/rank_at_start.h>
#include <momenta/dae/study/run_record.h>
#include <momenta/dae/study/work_study.h>
#include <momenta/dae/topology/cut/integrated_scene.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace momenta {
namespace {

/// Whether a method for DAEs had better reset the gauge than leak, as it says itself.
bool had_better_reset(const Mechanism& mechanism, const Start& start, const Integrator& method) {
  if (method.gauge == Integrator::Preferred::reset_of_independent)
    return rank_at(mechanism, start).rank == mechanism.m();
  return method.gauge == Integrator::Preferred::reset;
}

RunSettings ladder(const Mechanism& mechanism, const Start& start, const WorkRequest& request,
                   const std::string& form, const std::string& method) {
  const bool loops = mechanism.m() > 0, dae = is_dae_form(form),
             one_step = !dae && !integrator(method).multistep;
  RunSettings s;
  s.end_time = request.end_time;
  s.samples = request.samples;
  s.form = form;
  s.integrator = method;
  // As the theory recommends: a one-step method may reset the gauge and correct positions, which
  // makes `projected` of `acceleration`; others have feedback instead.
  if (takes_gauge(form) && loops)
    s.gauge = !request.gauge.empty()                                               ? request.gauge
              : one_step || had_better_reset(mechanism, start, integrator(method)) ? "reset"
                                                                                   : "leak";
  s.project = !dae && integrator(method).projects && loops &&
              (form == "momentum" || form == "acceleration");
  return s;
}

/// Settings of each ladder, but for tolerance and step.
std::vector<RunSettings> plan_ladders(const Mechanism& mechanism, const Start& start,
                                      const WorkRequest& request) {
  const bool loops = mechanism.m() > 0;
  // The requested methods that a form takes; if none, its default.
  const auto methods_of = [&](const std::string& form) {
    const bool dae = is_dae_form(form);
    std::vector<std::string> methods;
    for (const std::string& method : request.integrators)
      if (integrator(method).takes_form(form, dae)) methods.push_back(method);
    if (methods.empty()) methods.push_back(dae ? "ida" : "dop853");
    return methods;
  };
  std::vector<RunSettings> ladders;
  for (const std::string& form : request.forms.empty() ? form_names() : request.forms) {
    // Without loops all forms are one of two ODEs.
    const bool asked = !request.forms.empty();
    if (!loops && !asked && form != "momentum" && form != "acceleration") continue;
    for (const std::string& method : methods_of(form)) {
      const bool one_step = !is_dae_form(form) && !integrator(method).multistep;
      // No duplicates, and no forms that the method cannot take, unless asked for.
      if (!asked && loops && form == "acceleration" && one_step) continue;
      if (!asked && needs_one_step_method(form) && !one_step) continue;
      ladders.push_back(ladder(mechanism, start, request, form, method));
    }
  }
  return ladders;
}

}  // namespace

std::vector<RunResult> run_work_study(const Mechanism& mechanism, const Start& start,
                                      const WorkRequest& request) {
  auto ladders = plan_ladders(mechanism, start, request);
  const IntegratedScene integrated(mechanism, start);
  std::vector<RunResult> results;
  bool going = true;
  for (std::size_t i = 0; i < ladders.size() && going; ++i) {
    const bool fixed = integrator(ladders[i].integrator).step == Integrator::Step::fixed;
    if (fixed && request.steps.empty())
      throw std::invalid_argument("integrator '" + ladders[i].integrator +
                                  "' is of fixed steps, expected some");
    const std::size_t first = results.size();
    for (const double rung : fixed ? request.steps : request.tolerances) {
      RunRequest run;
      run.settings = ladders[i];
      run.integrated = &integrated;
      (fixed ? run.settings.step : run.settings.rtol) = rung;
      if (!fixed) run.settings.atol = rung;
      run.reference = request.reference;
      run.keep_trajectory = request.keep_trajectories;
      run.max_cpu_seconds = request.max_cpu_seconds;
      if (request.progress)
        run.progress = [&](double t) {
          going =
              request.progress(static_cast<int>(i) + 1, static_cast<int>(ladders.size()),
                               ladders[i].form + " " + ladders[i].integrator, t / request.end_time);
          return going;
        };
      const std::string key = key_of(run.settings);
      if (auto known = recall<RunResult>(request.journal, key)) {
        results.push_back(*std::move(known));
      } else {
        results.push_back(run_form(mechanism, start, run));
        if (request.journal && going) request.journal->add(key, record_of(results.back()));
      }
      // A tighter rung would need longer; one that failed may be followed by one that works.
      if (!going || results.back().status == "time limit") break;
    }
    // Adds bdf where stability limits the method.
    const bool stiff = std::any_of(results.begin() + static_cast<long>(first), results.end(),
                                   [](const RunResult& r) { return !std::isnan(r.stiff_from); });
    if (stiff && request.integrators.empty() && !needs_one_step_method(ladders[i].form))
      ladders.insert(ladders.begin() + static_cast<long>(i) + 1,
                     ladder(mechanism, start, request, ladders[i].form, "bdf"));
  }
  if (going)
    time_runs(integrated.mechanism(), integrated.start(), results,
              {request.timing,
               1,
               request.journal,
               request.max_cpu_seconds,
               [&](std::size_t i) {
                 return !request.progress ||
                        request.progress(static_cast<int>(i) + 1, static_cast<int>(results.size()),
                                         "timing " + results[i].settings.form, 1);
               },
               {}});
  return results;
}

double judged_error(const RunResult& run, bool has_reference) {
  return has_reference ? run.position_error_max : run.position_drift_max;
}

std::vector<std::size_t> pareto_front(const std::vector<RunResult>& runs, bool has_reference) {
  std::vector<std::size_t> order;
  if (ambiguity_of(runs).differ) return order;
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (runs[i].status == "done" && reliable(runs[i]) &&
        std::isfinite(judged_error(runs[i], has_reference)) && std::isfinite(runs[i].cpu_s))
      order.push_back(i);
  const auto error = [&](std::size_t i) { return judged_error(runs[i], has_reference); };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return runs[a].cpu_s != runs[b].cpu_s ? runs[a].cpu_s < runs[b].cpu_s : error(a) < error(b);
  });
  std::vector<std::size_t> front;
  for (const std::size_t i : order)
    if (front.empty() || error(i) < error(front.back())) front.push_back(i);
  return front;
}

}  // namespace momenta
