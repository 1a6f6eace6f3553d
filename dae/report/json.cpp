#include <momenta/dae/report/json.h>
#include <momenta/dae/report/stiffness_in_words.h>

#include <cmath>

namespace momenta {

using Json = nlohmann::ordered_json;

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

namespace {

Json exponent(const Growth& growth) {
  return growth.is_power() ? number_or_null(growth.exponent) : Json(nullptr);
}

}  // namespace

Json summary_json(const RunResult& run, const Environment& environment) {
  const RunSettings& s = run.settings;
  const Counters& c = run.counters;
  Json json;
  json["scene"] = run.scene;
  json["form"] = s.form;
  json["integrator"] = s.integrator;
  if (s.integrator == "generalised-alpha") json["spectral_radius"] = s.spectral_radius;
  json["gauge"] = s.gauge;
  json["rtol"] = number_or_null(s.rtol);
  json["atol"] = number_or_null(s.atol);
  json["step"] = number_or_null(s.step);
  json["end_time"] = number_or_null(s.end_time);
  json["status"] = run.status;
  json["reason"] = run.reason;
  json["departure"] = run.departure;
  json["stopped_at"] = number_or_null(run.stopped_at);
  json["stiff_from"] = number_or_null(run.stiff_from);
  json["changed_to"] = changed(run) ? Json(s.when_stiff) : Json(nullptr);
  json["changed_at"] = number_or_null(run.changed_at);
  json["stiffness"] = stiffness_in_words(run);
  json["project"] = s.project;
  json["jacobian"] = run.jacobian;
  json["linear_solver"] = run.linear_solver;
  json["kkt"] = s.kkt;
  json["beta"] = number_or_null(s.beta);
  json["penalty"] = number_or_null(s.penalty);
  json["partitions"] = run.partitions;
  json["counters"] = {{"steps", c.steps},
                      {"rejected", c.rejected},
                      {"evaluations", c.evaluations},
                      {"jacobians", c.jacobians},
                      {"factorizations", c.factorizations},
                      {"newton_iterations", c.newton_iterations},
                      {"ode_restarts", c.ode_restarts},
                      {"detours", c.ode_restarts}};  // deprecated
  json["time"] = {{"cpu_s", number_or_null(run.cpu_s)},
                  {"wall_s", number_or_null(run.wall_s)},
                  {"repeats", run.repeats},
                  {"untimed", run.untimed}};
  json["drift"] = {{"position_max", number_or_null(run.position_drift_max)},
                   {"velocity_max", number_or_null(run.velocity_drift_max)},
                   {"between_steps_max", number_or_null(run.between_steps_max)},
                   {"unit", run.drift_unit.empty() ? Json(nullptr) : Json(run.drift_unit)},
                   {"position_exponent", exponent(run.position_growth)},
                   {"velocity_exponent", exponent(run.velocity_growth)},
                   {"angle_max", number_or_null(run.angle_drift_max)},
                   {"angle_rate_max", number_or_null(run.angle_rate_drift_max)},
                   {"angle_between_steps_max", number_or_null(run.angle_between_steps_max)},
                   {"angle_exponent", exponent(run.angle_growth)},
                   {"angle_rate_exponent", exponent(run.angle_rate_growth)}};
  json["energy"] = {{"error_max", number_or_null(run.energy_error_max)},
                    {"turned_over", number_or_null(run.energy_turned_over)}};
  json["error"] = {{"position_max", number_or_null(run.position_error_max)},
                   {"velocity_max", number_or_null(run.velocity_error_max)},
                   {"force_max", number_or_null(run.force_error_max)},
                   {"multiplier_max", number_or_null(run.multiplier_error_max)},
                   {"momentum_max", number_or_null(run.momentum_error_max)},
                   {"impulse_max", number_or_null(run.impulse_error_max)},
                   {"effort_max", number_or_null(run.effort_error_max)},
                   {"reaction_max", number_or_null(run.reaction_error_max)},
                   {"work_max", number_or_null(run.work_error_max)}};
  json["reaction_errors"] = Json::array();
  for (const auto& joint : run.reaction_errors)
    json["reaction_errors"].push_back({{"joint", joint.joint},
                                       {"error_max", number_or_null(joint.error_max)},
                                       {"not_unique", joint.not_unique}});
  json["multiplier_difference_max"] = number_or_null(run.multiplier_difference_max);
  json["integrated"] = run.integrated;
  json["rank"] = run.drift_unit.empty() ? Json(nullptr) : Json(run.rank);
  json["dependent_rows"] = Json::array();
  for (const auto& row : run.dependent_rows)
    json["dependent_rows"].push_back({{"loop", row.loop}, {"row", row.row}});
  json["residue"] = run.residue;
  json["weak_evaluations"] = run.weak_evaluations;
  json["faded_rows"] = Json::array();
  for (const auto& row : run.faded_rows)
    json["faded_rows"].push_back(
        {{"loop", row.loop}, {"row", row.row}, {"evaluations", row.evaluations}});
  json["least_pivot"] = number_or_null(run.least_pivot);
  json["singular_crossings"] = Json::array();
  for (const auto& crossing : run.singular_crossings)
    json["singular_crossings"].push_back(
        {{"t", crossing.t}, {"pivot", crossing.pivot}, {"ambiguous", crossing.ambiguous}});
  json["passages"] = json["singular_crossings"];  // deprecated
  // Null where no trajectory was kept, and nobody looked.
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

}  // namespace momenta
