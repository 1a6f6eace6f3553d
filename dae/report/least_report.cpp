#include <momenta/core/text/near_name.h>
#include <momenta/dae/report/csv.h>
#include <momenta/dae/report/json.h>
#include <momenta/dae/report/least_report.h>
#include <momenta/dae/text/number_text.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace momenta {
namespace {

using Ordered = nlohmann::ordered_json;

Ordered by_name(const LeastResult& r, const Eigen::VectorXd& values) {
  if (values.size() == 0) return {};
  Ordered all = Ordered::object();
  for (Eigen::Index j = 0; j < values.size(); ++j)
    all[r.parameters[static_cast<std::size_t>(j)].name] = number_or_null(values[j]);
  return all;
}

/// How many starts ended in a minimum.
std::ptrdiff_t minima(const LeastResult& r) {
  return std::count_if(r.starts.begin(), r.starts.end(),
                       [](const LeastStart& s) { return s.converged; });
}

}  // namespace

std::string least_in_words(const LeastResult& r) {
  const LeastStart& best = r.starts[r.best];
  std::string text = r.least + " is " + compact(r.after, 6) + "; ";
  text += r.why_not_before.empty() ? "as the scene is, " + compact(r.before, 6) + "."
                                   : "the scene as it is has none: " + r.why_not_before + ".";
  if (!best.converged)
    text += " It is no minimum: " + best.why + ".";
  else
    text += r.starts.size() == 1 ? " A minimum, of one start."
                                 : " The least of " + std::to_string(minima(r)) + " minima from " +
                                       std::to_string(r.starts.size()) + " starts, seed " +
                                       std::to_string(r.seed) + ".";
  if (r.stopped) text += " The search was stopped.";
  std::vector<std::string> at_limit;
  for (const KeptCondition& c : r.keep)
    if (!c.equal && c.multiplier > 0) at_limit.push_back(c.text);
  if (!at_limit.empty()) text += " Held by " + reading::all_in_quotes(at_limit) + ".";
  std::vector<std::string> at_ends;
  for (std::size_t j = 0; j < r.parameters.size(); ++j) {
    const double found = r.found[static_cast<Eigen::Index>(j)];
    if (const auto& range = r.parameters[j].range;
        range && (found <= (*range)[0] || found >= (*range)[1]))
      at_ends.push_back(r.parameters[j].name);
  }
  if (!at_ends.empty())
    text += " At an end of " + std::string(at_ends.size() == 1 ? "its range: " : "their ranges: ") +
            reading::all_in_quotes(at_ends) + ".";
  for (const std::string& remark : r.remarks) text += " Remark: " + remark + ".";
  return text;
}

std::string kept_table(const std::vector<KeptCondition>& keep) {
  if (keep.empty()) return "";
  std::vector<std::vector<std::string>> rows{{"condition", "room before", "after", "multiplier"}};
  for (const KeptCondition& c : keep)
    rows.push_back({c.text, compact(c.before, 3),
                    std::abs(c.after) < 1e-9 ? "0" : compact(c.after, 3),
                    c.multiplier == 0 ? "0" : compact(c.multiplier, 3)});
  return "\n" + in_columns(rows);
}

std::string least_table(const LeastResult& r) {
  std::string text = (r.scene.empty() ? "" : r.scene + ": ") + least_in_words(r) + "\n";
  std::vector<std::vector<std::string>> rows{{"parameter", "before", "after", "from", "to"}};
  for (std::size_t j = 0; j < r.parameters.size(); ++j) {
    const auto at = static_cast<Eigen::Index>(j);
    const auto& range = r.parameters[j].range;
    rows.push_back({r.parameters[j].name, compact(r.own[at], 6), compact(r.found[at], 6),
                    range ? compact((*range)[0], 6) : "-", range ? compact((*range)[1], 6) : "-"});
  }
  return text + "\n" + in_columns(rows) + kept_table(r.keep);
}

std::string least_csv(const LeastResult& r) {
  std::vector<std::string> cells{csv_cell(r.swept ? r.swept->label() : "")};
  for (const auto& curve : r.curves)
    for (const char* when : {"", " before"}) cells.push_back(csv_cell(curve.formula + when));
  std::string text = csv_line(cells);
  for (std::size_t i = 0; i < r.places.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    cells = {round_trip(r.places[i])};
    for (const auto& curve : r.curves) {
      cells.push_back(round_trip(curve.after[at]));
      cells.push_back(curve.before.size() > 0 ? round_trip(curve.before[at]) : "");
    }
    text += csv_line(cells);
  }
  return text;
}

