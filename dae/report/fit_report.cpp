#include <momenta/core/text/near_name.h>
#include <momenta/dae/report/csv.h>
#include <momenta/dae/report/fit_report.h>
#include <momenta/dae/report/json.h>
#include <momenta/dae/report/least_report.h>
#include <momenta/dae/text/number_text.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace momenta {
namespace {

using Json = nlohmann::ordered_json;

/// "12 mm and 0.02 rad": the largest errors.
std::string largest(const WantedErrors& e) {
  std::string text;
  if (!std::isnan(e.length_most)) text = length_text(e.length_most);
  if (!std::isnan(e.angle_most))
    text += (text.empty() ? "" : " and ") + compact(e.angle_most, 2) + " rad";
  return text;
}

Json errors_json(const WantedErrors& e) {
  return {{"cost", number_or_null(e.cost)},
          {"length_rms", number_or_null(e.length_rms)},
          {"length_max", number_or_null(e.length_most)},
          {"angle_rms", number_or_null(e.angle_rms)},
          {"angle_max", number_or_null(e.angle_most)}};
}

Json values_json(const FitResult& r, const Eigen::VectorXd& values) {
  Json all = Json::object();
  for (Eigen::Index j = 0; j < values.size(); ++j)
    all[r.parameters[static_cast<std::size_t>(j)].name] = number_or_null(values[j]);
  return all;
}

std::size_t converged(const FitResult& r) {
  return static_cast<std::size_t>(std::count_if(r.starts.begin(), r.starts.end(),
                                                [](const FitStart& s) { return s.converged; }));
}

/// The parameters that ended at an end of their range.
std::vector<std::string> at_ends(const FitResult& r) {
  std::vector<std::string> names;
  for (std::size_t j = 0; j < r.parameters.size(); ++j) {
    const double found = r.found[static_cast<Eigen::Index>(j)];
    if (const auto& range = r.parameters[j].range;
        range && (found <= (*range)[0] || found >= (*range)[1]))
      names.push_back(r.parameters[j].name);
  }
  return names;
}

}  // namespace

std::string fit_in_words(const FitResult& r) {
  const FitStart& best = r.starts[r.best];
  std::string text = "The largest error of " + std::to_string(r.wanted.poses()) +
                     (r.wanted.poses() == 1 ? " pose is " : " poses is ") + largest(r.after) + "; ";
  text += r.why_not_before.empty()
              ? "as the scene is, " + largest(r.before) + "."
              : "the scene as it is does not come to all: " + r.why_not_before + ".";
  if (!best.converged)
    text += " It is no minimum: " + best.why + ".";
  else
    text += r.starts.size() == 1 ? " A minimum, of one start."
                                 : " The least of " + std::to_string(converged(r)) +
                                       " minima from " + std::to_string(r.starts.size()) +
                                       " starts, seed " + std::to_string(r.seed) + ".";
  if (r.stopped) text += " The search was stopped.";
  if (const auto names = at_ends(r); !names.empty())
    text += " At an end of " + std::string(names.size() == 1 ? "its range: " : "their ranges: ") +
            reading::all_in_quotes(names) + ".";
  return text + (r.undetermined.empty() ? "" : " " + r.undetermined);
}

std::string fit_table(const FitResult& r) {
  std::string text = (r.scene.empty() ? "" : r.scene + ": ") + fit_in_words(r) + "\n";
  std::vector<std::vector<std::string>> rows{{"parameter", "before", "after", "from", "to"}};
  for (std::size_t j = 0; j < r.parameters.size(); ++j) {
    const auto at = static_cast<Eigen::Index>(j);
    const auto& range = r.parameters[j].range;
    rows.push_back({r.parameters[j].name, compact(r.own[at], 6), compact(r.found[at], 6),
                    range ? compact((*range)[0], 6) : "-", range ? compact((*range)[1], 6) : "-"});
  }
  return text + "\n" + in_columns(rows) + kept_table(r.keep);
}

