// Reading of scenes, and the verbs evaluate, index, sweep and view for the functions of the
// package. States and results are text in the formats of the program.

#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/format/toml/write_scene.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/output/index_report.h>
#include <momenta/dae/output/mechanism_view.h>
#include <momenta/dae/output/page.h>
#include <momenta/dae/output/part_file.h>
#include <momenta/dae/output/state_report.h>
#include <momenta/dae/output/sweep_report.h>
#include <momenta/dae/run/state_input.h>
#include <momenta/dae/study/environment.h>

#include <array>
#include <atomic>
#include <cmath>
#include <optional>

#include "progress.h"
#include "run_arguments.h"

namespace momenta::python {
namespace {

using Names = std::vector<std::string>;
using Numbers = std::vector<std::pair<std::string, double>>;
using Stops = std::optional<std::array<double, 2>>;

std::vector<Setting> settings_from(const Numbers& set) {
  std::vector<Setting> settings;
  for (const auto& [place, value] : set) {
    if (!std::isfinite(value))
      throw py::value_error("set '" + place + "': expected a finite number");
    settings.push_back({place, value});
  }
  return settings;
}

/// `text`: TOML of the scene, `set` included; empty: another format.
BenchPtr ready(Scene scene, const std::string& text, const Numbers& set, const std::string& at,
               const std::string& algebra, const std::string& kkt, const std::string& cut) {
  if (!at.empty()) start_at(at, scene);
  auto bench = std::make_shared<Bench>(std::move(scene), algebra, kkt, cut);
  if (!at.empty()) return bench;
  if (set.empty()) bench->text = text;
  bench->source = text;
  bench->set = settings_from(set);
  return bench;
}

std::string index_text(const Bench& b, const Names& forms, const std::string& at,
                       const py::object& told) {
  Progress progress(told);
  IndexStudy study;
  progress.during([&] {
    const std::size_t total = forms.empty() ? form_names().size() : forms.size();
    std::size_t number = 0;
    study = run_index_study(
        *b.mechanism, start_of(at, *b.mechanism), forms, [&](const std::string& form) {
          return progress(static_cast<double>(number++) / static_cast<double>(total), form);
        });
  });
  return index_json(study).dump();
}

std::string page(const Bench& b, const std::string& file) {
  const Mechanism& mechanism = *b.mechanism;
  expect_drawable(mechanism);
  const Assembly assembly = assemble(mechanism);
  StudyResult study;
  study.scene = mechanism.scene().name;
  study.scene_file = file;
  study.plan = plan_lines(mechanism);
  study.environment = environment();
  show(study, mechanism, assembly);
  return view_page(study, still_words(mechanism, assembly));
}

/// The cases of a sweep; several threads may run them.
class Cases {
 public:
  Cases(const std::string& text, const std::string& file, const std::string& algebra,
        const std::string& kkt, const std::string& cut, const Names& vary, const Names& watch,
        const std::optional<SampleSettings>& sample, double cpu_limit, const RunArguments& asked) {
    const Scene scene = parse_scene(text, file);
    static_cast<void>(asked.settings(scene.run));  // raises an error of all cases once
    request_.text = text;
    request_.file = file;
    request_.mechanism = options_of(algebra, kkt, cut);
    for (const std::string& place : vary) request_.varied.emplace_back(place);
    if (sample) request_.sample = std::make_shared<Sample>(*sample, vary.size());
    request_.watched = watch;
    request_.max_cpu_seconds = cpu_time(cpu_limit);
    request_.settings = [asked](const RunDefaults& defaults) { return asked.settings(defaults); };
    request_.going_on = [this] { return !stopped_; };
    cases_.resize(request_.cases());
  }
  std::size_t count() const { return cases_.size(); }
  void make(std::size_t number) { cases_.at(number) = run_case(request_, number); }
  void stop() { stopped_ = true; }
  std::string csv() const { return sweep_csv(request_, cases_); }
  std::string json() { return sweep_json(request_, cases_, statistics()).dump(); }
  std::string table() { return sweep_table(request_, cases_, statistics()); }

