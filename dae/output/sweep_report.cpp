#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/output/json.h>
#include <momenta/dae/output/sample_report.h>
#include <momenta/dae/output/sweep_report.h>

#include <algorithm>
#include <map>

namespace momenta {
namespace {

constexpr std::size_t most_lines = 40;

std::map<std::string, std::size_t> counts(const std::vector<SweepCase>& cases) {
  std::map<std::string, std::size_t> all;
  for (const SweepCase& c : cases) ++all[c.status];
  return all;
}

/// The case with the greatest measure; null: measured nowhere.
const SweepCase* greatest(const std::vector<SweepCase>& cases, const SweepMeasure& measure) {
  const SweepCase* best = nullptr;
  for (const SweepCase& c : cases) {
    const double x = measure.of(c);
    if (x == x && (!best || x > measure.of(*best))) best = &c;
  }
  return best;
}

/// Unit of the first case with loops: cases differ in numbers, not in rows.
std::string drift_unit(const std::vector<SweepCase>& cases) {
  const auto looped = std::find_if(cases.begin(), cases.end(),
                                   [](const SweepCase& c) { return !c.drift_unit.empty(); });
  return looped == cases.end() ? "m" : looped->drift_unit;
}

std::string values_in_words(const SweepRequest& request, const SweepCase& c) {
  std::string words;
  for (std::size_t i = 0; i < c.values.size(); ++i)
    words += (i == 0 ? "" : ", ") + request.varied[i].place + " = " + compact(c.values[i], 6);
  return words;
}

}  // namespace

std::string sweep_csv(const SweepRequest& request, const std::vector<SweepCase>& cases) {
  std::vector<std::string> header{"case"};
  for (const Varied& v : request.varied) header.push_back(csv_cell(v.place));
  const std::string unit = drift_unit(cases);
  for (const std::string& name :
       {std::string("status"), std::string("stopped_at [s]"), "position_drift_max [" + unit + "]",
        "velocity_drift_max [" + unit + "/s]", std::string("angle_drift_max [rad]"),
        std::string("angle_rate_drift_max [rad/s]"), std::string("energy_error_max [J]"),
        std::string("steps"), std::string("evaluations")})
    header.push_back(name);
  for (const std::string& name : request.watched)
    for (const char* which : {" last", " least", " greatest"})
      header.push_back(csv_cell(name + which));
  header.emplace_back("reason");
  std::string text = csv_line(header);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const SweepCase& c = cases[i];
    std::vector<std::string> cells{std::to_string(i)};
    for (const double value : c.values) cells.push_back(round_trip(value));
    cells.insert(cells.end(),
                 {csv_cell(c.status), round_trip(c.stopped_at), round_trip(c.position_drift_max),
                  round_trip(c.velocity_drift_max), round_trip(c.angle_drift_max),
                  round_trip(c.angle_rate_drift_max), round_trip(c.energy_error_max),
                  std::to_string(c.steps), std::to_string(c.evaluations)});
    for (const auto& w : c.watched)
      cells.insert(cells.end(), {round_trip(w.last), round_trip(w.least), round_trip(w.greatest)});
    cells.push_back(csv_cell(c.reason));
    text += csv_line(cells);
  }
  return text;
}

nlohmann::ordered_json sweep_json(const SweepRequest& request, const std::vector<SweepCase>& cases,
                                  const SweepStatistics* statistics) {
  nlohmann::ordered_json json;
  json["scene"] = request.file;
  json["varied"] = nlohmann::ordered_json::array();
  for (const Varied& v : request.varied) {
    auto& entry = json["varied"].emplace_back();
    entry["place"] = v.place;
    if (!v.values().empty()) {
      entry["values"] = v.values();
    } else {
      const bool normal = v.distribution.kind == Distribution::Kind::normal;
      entry["distribution"] = v.distribution.name();
      entry[normal ? "mean" : "from"] = v.distribution.a;
      entry[normal ? "deviation" : "to"] = v.distribution.b;
    }
  }
  json["watched"] = request.watched;
  json["cases"] = cases.size();
  json["status"] = counts(cases);
  for (const SweepMeasure& measure : sweep_measures()) {
    const SweepCase* worst = greatest(cases, measure);
    auto& entry = json["greatest"][measure.name];
    if (!worst) continue;
    entry["value"] = number_or_null(measure.of(*worst));
    entry["case"] = worst - cases.data();
    entry["at"] = worst->values;
  }
  double cpu = 0;
  for (const SweepCase& c : cases) cpu += c.cpu_s;
  json["cpu_s"] = number_or_null(cpu);
  if (statistics) json.update(sample_json(request, *statistics));
  return json;
}

std::string sweep_table(const SweepRequest& request, const std::vector<SweepCase>& cases,
                        const SweepStatistics* statistics) {
  std::string text;
  if (cases.size() <= most_lines) {
    std::vector<std::vector<std::string>> rows(1);
    for (const Varied& v : request.varied) rows[0].push_back(v.place);
    rows[0].emplace_back("status");
    for (const SweepMeasure& measure : sweep_measures())
      if (greatest(cases, measure)) {
        rows[0].push_back(measure.heading);
        if (const auto at = measure.heading.find("[m"); at != std::string::npos)
          rows[0].back().replace(at + 1, 1, drift_unit(cases));
      }
    rows[0].emplace_back("steps");
    for (const std::string& name : request.watched) rows[0].push_back(name + " at the end");
    for (const SweepCase& c : cases) {
      auto& row = rows.emplace_back();
      for (const double value : c.values) row.push_back(compact(value, 6));
      row.push_back(c.status);
      for (const SweepMeasure& measure : sweep_measures())
        if (greatest(cases, measure)) row.push_back(scientific(measure.of(c), 2));
      row.push_back(std::to_string(c.steps));
      for (const auto& w : c.watched) row.push_back(compact(w.last, 6));
    }
    for (const auto& row : rows) {
      for (std::size_t column = 0; column < row.size(); ++column) {
        std::size_t widest = 0;
        for (const auto& other : rows) widest = std::max(widest, width(other[column]));
        text += column + 1 < row.size() ? padded(row[column], widest + 2) : row[column];
      }
      text += "\n";
    }
    text += "\n";
  }
  if (statistics) text += sample_table(request, *statistics);
  const auto off = [](const SweepCase& c) { return c.status == "done" && !c.reason.empty(); };
  if (const auto first = std::find_if(cases.begin(), cases.end(), off); first != cases.end())
    text += std::to_string(std::count_if(cases.begin(), cases.end(), off)) +
            " cases are done and not to be relied on, first " + values_in_words(request, *first) +
            ": " + first->reason + ".\n";
  text += std::to_string(cases.size()) + " cases";
  for (const auto& [status, count] : counts(cases))
    text += ", " + std::to_string(count) + " " + status;
  text += ".\n";
  for (const SweepMeasure& measure : sweep_measures())
    if (const SweepCase* worst = greatest(cases, measure))
      text += "Greatest " + measure.name + ": " + scientific(measure.of(*worst), 2) + " at " +
              values_in_words(request, *worst) + "\n";
  for (const SweepCase& c : cases)
    if (c.status != "done") {
      text += "First that did not finish: " + values_in_words(request, c) + ": " + c.reason + "\n";
      break;
    }
  return text;
}

}  // namespace momenta