std::string fit_csv(const FitResult& r) {
  std::vector<std::string> cells{csv_cell(r.swept.label())};
  for (const auto& quantity : r.wanted.quantities)
    for (const char* what : {".wanted", "", ".before"})
      cells.push_back(csv_cell(quantity.name + what + " [" + quantity.unit + "]"));
  std::string text = csv_line(cells);
  for (Eigen::Index i = 0; i < r.wanted.poses(); ++i) {
    cells = {round_trip(r.places[static_cast<std::size_t>(i)])};
    for (Eigen::Index k = 0; k < r.wanted.values.cols(); ++k) {
      cells.push_back(round_trip(r.wanted.values(i, k)));
      cells.push_back(round_trip(r.reached(i, k)));
      cells.push_back(r.reached_before.size() > 0 ? round_trip(r.reached_before(i, k)) : "");
    }
    text += csv_line(cells);
  }
  return text;
}

Json fit_json(const FitResult& r) {
  Json parameters = Json::object();
  for (std::size_t j = 0; j < r.parameters.size(); ++j) {
    const auto at = static_cast<Eigen::Index>(j);
    const auto& range = r.parameters[j].range;
    parameters[r.parameters[j].name] = {{"before", number_or_null(r.own[at])},
                                        {"after", number_or_null(r.found[at])},
                                        {"from", range ? number_or_null((*range)[0]) : Json()},
                                        {"to", range ? number_or_null((*range)[1]) : Json()}};
  }
  Json starts = Json::array();
  for (const FitStart& s : r.starts)
    starts.push_back({{"from", values_json(r, s.from)},
                      {"to", s.to.size() > 0 ? values_json(r, s.to) : Json()},
                      {"cost", number_or_null(s.cost)},
                      {"iterations", s.iterations},
                      {"cosine", number_or_null(s.cosine)},
                      {"slope", number_or_null(s.slope)},
                      {"violation", number_or_null(s.violation)},
                      {"converged", s.converged},
                      {"why", s.why.empty() ? Json() : Json(s.why)}});
  return {{"scene", r.scene},
          {"swept", r.swept.label()},
          {"wanted", r.wanted.file},
          {"poses", r.wanted.poses()},
          {"places_given", !r.wanted.swept.empty()},
          {"parameters", parameters},
          {"errors", {{"before", errors_json(r.before)}, {"after", errors_json(r.after)}}},
          {"keep", kept_json(r.keep)},
          {"converged", r.starts[r.best].converged},
          {"at_ends", at_ends(r)},
          {"undetermined", r.undetermined.empty() ? Json() : Json(r.undetermined)},
          {"why_not_before", r.why_not_before.empty() ? Json() : Json(r.why_not_before)},
          {"seed", r.seed},
          {"starts", starts},
          {"best", r.best},
          {"stopped", r.stopped},
          {"evaluations", r.evaluations},
          {"derivatives", r.derivatives}};
}

Json fit_charts(const FitResult& r, double first) {
  std::vector<std::size_t> order(r.places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return r.places[a] < r.places[b]; });
  Json t = Json::array();
  for (const std::size_t i : order) t.push_back(number_or_null(r.places[i] - first));
  Json charts = Json::array();
  for (Eigen::Index k = 0; k < r.wanted.values.cols(); ++k) {
    const auto& quantity = r.wanted.quantities[static_cast<std::size_t>(k)];
    Json curves = Json::array();
    const auto add = [&](const char* name, const Eigen::MatrixXd& values, int colour, Json dash) {
      Json y = Json::array();
      for (const std::size_t i : order)
        y.push_back(number_or_null(values(static_cast<Eigen::Index>(i), k)));
      curves.push_back({{"name", name}, {"y", y}, {"colour", colour}, {"dash", dash}});
    };
    add("wanted", r.wanted.values, 1, Json::array());
    add("found", r.reached, 0, Json{6, 4});
    if (r.reached_before.size() > 0) add("before", r.reached_before, 2, Json{2, 4});
    const std::string title = quantity.name + " [" + quantity.unit + "]";
    charts.push_back({{"key", quantity.name},
                      {"title", title},
                      {"x_title", first == 0 ? r.swept.label()
                                             : r.swept.name + " from " + compact(first, 6) + " [" +
                                                   r.swept.unit + "]"},
                      {"y_title", title},
                      {"unit", quantity.unit},
                      {"log", false},
                      {"t", t},
                      {"curves", curves}});
  }
  return charts;
}

}  // namespace momenta
