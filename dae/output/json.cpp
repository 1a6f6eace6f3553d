#include <momenta/dae/output/advice.h>
#include <momenta/dae/output/json.h>
#include <momenta/dae/run/run_quantities.h>

#include <cmath>
#include <type_traits>

namespace momenta {

Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json environment_json(const Environment& environment) {
  Json versions = Json::object();
  for (const auto& [name, version] : environment.versions) versions[name] = version;
  return {{"cpu", environment.cpu},
          {"level", environment.level},
          {"compiler", environment.compiler},
          {"flags", environment.flags},
          {"build_type", environment.build_type},
          {"date", environment.date},
          {"versions", versions}};
}

Json summary_json(const RunResult& run, const Environment& environment) {
  Json json;
  const auto member = [](const auto& x) -> Json {
    if constexpr (std::is_same_v<std::decay_t<decltype(x)>, double>)
      return number_or_null(x);
    else
      return x;
  };
  for (const RunQuantity& quantity : run_quantities())
    if (quantity.pointer)
      json[Json::json_pointer(quantity.pointer)] = std::visit(member, quantity.value(run));
  if (run.settings.integrator == "generalised-alpha")
    json["spectral_radius"] = run.settings.spectral_radius;
  json["changed_to"] = changed(run) ? Json(run.settings.when_stiff) : Json(nullptr);
  json["stiffness"] = stiffness_in_words(run);
  json["counters"]["detours"] = run.counters.ode_restarts;  // deprecated
  json["drift"]["unit"] = run.drift_unit.empty() ? Json(nullptr) : Json(run.drift_unit);
  json["reaction_errors"] = Json::array();
  for (const auto& joint : run.reaction_errors)
    json["reaction_errors"].push_back({{"joint", joint.joint},
                                       {"error_max", number_or_null(joint.error_max)},
                                       {"not_unique", joint.not_unique}});
  json["rank"] = run.drift_unit.empty() ? Json(nullptr) : Json(run.rank);
  json["dependent_rows"] = Json::array();
  for (const auto& row : run.dependent_rows)
    json["dependent_rows"].push_back({{"loop", row.loop}, {"row", row.row}});
  json["faded_rows"] = Json::array();
  for (const auto& row : run.faded_rows)
    json["faded_rows"].push_back(
        {{"loop", row.loop}, {"row", row.row}, {"evaluations", row.evaluations}});
  json["singular_crossings"] = Json::array();
  for (const auto& crossing : run.singular_crossings)
    json["singular_crossings"].push_back(
        {{"t", crossing.t}, {"pivot", crossing.pivot}, {"ambiguous", crossing.ambiguous}});
  json["passages"] = json["singular_crossings"];  // deprecated
  // null where no trajectory was kept: not searched
  json["undetermined"] = run.trajectory.columns.empty() ? Json() : Json::array();
  for (const auto& u : run.undetermined)
    json["undetermined"].push_back(
        {{"column", u.column}, {"samples", u.samples}, {"from", u.from}, {"to", u.to}});
  json["passed_limits"] = Json::array();
  for (const PassedLimit& p : run.passed_limits)
    json["passed_limits"].push_back({{"joint", p.joint},
                                     {"limits", {p.least, p.largest}},
                                     {"since", p.since},
                                     {"farthest", p.farthest},
                                     {"farthest_at", p.farthest_at}});
  json["events"] = Json::array();
  for (const FoundEvent& e : run.events)
    json["events"].push_back({{"name", e.name}, {"t", e.t}, {"direction", e.up ? "up" : "down"}});
  json["event_remarks"] = run.event_remarks;
  json["stops"] = Json::array();
  for (const StopContact& contact : run.stops)
    json["stops"].push_back({{"joint", contact.joint},
                             {"limit", contact.limit},
                             {"t", contact.t},
                             {"what", contact.what},
                             {"before", contact.before},
                             {"after", contact.after},
                             {"impulse", contact.impulse}});
  json["environment"] = environment_json(environment);
  return json;
}

Json study_json(const StudyResult& study) {
  Json runs = Json::array();
  for (const RunResult& run : study.runs) runs.push_back(summary_json(run, study.environment));
  return runs;
}

namespace {

std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump();
}

}  // namespace

JsonWriter::JsonWriter() : out_("{") {}

void JsonWriter::line() {
  out_ += '\n';
  out_.append(2 * depth_, ' ');
}

void JsonWriter::start(const std::string& key) {
  if (!first_) out_ += ',';
  first_ = false;
  line();
  out_ += quoted(key) + ": ";
}

void JsonWriter::open(const std::string& key) {
  start(key);
  out_ += '{';
  ++depth_;
  first_ = true;
}

void JsonWriter::close() {
  --depth_;
  if (!first_) line();
  out_ += '}';
  first_ = false;
}

void JsonWriter::text(const std::string& key, const std::string& value) {
  start(key);
  out_ += quoted(value);
}

void JsonWriter::texts(const std::string& key, const std::vector<std::string>& values) {
  start(key);
  out_ += '[';
  for (std::size_t i = 0; i < values.size(); ++i) out_ += (i > 0 ? ", " : "") + quoted(values[i]);
  out_ += ']';
}

void JsonWriter::whole_number(const std::string& key, int value) {
  start(key);
  out_ += std::to_string(value);
}

void JsonWriter::number(const std::string& key, double value) {
  start(key);
  put(value);
}

void JsonWriter::put(double value) {
  out_ += number_or_null(value).dump();
}

std::string JsonWriter::take() {
  close();
  return std::move(out_) + "\n";
}

}  // namespace momenta
