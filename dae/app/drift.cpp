#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/output/conclusion.h>
#include <momenta/dae/study/drift_study.h>
#include <momenta/dae/study/environment.h>

#include "loading.h"
#include "progress.h"
#include "results.h"
#include "verb.h"

namespace momenta::program {
namespace {

struct DriftOptions {
  std::string forms;  ///< comma-separated; empty: all
};

int drift(const Options& o, const DriftOptions& d) {
  const auto mechanism = load(o);
  const auto reference = load_reference(o, *mechanism);
  const Assembly a = assemble(*mechanism);
  const RunDefaults& defaults = mechanism->scene().run;
  DriftRequest request;
  request.forms = names_in(d.forms);
  for (const auto& form : request.forms) is_dae_form(form);  // refuses unknown names before any run
  if (!o.integrator.empty() && integrator(o.integrator).takes != Integrator::Takes::ode)
    throw std::invalid_argument(
        "--integrator " + o.integrator +
        ": is for DAE forms, which run on ida anyway; expected a method of ODE forms, " +
        integrator_names(Integrator::Takes::ode));
  request.integrator = o.integrator;
  if (!o.gauge.empty()) request.gauge = parse_gauge(o.gauge).text();
  request.rtol = o.rtol;
  request.atol = o.atol.value_or(o.rtol);
  request.step = o.step.value_or(o.integrator.empty() ||
                                         integrator(o.integrator).step == Integrator::Step::fixed
                                     ? defaults.step.value_or(0)
                                     : 0);
  request.end_time = o.end.value_or(defaults.end_time);
  request.samples = o.samples.value_or(defaults.samples);
  request.project = o.project;
  request.baumgarte_alpha = o.baumgarte_alpha;
  request.baumgarte_beta = o.baumgarte_beta;
  request.beta = o.beta;
  request.penalty = o.penalty;
  request.reference = reference.get();
  // A form that grinds to a halt must not hold up the others.
  request.max_cpu_seconds = o.cpu_limit.value_or(60);
  request.timing = timing_named(o.timing);
  request.threads = threads_of(0);
  constexpr std::size_t runs_at_most = 24;
  request.film_intervals = film_intervals_of(
      *mechanism, o, request.forms.empty() ? runs_at_most : 3 * request.forms.size());
  expect_own_results(o.out, "study.csv");
  const auto journal = keep_runs(o);
  watch_signals();
  request.journal = journal.get();
  StudyResult study;
  {
    ProgressLine line(o.quiet);
    request.progress = [&](int number, int total, const std::string& label, double fraction) {
      return line.going(number, total, label, fraction);
    };
    study.runs = run_drift_study(*mechanism, a.start, request);
  }
  study.reference = o.reference.string();
  describe(study, o, *mechanism, a);
  return publish(study, conclusion(study) + "\n", o, journal.get());
}

}  // namespace

Verb declare_drift(CLI::App& app, Options& o) {
  const auto own = std::make_shared<DriftOptions>();
  CLI::App& verb =
      add_verb(app, "drift", "Every form side by side: drift, energy, error against run time",
               "momenta drift examples/four_bar/scene.toml --end 5 --out results");
  add_scene(verb, o);
  verb.add_option("--forms", own->forms, "Default: all")->type_name("FORM,...");
  add_run_options(verb, o, "60");
  add_timing(verb, o);
  without(verb, {"--spectral-radius"});
  verb.get_option("--integrator")->description("Of ODE forms (default: rk4, else dop853)");
  return {&verb, [&o, own] { return drift(o, *own); }};
}

}  // namespace momenta::program
