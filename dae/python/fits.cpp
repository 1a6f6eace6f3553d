// Parameters that fit a mechanism to a goal or to measurements, or make a functional of its motion
// least.

#include <momenta/dae/output/fit_report.h>
#include <momenta/dae/output/identification_report.h>
#include <momenta/dae/output/least_report.h>
#include <momenta/dae/study/fit/identification.h>
#include <momenta/dae/study/fit/least.h>

#include "progress.h"
#include "run_arguments.h"

namespace momenta::python {
namespace {

using Names = std::vector<std::string>;

py::dict fit(const Bench& b, const Names& vary, const std::string& sweep, const std::string& to,
             const std::string& least, const Names& keep,
             const std::optional<std::array<double, 2>>& over, int poses, double rate, int starts,
             std::uint64_t seed, int iterations, const std::string& form,
             const std::string& integrator, const std::string& gauge, double rtol,
             const Given& atol, const Given& step, const Given& end,
             const std::optional<bool>& project, double baumgarte_alpha, double baumgarte_beta,
             double beta, const py::object& told) {
  const std::string file = b.mechanism->scene().file,
                    text = b.source.empty() ? toml_of(b) : b.source;
  if (to.empty() == least.empty())
    throw py::value_error(
        "fit: expected either `to`, a file of wanted poses or of a measured motion, or `least`");
  std::vector<FittedParameter> parameters;
  Names names;
  for (const std::string& one : vary) {
    parameters.push_back(FittedParameter::from_text(one));
    names.push_back(parameters.back().name);
  }
  const ParametricMechanism family(text, file, b.set, names,
                                   {.algebra = b.mechanism->options().algebra});
  const SweptWay way{sweep, over, poses, rate};
  Progress progress(told);
  const auto ask = [&](SearchRequest& request) {
    request.parameters = parameters;
    request.starts = starts;
    request.seed = seed;
    request.most_iterations = iterations;
    request.progress = [&](int start, double) {
      return progress(static_cast<double>(start) / starts, "fit");
    };
  };
  std::string json, found;
  SceneText scene{text, file, b.set, b.mechanism->options()};
  scene.options.cut = CutChoice::scene;
  const auto settings = [&] {
    const RunArguments asked{form, integrator, gauge,           rtol,           atol, step, end, {},
                             0.8,  project,    baumgarte_alpha, baumgarte_beta, beta, 0};
    return asked.settings(b.mechanism->scene().run);
  };
  if (!least.empty()) {
    LeastRequest request;
    ask(request);
    request.least = least;
    request.keep = keep;
    if (!sweep.empty()) request.way = way;
    request.scene = scene;
    request.settings = settings();
    progress.during([&] {
      const LeastResult result = momenta::least(family, request);
      json = least_json(result).dump();
      found = family.text(result.found);
    });
  } else if (sweep.empty()) {
    if (!keep.empty())
      throw py::value_error("fit: `keep` does not go with a measured motion, expected one of them");
    IdentificationRequest request;
    ask(request);
    request.scene = scene;
    request.settings = settings();
    const MeasuredMotion measured = read_measured(to, Mechanism(scene.scene(), scene.options));
    progress.during([&] {
      const Identification result = identify(family, measured, request);
      json = identification_json(result).dump();
      found = family.text(result.found);
    });
  } else {
    FitRequest request;
    ask(request);
    request.sweep = sweep;
    request.way = way;
    request.keep = keep;
    const WantedPoses wanted = read_wanted(to, *family.at(family.own()), sweep);
    progress.during([&] {
      const FitResult result = momenta::fit(family, wanted, request);
      json = fit_json(result).dump();
      found = family.text(result.found);
    });
  }
  py::dict all = py::module_::import("json").attr("loads")(json);
  all["scene_text"] = found;
  return all;
}

}  // namespace

void add_fit(py::class_<Bench, BenchPtr>& mechanism) {
  using namespace py::literals;
  mechanism.def(
      "fit", &fit, "vary"_a, py::kw_only(), "sweep"_a = "", "to"_a = "", "least"_a = "",
      "keep"_a = Names(), "over"_a = py::none(), "poses"_a = 73, "rate"_a = 1.0, "starts"_a = 1,
      "seed"_a = 1, "iterations"_a = 500, "form"_a = "momentum", "integrator"_a = "",
      "gauge"_a = "", "rtol"_a = 1e-8, "atol"_a = py::none(), "step"_a = py::none(),
      "end"_a = py::none(), "project"_a = py::none(), "baumgarte_alpha"_a = 0.0,
      "baumgarte_beta"_a = 0.0, "beta"_a = 0.0, "progress"_a = py::none(),
      "Numbers of the scene for which the mechanism does what is wanted or was measured, as a dict "
      "with the keys of fit.json, and scene_text: the scene with these numbers. `vary`: 'NAME' or "
      "'NAME=FROM:TO'. `to`: a file of wanted poses, or, without `sweep`, of a measured motion; or "
      "`least`: a formula of the motion that is to be least, of a motion by `sweep` over (from, "
      "to) [rad or m] in so many `poses` at a "
      "`rate`, or, without `sweep`, of a run. `keep`: conditions, 'a + d <= b + c', "
      "'C.transmission >= 0.7'. Other arguments are those of gradient(). Raises SceneError where "
      "no start is possible, ValueError for what is asked.");
}

}  // namespace momenta::python