 private:
  /// Statistics of all cases, made once; null without a sample.
  const SweepStatistics* statistics() {
    if (!request_.sample) return nullptr;
    if (!statistics_) statistics_ = sweep_statistics(request_, cases_);
    return &*statistics_;
  }

  SweepRequest request_;
  std::vector<SweepCase> cases_;
  std::optional<SweepStatistics> statistics_;
  std::atomic<bool> stopped_{false};
};

std::unique_ptr<Cases> cases(const std::string& text, const std::string& file,
                             const std::string& algebra, const std::string& kkt,
                             const std::string& cut, const Names& vary, const Names& watch,
                             const std::string& sample, const std::optional<std::size_t>& points,
                             const std::optional<std::uint64_t>& seed, bool indices,
                             const std::string& form, const std::string& integrator,
                             const std::string& gauge, double rtol, const Given& atol,
                             const Given& step, const Given& end, const std::optional<int>& samples,
                             double spectral_radius, const std::optional<bool>& project,
                             double baumgarte_alpha, double baumgarte_beta, double beta,
                             double penalty, double cpu_limit) {
  return std::make_unique<Cases>(
      text, file, algebra, kkt, cut, vary, watch, sample_settings(sample, points, seed, indices),
      cpu_limit,
      RunArguments{form, integrator, gauge, rtol, atol, step, end, samples, spectral_radius,
                   project, baumgarte_alpha, baumgarte_beta, beta, penalty});
}

}  // namespace

void bind_verbs(py::module_& module) {
  using namespace py::literals;
  module.def(
      "read",
      [](const std::string& file, const std::string& loops, bool free_root, const std::string& key,
         const Names& controls, const Stops& stops, const Numbers& set, const std::string& at,
         const std::string& algebra, const std::string& kkt, const std::string& cut) {
        // With stops, the file has the text of another scene.
        const bool as_written = !stops && is_toml(file);
        return ready(read_scene(file, {loops, free_root, key, controls, stops}, settings_from(set)),
                     as_written ? reading::text_of(file) : "", set, at, algebra, kkt, cut);
      },
      "file"_a, "loops"_a, "free_root"_a, "key"_a, "controls"_a, "stops"_a, "set"_a, "at"_a,
      "algebra"_a, "kkt"_a, "cut"_a);
  module.def(
      "parse",
      [](const std::string& text, const std::string& name, const Stops& stops, const Numbers& set,
         const std::string& at, const std::string& algebra, const std::string& kkt,
         const std::string& cut) {
        Scene scene = parse_scene(text, name, settings_from(set));
        if (stops) stop_at_limits(scene, *stops);
        return ready(std::move(scene), stops ? "" : text, set, at, algebra, kkt, cut);
      },
      "text"_a, "name"_a, "stops"_a, "set"_a, "at"_a, "algebra"_a, "kkt"_a, "cut"_a);
  module.def("toml_of", &toml_of, "mechanism"_a);
  module.def(
      "evaluate",
      [](const Bench& b, const std::string& at) {
        const GivenState given = read_state(at, *b.mechanism);
        return state_json(*b.mechanism, given, evaluate_state(*b.mechanism, given));
      },
      "mechanism"_a, "at"_a);
  module.def("index", &index_text, "mechanism"_a, "forms"_a, "at"_a, "progress"_a);
  module.def("page", &page, "mechanism"_a, "file"_a);
  module.def(
      "write",
      [](const std::string& file, const std::string& text) {
        if (const auto problem = atomic_write({{file, text}})) throw py::value_error(*problem);
      },
      "file"_a, "text"_a);
  py::class_<Cases> all(module, "Cases");
  with_run_arguments([&](const auto&... arguments) {
    all.def(py::init(&cases), "text"_a, "file"_a, "algebra"_a, "kkt"_a, "cut"_a, "vary"_a,
            "watch"_a, "sample"_a, "points"_a, "seed"_a, "indices"_a, arguments...);
  });
  all.def("__len__", &Cases::count)
      .def("make", &Cases::make, "number"_a, py::call_guard<py::gil_scoped_release>())
      .def("stop", &Cases::stop)
      .def("csv", &Cases::csv)
      .def("json", &Cases::json)
      .def("table", &Cases::table);
}

}  // namespace momenta::python
