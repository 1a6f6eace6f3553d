#include <momenta/dae/study/run_record.h>

#include <cmath>
#include <type_traits>

namespace momenta {
namespace {

using Record = nlohmann::json;

// Every structure lists its members once, for both ways. The bindings name all of them: one that is
// added and not listed here does not compile.

template <class Each>
void list(const Each& each,
          auto&& s) requires std::is_same_v<std::remove_cvref_t<decltype(s)>, RunSettings> {
  auto& [form, integrator, when_stiff, gauge, rtol, atol, step, end_time, samples, project,
         baumgarte_alpha, baumgarte_beta, beta, penalty, spectral_radius, kkt] = s;
  each("form", form), each("integrator", integrator), each("when_stiff", when_stiff);
  each("gauge", gauge);
  each("rtol", rtol), each("atol", atol), each("step", step), each("end_time", end_time);
  each("samples", samples), each("project", project);
  each("baumgarte_alpha", baumgarte_alpha), each("baumgarte_beta", baumgarte_beta);
  each("beta", beta), each("penalty", penalty), each("spectral_radius", spectral_radius);
  each("kkt", kkt);
}

template <class Each>
void list(const Each& each,
          auto&& s) requires std::is_same_v<std::remove_cvref_t<decltype(s)>, Growth> {
  auto& [exponent, half_range, from, to] = s;
  each("exponent", exponent), each("half_range", half_range), each("from", from), each("to", to);
}

template <class Each>
void list(const Each& each,
          auto&& s) requires std::is_same_v<std::remove_cvref_t<decltype(s)>, Counters> {
  auto& [steps, rejected, evaluations, jacobians, factorizations, newton_iterations, ode_restarts] =
      s;
  each("steps", steps), each("rejected", rejected), each("evaluations", evaluations);
  each("jacobians", jacobians), each("factorizations", factorizations);
  each("newton_iterations", newton_iterations), each("ode_restarts", ode_restarts);
}

template <class Each>
void list(const Each& each,
          auto&& s) requires std::is_same_v<std::remove_cvref_t<decltype(s)>, Series> {
  auto& [t, position_drift, velocity_drift, angle_drift, angle_rate_drift, energy, energy_error,
         impulse, position_error, velocity_error, force_error, multiplier_error,
         multiplier_difference, momentum_error, impulse_error, effort_error, reaction_error,
         work_error] = s;
  each("t", t), each("position_drift", position_drift), each("velocity_drift", velocity_drift);
  each("angle_drift", angle_drift), each("angle_rate_drift", angle_rate_drift);
  each("energy", energy), each("energy_error", energy_error), each("impulse", impulse);
  each("position_error", position_error), each("velocity_error", velocity_error);
  each("force_error", force_error), each("multiplier_error", multiplier_error);
  each("multiplier_difference", multiplier_difference);
  each("momentum_error", momentum_error), each("impulse_error", impulse_error);
  each("effort_error", effort_error), each("reaction_error", reaction_error);
  each("work_error", work_error);
}

template <class Each>
void list(const Each& each, auto&& s) requires
    std::is_same_v<std::remove_cvref_t<decltype(s)>, RunResult::ReactionError> {
  auto& [joint, error_max, not_unique] = s;
  each("joint", joint), each("error_max", error_max), each("not_unique", not_unique);
}

template <class Each>
void list(const Each& each,
          auto&& s) requires std::is_same_v<std::remove_cvref_t<decltype(s)>, Film> {
  auto& [start, every, frames] = s;
  each("start", start), each("every", every), each("frames", frames);
}

template <class Each>
void list(const Each& each, auto&& s) requires
    std::is_same_v<std::remove_cvref_t<decltype(s)>, RunResult::DependentRow> {
  auto& [loop, row] = s;
  each("loop", loop), each("row", row);
}

template <class Each>
void list(const Each& each,
          auto&& s) requires std::is_same_v<std::remove_cvref_t<decltype(s)>, RunResult::Faded> {
  auto& [loop, row, evaluations] = s;
  each("loop", loop), each("row", row), each("evaluations", evaluations);
}

template <class Each>
void list(const Each& each, auto&& s) requires
    std::is_same_v<std::remove_cvref_t<decltype(s)>, RunResult::SingularCrossing> {
  auto& [t, pivot, ambiguous] = s;
  each("t", t), each("pivot", pivot), each("ambiguous", ambiguous);
}

template <class Each>
void list(const Each& each, auto&& s) requires
    std::is_same_v<std::remove_cvref_t<decltype(s)>, RunResult::Undetermined> {
  auto& [column, samples, from, to] = s;
  each("column", column), each("samples", samples), each("from", from), each("to", to);
}

template <class Each>
void list(const Each& each,
          auto&& s) requires std::is_same_v<std::remove_cvref_t<decltype(s)>, PassedLimit> {
  auto& [joint, least, largest, since, farthest, farthest_at, slides, stops, of_slot, of_force] = s;
  each("joint", joint), each("least", least), each("largest", largest), each("since", since);
  each("farthest", farthest), each("farthest_at", farthest_at);
  each("slides", slides), each("stops", stops), each("of_slot", of_slot);
  each("of_force", of_force);
}

template <class Each>
void list(const Each& each,
          auto&& s) requires std::is_same_v<std::remove_cvref_t<decltype(s)>, FoundEvent> {
  auto& [name, t, up, row] = s;
  each("name", name), each("t", t), each("up", up), each("row", row);
}

template <class Each>
void list(const Each& each,
          auto&& s) requires std::is_same_v<std::remove_cvref_t<decltype(s)>, StopContact> {
  auto& [joint, limit, t, what, before, after, impulse] = s;
  each("joint", joint), each("limit", limit), each("t", t), each("what", what);
  each("before", before), each("after", after), each("impulse", impulse);
}

template <class Each>
void list(const Each& each,
          auto&& s) requires std::is_same_v<std::remove_cvref_t<decltype(s)>, RunResult> {
  auto& [scene, settings, status, reason, departure, stopped_at, stiff_from, changed_at, counters,
         partitions, jacobian, linear_solver, cpu_s, wall_s, repeats, untimed, drift_unit,
         drift_rounding, angle_rounding, position_drift_max, velocity_drift_max, between_steps_max,
         position_growth, velocity_growth, angle_drift_max, angle_rate_drift_max,
         angle_between_steps_max, angle_growth, angle_rate_growth, energy_error_max,
         kinetic_energy_max, energy_scale, energy_turned_over, last_pose, position_error_max,
         velocity_error_max, force_error_max, multiplier_error_max, multiplier_difference_max,
         momentum_error_max, impulse_error_max, effort_error_max, reaction_error_max,
         work_error_max, reaction_errors, integrated, rank, dependent_rows, residue,
         weak_evaluations, faded_rows, singular_crossings, least_pivot, undetermined, passed_limits,
         events, event_remarks, stops, series, trajectory, film] = s;
  each("scene", scene), each("settings", settings), each("status", status), each("reason", reason);
  each("departure", departure);
  each("stopped_at", stopped_at), each("stiff_from", stiff_from), each("changed_at", changed_at),
      each("counters", counters), each("partitions", partitions);
  each("jacobian", jacobian), each("linear_solver", linear_solver);
  each("cpu_s", cpu_s), each("wall_s", wall_s), each("repeats", repeats);
  each("untimed", untimed);
  each("drift_unit", drift_unit);
  each("drift_rounding", drift_rounding), each("angle_rounding", angle_rounding);
  each("position_drift_max", position_drift_max), each("velocity_drift_max", velocity_drift_max);
  each("between_steps_max", between_steps_max);
  each("angle_drift_max", angle_drift_max), each("angle_rate_drift_max", angle_rate_drift_max);
  each("angle_between_steps_max", angle_between_steps_max);
  each("angle_growth", angle_growth), each("angle_rate_growth", angle_rate_growth);
  each("position_growth", position_growth), each("velocity_growth", velocity_growth);
  each("energy_error_max", energy_error_max), each("kinetic_energy_max", kinetic_energy_max);
  each("energy_scale", energy_scale), each("energy_turned_over", energy_turned_over);
  each("last_pose", last_pose);
  each("position_error_max", position_error_max), each("velocity_error_max", velocity_error_max);
  each("force_error_max", force_error_max), each("multiplier_error_max", multiplier_error_max);
  each("multiplier_difference_max", multiplier_difference_max);
  each("momentum_error_max", momentum_error_max), each("impulse_error_max", impulse_error_max);
  each("effort_error_max", effort_error_max), each("reaction_error_max", reaction_error_max);
  each("work_error_max", work_error_max), each("reaction_errors", reaction_errors);
  each("integrated", integrated), each("rank", rank), each("dependent_rows", dependent_rows),
      each("residue", residue);
  each("weak_evaluations", weak_evaluations);
  each("faded_rows", faded_rows), each("singular_crossings", singular_crossings),
      each("least_pivot", least_pivot);
  each("undetermined", undetermined), each("passed_limits", passed_limits);
  each("events", events), each("event_remarks", event_remarks);
  each("stops", stops);
  each("series", series), each("film", film);
  static_cast<void>(trajectory);  // no study keeps one
}

template <class Each>
void list(const Each& each,
          auto&& s) requires std::is_same_v<std::remove_cvref_t<decltype(s)>, TimedRun> {
  auto& [cpu_s, wall_s, counters, reason] = s;
  each("cpu_s", cpu_s), each("wall_s", wall_s), each("counters", counters), each("reason", reason);
}

template <class Each>
void list(const Each& each,
          auto&& s) requires std::is_same_v<std::remove_cvref_t<decltype(s)>, Contestant> {
  auto& [form, integrator] = s;
  each("form", form), each("integrator", integrator);
}

template <class Each>
void list(const Each& each,
          auto&& s) requires std::is_same_v<std::remove_cvref_t<decltype(s)>, StressRun> {
  auto& [contestant, rung, verdict, cause, at, position_drift, energy, error, velocity_drift,
         angle_drift, angle_rate_drift, run] = s;
  each("contestant", contestant), each("rung", rung), each("verdict", verdict);
  each("cause", cause), each("at", at), each("position_drift", position_drift),
      each("energy", energy);
  each("error", error), each("velocity_drift", velocity_drift);
  each("angle_drift", angle_drift), each("angle_rate_drift", angle_rate_drift), each("run", run);
}

template <class Each>
void list(const Each& each,
          auto&& s) requires std::is_same_v<std::remove_cvref_t<decltype(s)>, SweepCase::Watched> {
  auto& [last, least, greatest, label, curve] = s;
  each("last", last), each("least", least), each("greatest", greatest);
  each("label", label), each("curve", curve);
}

template <class Each>
void list(const Each& each,
          auto&& s) requires std::is_same_v<std::remove_cvref_t<decltype(s)>, SweepCase> {
  auto& [values, status, reason, stopped_at, drift_unit, position_drift_max, velocity_drift_max,
         angle_drift_max, angle_rate_drift_max, energy_error_max, steps, evaluations, times,
         watched, cpu_s] = s;
  each("values", values), each("status", status), each("reason", reason);
  each("stopped_at", stopped_at), each("drift_unit", drift_unit);
  each("position_drift_max", position_drift_max), each("velocity_drift_max", velocity_drift_max);
  each("angle_drift_max", angle_drift_max), each("angle_rate_drift_max", angle_rate_drift_max);
  each("energy_error_max", energy_error_max);
  each("steps", steps), each("evaluations", evaluations), each("times", times);
  each("watched", watched), each("cpu_s", cpu_s);
}

template <class Each>
void list(const Each& each,
          auto&& s) requires std::is_same_v<std::remove_cvref_t<decltype(s)>, Checkpoint> {
  auto& [t, memory, so_far] = s;
  each("t", t), each("memory", memory), each("so_far", so_far);
}

template <class T>
Record written(const T& value);
template <class T>
void read(const Record& record, T& value);

// Numbers to their last digit, as the library prints them; others by name.
template <>
Record written(const double& value) {
  return std::isfinite(value) ? Record(value)
         : std::isnan(value)  ? Record("nan")
                              : Record(value > 0 ? "inf" : "-inf");
}
template <>
void read(const Record& record, double& value) {
  if (!record.is_string()) {
    value = record.get<double>();
    return;
  }
  const auto& name = record.get_ref<const std::string&>();
  value = name == "inf"    ? std::numeric_limits<double>::infinity()
          : name == "-inf" ? -std::numeric_limits<double>::infinity()
                           : not_measured;
}

template <class T>
struct IsList : std::false_type {};
template <class T>
struct IsList<std::vector<T>> : std::true_type {};

template <class T>
Record written(const T& value) {
  if constexpr (IsList<T>::value) {
    Record record = Record::array();
    for (const auto& x : value) record.push_back(written(x));
    return record;
  } else if constexpr (std::is_enum_v<T>) {
    return static_cast<int>(value);
  } else if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) {
    return value;
  } else {
    Record record = Record::object();
    list([&](const char* name, const auto& member) { record[name] = written(member); }, value);
    return record;
  }
}

template <class T>
void read(const Record& record, T& value) {
  if constexpr (IsList<T>::value) {
    value.clear();
    for (const Record& x : record) read(x, value.emplace_back());
  } else if constexpr (std::is_enum_v<T>) {
    value = static_cast<T>(record.get<int>());
  } else if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) {
    value = record.get<T>();
  } else {
    list([&](const char* name, auto& member) { read(record.at(name), member); }, value);
  }
}