Ordered kept_json(const std::vector<KeptCondition>& keep) {
  Ordered all = Ordered::array();
  for (const KeptCondition& c : keep)
    all.push_back({{"condition", c.text},
                   {"before", number_or_null(c.before)},
                   {"after", number_or_null(c.after)},
                   {"multiplier", number_or_null(c.multiplier)}});
  return all;
}

Ordered least_json(const LeastResult& r) {
  Ordered parameters = Ordered::object();
  for (std::size_t j = 0; j < r.parameters.size(); ++j) {
    const auto at = static_cast<Eigen::Index>(j);
    const auto& range = r.parameters[j].range;
    parameters[r.parameters[j].name] = {{"before", number_or_null(r.own[at])},
                                        {"after", number_or_null(r.found[at])},
                                        {"from", range ? number_or_null((*range)[0]) : Ordered()},
                                        {"to", range ? number_or_null((*range)[1]) : Ordered()},
                                        {"derivative", number_or_null(r.gradient[at])}};
  }
  Ordered starts = Ordered::array();
  for (const LeastStart& s : r.starts)
    starts.push_back({{"from", by_name(r, s.from)},
                      {"to", by_name(r, s.to)},
                      {"value", number_or_null(s.value)},
                      {"violation", number_or_null(s.violation)},
                      {"slope", number_or_null(s.slope)},
                      {"iterations", s.iterations},
                      {"converged", s.converged},
                      {"why", s.why.empty() ? Ordered() : Ordered(s.why)}});
  return {{"scene", r.scene},
          {"least", r.least},
          {"motion", r.run ? "run" : "swept"},
          {"swept", r.swept ? Ordered(r.swept->label()) : Ordered()},
          {"before", number_or_null(r.before)},
          {"after", number_or_null(r.after)},
          {"parameters", parameters},
          {"keep", kept_json(r.keep)},
          {"converged", r.starts[r.best].converged},
          {"why_not_before", r.why_not_before.empty() ? Ordered() : Ordered(r.why_not_before)},
          {"seed", r.seed},
          {"starts", starts},
          {"best", r.best},
          {"stopped", r.stopped},
          {"remarks", r.remarks},
          {"evaluations", r.evaluations},
          {"derivatives", r.derivatives}};
}

Ordered least_charts(const LeastResult& r, double first) {
  // The film goes half a turn to each side of the start: a turn is told where it shows it.
  constexpr double turn = 2 * std::numbers::pi;
  const bool whole = r.swept && r.swept->unit == "rad" && !r.places.empty() &&
                     std::abs(r.places.back() - r.places.front() - turn) < 1e-9;
  std::vector<double> places = r.places;
  if (whole) {
    places.pop_back();
    for (double& s : places)
      if (s > first + turn) s -= turn;
  }
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return places[a] < places[b]; });
  Ordered t = Ordered::array();
  for (const std::size_t i : order) t.push_back(number_or_null(places[i] - first));
  Ordered charts = Ordered::array();
  for (const auto& curve : r.curves) {
    Ordered curves = Ordered::array();
    const auto add = [&](const char* name, const Eigen::VectorXd& values, int colour,
                         Ordered dash) {
      Ordered y = Ordered::array();
      for (const std::size_t i : order)
        y.push_back(number_or_null(values[static_cast<Eigen::Index>(i)]));
      curves.push_back({{"name", name}, {"y", y}, {"colour", colour}, {"dash", dash}});
    };
    add("found", curve.after, 0, Ordered::array());
    if (curve.before.size() > 0) add("before", curve.before, 2, Ordered{2, 4});
    charts.push_back({{"key", curve.formula},
                      {"title", curve.formula},
                      {"x_title", first == 0 ? r.swept->label()
                                             : r.swept->name + " from " + compact(first, 6) + " [" +
                                                   r.swept->unit + "]"},
                      {"y_title", curve.formula},
                      {"unit", ""},
                      {"log", false},
                      {"t", t},
                      {"curves", curves}});
  }
  return charts;
}

}  // namespace momenta
