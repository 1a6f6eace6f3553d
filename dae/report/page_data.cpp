#include <momenta/dae/form/form.h>
#include <momenta/dae/report/csv.h>
#include <momenta/dae/report/json.h>
#include <momenta/dae/report/page_data.h>
#include <momenta/dae/report/run_label.h>
#include <momenta/dae/report/thinning.h>
#include <momenta/dae/study/work_study.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace momenta {
namespace {

using Json = nlohmann::ordered_json;

// Five digits: finer than a pixel of a decade, and half the bytes of seventeen.
double drawn(double value) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                 std::chars_format::scientific, 4);
  double rounded = value;
  std::from_chars(text.data(), end.ptr, rounded);
  return rounded;
}

Json curve(const std::vector<double>& t, const std::vector<double>& y) {
  Json times = Json::array(), values = Json::array();
  for (const std::size_t i : thinned(t, y, points_per_curve)) {
    times.push_back(drawn(t[i]));
    values.push_back(drawn(std::abs(y[i])));
  }
  return {{"t", times}, {"y", values}};
}

Json series_json(const RunResult& run) {
  const Series& s = run.series;
  Json series = Json::object();
  const auto add = [&](const char* name, const std::vector<double>& y) {
    if (std::any_of(y.begin(), y.end(), [](double v) { return std::isfinite(v); })) {
      series[name] = curve(s.t, y);
    }
  };
  add("position_drift", s.position_drift);
  add("velocity_drift", s.velocity_drift);
  add("energy_error", s.energy_error);
  // |λ| is a force and |σ| an impulse: only forms with impulses share the axis.
  if (takes_gauge(run.settings.form)) add("impulse", s.impulse);
  add("position_error", s.position_error);
  return series;
}

Json growth_json(const Growth& g) {
  return {{"exponent", number_or_null(g.exponent)},
          {"half_range", number_or_null(g.half_range)},
          {"from", number_or_null(g.from)},
          {"to", number_or_null(g.to)}};
}

Json pairs_json(const std::vector<std::pair<std::string, std::string>>& pairs) {
  Json json = Json::array();
  for (const auto& [name, value] : pairs) json.push_back(Json::array({name, value}));
  return json;
}

Json sketch_json(const Sketch& sketch) {
  Json lines = Json::array(), points = Json::array();
  for (const auto& line : sketch.lines)
    lines.push_back({{"body", line.body}, {"points", line.points}});
  for (const auto& point : sketch.points) {
    points.push_back({{"name", point.name}, {"kind", point.kind}, {"at", point.at}});
  }
  return {{"lines", lines}, {"points", points}};
}

}  // namespace

Json page_data(const StudyResult& study) {
  const auto labels = run_labels(study), ladder_labels = run_labels(study, false);
  const auto ladder = ladders(study);
  const auto curves = runs_with_curves(study);

  const bool reference = !study.reference.empty();
  const auto front =
      study.drift_study ? std::vector<std::size_t>{} : pareto_front(study.runs, reference);

  Json runs = Json::array();
  for (std::size_t i = 0; i < study.runs.size(); ++i) {
    const RunResult& run = study.runs[i];
    Json json = summary_json(run, study.environment);
    json.erase("environment");
    json["label"] = labels[i];
    json["ladder_label"] = ladder_labels[i];
    json["tolerance"] = tolerance_text(run.settings);
    json["ladder"] = ladder[i];
    json["best"] = std::find(front.begin(), front.end(), i) != front.end();
    json["baumgarte"] = {run.settings.baumgarte_alpha, run.settings.baumgarte_beta};
    json["growth"] = {{"position", growth_json(run.position_growth)},
                      {"velocity", growth_json(run.velocity_growth)}};
    const bool drawn = std::binary_search(curves.begin(), curves.end(), i);
    json["series"] = drawn ? series_json(run) : Json::object();
    runs.push_back(std::move(json));
  }
  return {{"scene", study.scene},
          {"scene_file", study.scene_file},
          {"scene_hash", study.scene_hash},
          {"command", study.command},
          {"reference", study.reference},
          {"drift_study", study.drift_study},
          {"plan", pairs_json(study.plan)},
          {"environment", environment_json(study.environment)},
          {"sketch", sketch_json(study.sketch)},
          {"csv", study_csv(study)},
          {"runs", runs}};
}

}  // namespace momenta
