#include <momenta/core/text/number_text.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/output/advice.h>
#include <momenta/dae/output/conclusion.h>
#include <momenta/dae/output/table.h>
#include <momenta/dae/run/force_columns.h>
#include <momenta/dae/study/own_reference.h>
#include <momenta/dae/study/run_record.h>
#include <momenta/dae/study/work_study.h>

#include <cmath>

#include "equation_verbs.h"
#include "loading.h"
#include "progress.h"
#include "results.h"
#include "verb.h"

namespace momenta::program {
namespace {

constexpr int own_reference_rows = 100;

}  // namespace

std::vector<double> tolerance_rungs(const WorkOptions& w) {
  if (!(w.tightest <= w.loosest))
    throw std::invalid_argument("--from " + compact(w.loosest, 3) + " --to " +
                                compact(w.tightest, 3) +
                                ": expected the loosest tolerance first, the tightest last");
  const double decades = std::log10(w.loosest / w.tightest);
  const int count = static_cast<int>(std::floor(decades * w.per_decade + 1e-9));
  std::vector<double> tolerances;
  for (int i = 0; i <= count; ++i)
    tolerances.push_back(w.loosest * std::pow(10.0, -static_cast<double>(i) / w.per_decade));
  return tolerances;
}

namespace {

int work(const Options& o, const WorkOptions& w) {
  const auto mechanism = load(o);
  auto reference = load_reference(o, *mechanism);
  const Assembly a = assemble(*mechanism);
  const RunDefaults& defaults = mechanism->scene().run;
  WorkRequest request;
  request.forms = names_in(w.forms);
  for (const auto& form : request.forms) is_dae_form(form);  // refuses unknown names before any run
  request.integrators = names_in(w.integrators);
  for (const auto& name : request.integrators) integrator(name);
  if (!o.gauge.empty()) request.gauge = parse_gauge(o.gauge).text();
  request.tolerances = tolerance_rungs(w);
  request.end_time = o.end.value_or(defaults.end_time);
  const double step = o.step.value_or(defaults.step.value_or(request.end_time / 500));
  for (int i = 0; i < w.step_rungs; ++i) request.steps.push_back(std::ldexp(step, 1 - i));
  request.samples = o.samples.value_or(own_reference_rows);
  request.max_cpu_seconds = o.cpu_limit.value_or(10);
  if (w.orders && w.no_reference)
    throw std::invalid_argument(
        "--orders --no-reference: observed orders are those of errors, expected a reference");
  request.timing = timing_named(o.timing);
  expect_own_results(o.out, "study.csv");
  const auto journal = keep_runs(o);
  watch_signals();
  request.journal = journal.get();
  StudyResult study;
  study.drift_study = false;
  study.reference = o.reference.string();
  {
    ProgressLine line(o.quiet);
    if (!reference && !w.no_reference) {
      auto known = recall<OwnReference>(journal.get(), "reference");
      if (known) known->reference.bind(measured_columns(*mechanism));
      OwnReference own = known ? *std::move(known)
                               : own_reference(
                                     *mechanism, a.start, request.end_time, own_reference_rows,
                                     [&](double t) {
                                       line.show("reference  t = " + compact(t, 4) + " s");
                                       return !interrupted();
                                     },
                                     true);
      if (journal && !known) journal->add("reference", record_of(own));
      study.reference = in_words(own);
      reference = std::make_unique<Reference>(std::move(own.reference));
    }
    request.reference = reference.get();
    request.progress = [&](int number, int total, const std::string& label, double fraction) {
      return line.going(number, total, label, fraction);
    };
    study.runs = run_work_study(*mechanism, a.start, request);
  }
  describe(study, o, *mechanism, a);
  std::vector<ResultFile> files;
  const bool own = o.reference.empty() && reference;
  if (own && !o.out.empty()) files.push_back({o.out / "reference.csv", reference->csv()});
  const std::string first = reservations(study);
  return publish(
      study, (first.empty() ? "" : first + "\n") + (w.orders ? order_table(study) : advice(study)),
      o, journal.get(), std::move(files));
}

}  // namespace

Verb declare_work(CLI::App& app, Options& o) {
  const auto own = std::make_shared<WorkOptions>();
  CLI::App& verb =
      add_verb(app, "work", "Error against run time: every form over a series of tolerances",
               "momenta work examples/four_bar/scene.toml --forms momentum --end 1");
  add_scene(verb, o);
  verb.add_option("--forms", own->forms, "Default: all")->type_name("FORM,...");
  verb.add_option("--integrators", own->integrators, "Each for the forms it takes")
      ->type_name("INTEGRATOR,...");
  positive(verb.add_option("--from", own->loosest, "Loosest tolerance"), "X")
      ->capture_default_str();
  positive(verb.add_option("--to", own->tightest, "Tightest tolerance"), "X")
      ->capture_default_str();
  within(verb.add_option("--per-decade", own->per_decade, "Tolerances in a decade"), "X", 0.25,
         100.0)
      ->capture_default_str();
  within(verb.add_option("--step-rungs", own->step_rungs,
                         "Number of step sizes: 2*step, step, step/2 ..."),
         "N", 1, 40)
      ->capture_default_str();
  verb.add_flag("--no-reference", own->no_reference,
                "Judge by the largest drift alone; print orders");
  verb.add_flag("--orders", own->orders, "Print observed orders in place of the conclusion");
  add_run_options(verb, o, "10");
  add_timing(verb, o);
  without(verb, {"--integrator", "--rtol", "--atol", "--spectral-radius", "--project",
                 "--no-project", "--baumgarte-alpha", "--baumgarte-beta", "--beta", "--penalty"});
  return {&verb, [&o, own] { return work(o, *own); },
          [&o, own] { return work_on_equations(o, *own); }};
}

}  // namespace momenta::program
