#include <momenta/dae/form/form.h>
#include <momenta/dae/output/chart.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/output/json.h>
#include <momenta/dae/output/page_data.h>
#include <momenta/dae/output/picture_data.h>
#include <momenta/dae/output/run_label.h>
#include <momenta/dae/output/sampled_curves.h>
#include <momenta/dae/run/departures.h>
#include <momenta/dae/study/work_study.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace momenta {
namespace {

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
  Json series = Json::object();
  for (const History& history : histories(run)) {
    const std::vector<double>& y = run.series.*history.values;
    // |λ| is a force and |σ| an impulse: only forms with impulses share the axis.
    if (std::string_view(history.key) == "impulse" && !takes_gauge(run.settings.form)) continue;
    if (std::any_of(y.begin(), y.end(), [](double v) { return std::isfinite(v); }))
      series[history.key] = curve(run.series.t, y);
  }
  return series;
}

Json growth_json(const Growth& g) {
  return {{"exponent", number_or_null(g.exponent)},
          {"half_range", number_or_null(g.half_range)},
          {"power", g.is_power()},
          {"from", number_or_null(g.from)},
          {"to", number_or_null(g.to)}};
}

Json pairs_json(const std::vector<std::pair<std::string, std::string>>& pairs) {
  Json json = Json::array();
  for (const auto& [name, value] : pairs) json.push_back(Json::array({name, value}));
  return json;
}

Json histories_json(const StudyResult& study) {
  Json all = Json::array();
  for (const History& h : histories(study.runs.empty() ? RunResult() : study.runs.front()))
    all.push_back({{"key", h.key},
                   {"title", h.title},
                   {"yTitle", h.axis},
                   {"unit", h.unit},
                   {"slopes", h.slopes}});
  return all;
}

Json motions_json(const StudyResult& study) {
  Json motions = Json::array();
  for (const Motion& motion : study.motions) motions.push_back(motion_json(study.picture, motion));
  return motions;
}

}  // namespace

Json page_data(const StudyResult& study) {
  const auto labels = run_labels(study), ladder_labels = run_labels(study, false);
  const auto ladder = ladders(study);
  const auto curves = runs_with_curves(study);
  const auto signs = signs_of(study);

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
    json["sign"] = {
        {"colour", signs[i].colour}, {"dash", signs[i].dash}, {"marker", signs[i].marker}};
    json["best"] = std::find(front.begin(), front.end(), i) != front.end();
    json["baumgarte"] = {run.settings.baumgarte_alpha, run.settings.baumgarte_beta};
    json["growth"] = {{"position", growth_json(run.position_growth)},
                      {"velocity", growth_json(run.velocity_growth)},
                      {"angle", growth_json(run.angle_growth)},
                      {"angle_rate", growth_json(run.angle_rate_growth)}};
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
          {"ambiguous", ambiguity_of(study.runs).differ},
          {"plan", pairs_json(study.plan)},
          {"environment", environment_json(study.environment)},
          {"palette", palette},
          {"histories", histories_json(study)},
          {"picture", picture_json(study.picture)},
          {"motions", motions_json(study)},
          {"csv", study_csv(study)},
          {"runs", runs}};
}

namespace {

constexpr std::size_t stretches = 300, most_curves = 24;

/// Least and largest of each stretch of y, in their order; all of y where few.
std::vector<double> extremes_of(const std::vector<double>& y) {
  if (y.size() <= 2 * stretches) return y;
  std::vector<double> kept;
  for (std::size_t i = 0; i < stretches; ++i) {
    const std::size_t from = i * y.size() / stretches, to = (i + 1) * y.size() / stretches;
    std::size_t low = from, high = from;
    for (std::size_t k = from; k < to; ++k) {
      if (y[k] < y[low] || std::isnan(y[low])) low = k;
      if (y[k] > y[high] || std::isnan(y[high])) high = k;
    }
    kept.push_back(y[std::min(low, high)]);
    kept.push_back(y[std::max(low, high)]);
  }
  return kept;
}
/// First and middle time of each stretch.
std::vector<double> times_of(const std::vector<double>& t) {
  if (t.size() <= 2 * stretches) return t;
  std::vector<double> kept;
  for (std::size_t i = 0; i < 2 * stretches; ++i) kept.push_back(t[i * t.size() / (2 * stretches)]);
  kept.back() = t.back();
  return kept;
}
Json drawn_all(const std::vector<double>& values) {
  Json all = Json::array();
  for (const double v : values) all.push_back(std::isfinite(v) ? Json(drawn(v)) : Json());
  return all;
}

}  // namespace

Json timeline_json(const RunResult& run) {
  Json charts = Json::array();
  for (const Chart& chart : charts_of_run(run)) {
    Json curves = Json::array();
    for (const Curve& curve : chart.curves) {
      if (curves.size() == most_curves) break;
      curves.push_back({{"name", curve.name},
                        {"y", drawn_all(extremes_of(curve.y))},
                        {"colour", curve.sign.colour},
                        {"dash", curve.sign.dash}});
    }
    charts.push_back({{"key", chart.key},
                      {"title", chart.title},
                      {"y_title", chart.y_title},
                      {"unit", chart.unit},
                      {"log", chart.log_y},
                      {"left_out", chart.curves.size() - curves.size()},
                      {"t", drawn_all(times_of(chart.curves.front().x))},
                      {"curves", curves}});
  }
  return charts;
}

}  // namespace momenta