template <class T>
bool read_whole(const Record& record, T& value) {
  try {
    read(record, value);
  } catch (const Record::exception&) {
    return false;
  }
  return true;
}

}  // namespace

std::string key_of(const RunSettings& settings) {
  return written(settings).dump();
}

Record record_of(const RunResult& run) {
  return written(run);
}
Record record_of(const TimedRun& run) {
  return written(run);
}
Record record_of(const StressRun& run) {
  return written(run);
}
Record record_of(const SweepCase& run) {
  return written(run);
}
Record record_of(const Checkpoint& checkpoint) {
  return written(checkpoint);
}
Record record_of(const OwnReference& own) {
  return {{"accuracy", written(own.accuracy)},       {"implicit", own.implicit},
          {"source", own.reference.file()},          {"columns", own.reference.columns()},
          {"times", written(own.reference.times())}, {"values", written(own.reference.values())}};
}

bool read_record(const Record& record, RunResult& run) {
  return read_whole(record, run);
}
bool read_record(const Record& record, TimedRun& run) {
  return read_whole(record, run);
}
bool read_record(const Record& record, StressRun& run) {
  return read_whole(record, run);
}
bool read_record(const Record& record, SweepCase& run) {
  return read_whole(record, run);
}
bool read_record(const Record& record, Checkpoint& checkpoint) {
  return read_whole(record, checkpoint);
}
bool read_record(const Record& record, OwnReference& own) {
  std::vector<std::string> columns;
  std::vector<double> times;
  std::vector<std::vector<double>> values;
  try {
    read(record.at("accuracy"), own.accuracy);
    own.implicit = record.at("implicit").get<bool>();
    read(record.at("columns"), columns);
    read(record.at("times"), times);
    read(record.at("values"), values);
    if (values.size() != times.size()) return false;
    for (const auto& row : values)
      if (row.size() != columns.size()) return false;
    own.reference =
        Reference(record.at("source"), std::move(columns), std::move(times), std::move(values));
  } catch (const Record::exception&) {
    return false;
  }
  return true;
}

}  // namespace momenta
