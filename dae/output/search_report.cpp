#include <momenta/core/text/number_text.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/output/json.h>
#include <momenta/dae/output/search_report.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace momenta {
namespace {}  // namespace

std::vector<std::string> at_ends(const std::vector<FittedParameter>& parameters,
                                 const Eigen::VectorXd& found) {
  std::vector<std::string> names;
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const double value = found[static_cast<Eigen::Index>(j)];
    if (const auto& range = parameters[j].range;
        range && (value <= (*range)[0] || value >= (*range)[1]))
      names.push_back(parameters[j].name);
  }
  return names;
}

std::string at_ends_in_words(const std::vector<FittedParameter>& parameters,
                             const Eigen::VectorXd& found) {
  const std::vector<std::string> names = at_ends(parameters, found);
  if (names.empty()) return "";
  return " At an end of " + std::string(names.size() == 1 ? "its range: " : "their ranges: ") +
         reading::all_in_quotes(names) + ".";
}

std::string parameters_table(const std::vector<FittedParameter>& parameters,
                             const Eigen::VectorXd& own, const Eigen::VectorXd& found,
                             const Eigen::VectorXd& deviations) {
  std::vector<std::vector<std::string>> rows{{"parameter", "before", "after", "from", "to"}};
  if (deviations.size() > 0) rows.front().insert(rows.front().begin() + 3, "std. deviation");
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const auto at = static_cast<Eigen::Index>(j);
    const auto& range = parameters[j].range;
    rows.push_back({parameters[j].name, compact(own[at], 6), compact(found[at], 6),
                    range ? compact((*range)[0], 6) : "-", range ? compact((*range)[1], 6) : "-"});
    if (deviations.size() > 0)
      rows.back().insert(rows.back().begin() + 3,
                         std::isnan(deviations[at]) ? "-" : compact(deviations[at], 2));
  }
  return in_columns(rows);
}

Json parameters_json(const std::vector<FittedParameter>& parameters, const Eigen::VectorXd& own,
                     const Eigen::VectorXd& found, const Eigen::VectorXd& deviations) {
  Json all = Json::object();
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const auto at = static_cast<Eigen::Index>(j);
    const auto& range = parameters[j].range;
    all[parameters[j].name] = {{"before", number_or_null(own[at])},
                               {"after", number_or_null(found[at])},
                               {"from", range ? number_or_null((*range)[0]) : Json()},
                               {"to", range ? number_or_null((*range)[1]) : Json()}};
    if (deviations.size() > 0)
      all[parameters[j].name]["deviation"] = number_or_null(deviations[at]);
  }
  return all;
}

Json starts_json(const std::vector<FittedParameter>& parameters,
                 const std::vector<FitStart>& starts) {
  Json all = Json::array();
  for (const FitStart& s : starts)
    all.push_back({{"from", values_json(parameters, s.from)},
                   {"to", values_json(parameters, s.to)},
                   {"cost", number_or_null(s.cost)},
                   {"iterations", s.iterations},
                   {"cosine", number_or_null(s.cosine)},
                   {"slope", number_or_null(s.slope)},
                   {"violation", number_or_null(s.violation)},
                   {"converged", s.converged},
                   {"why", s.why.empty() ? Json() : Json(s.why)}});
  return all;
}

Json values_json(const std::vector<FittedParameter>& parameters, const Eigen::VectorXd& values) {
  if (values.size() == 0) return {};
  Json all = Json::object();
  for (std::size_t j = 0; j < parameters.size(); ++j)
    all[parameters[j].name] = number_or_null(values[static_cast<Eigen::Index>(j)]);
  return all;
}

Json kept_json(const std::vector<UserConstraint>& keep) {
  Json all = Json::array();
  for (const UserConstraint& c : keep)
    all.push_back({{"condition", c.text},
                   {"before", number_or_null(c.before)},
                   {"after", number_or_null(c.after)},
                   {"multiplier", number_or_null(c.multiplier)}});
  return all;
}

std::string kept_table(const std::vector<UserConstraint>& keep) {
  if (keep.empty()) return "";
  std::vector<std::vector<std::string>> rows{{"condition", "room before", "after", "multiplier"}};
  for (const UserConstraint& c : keep)
    rows.push_back({c.text, compact(c.before, 3),
                    std::abs(c.after) < 1e-9 ? "0" : compact(c.after, 3),
                    c.multiplier == 0 ? "0" : compact(c.multiplier, 3)});
  return "\n" + in_columns(rows);
}

SweptCharts::SweptCharts(const Column& swept, const std::vector<double>& places, double first)
    : order_(places.size()),
      t_(Json::array()),
      charts_(Json::array()),
      x_title_(first == 0 ? swept.label()
                          : swept.name + " from " + compact(first, 6) + " [" + swept.unit + "]") {
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::stable_sort(order_.begin(), order_.end(),
                   [&](std::size_t a, std::size_t b) { return places[a] < places[b]; });
  for (const std::size_t i : order_) t_.push_back(number_or_null(places[i] - first));
}

void SweptCharts::add(const std::string& name, const std::string& unit,
                      const std::vector<SweptCurve>& curves) {
  Json all = Json::array();
  for (const SweptCurve& curve : curves) {
    Json y = Json::array();
    for (const std::size_t i : order_)
      y.push_back(number_or_null(curve.values[static_cast<Eigen::Index>(i)]));
    all.push_back(
        {{"name", curve.name}, {"y", y}, {"colour", curve.colour}, {"dash", Json(curve.dash)}});
  }
  const std::string title = unit.empty() ? name : name + " [" + unit + "]";
  charts_.push_back({{"key", name},
                     {"title", title},
                     {"x_title", x_title_},
                     {"y_title", title},
                     {"unit", unit},
                     {"log", false},
                     {"t", t_},
                     {"curves", all}});
}

}  // namespace momenta
