#include <momenta/dae/study/run_record.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <type_traits>

namespace momenta {
namespace {

using Record = nlohmann::json;

// MOMENTA_MEMBERS(Type, all its members): list(each, value) calls each(name, member) for each of
// them. A member that is added and not listed here does not compile.

template <class Each, class... Members>
void each_named(const Each& each, std::string_view names, Members&... members) {
  const auto next = [&] {
    const std::size_t end = std::min(names.find(','), names.size());
    const std::string name(names.substr(0, end));
    names.remove_prefix(std::min(end + 2, names.size()));
    return name;
  };
  (each(next(), members), ...);
}

#define MOMENTA_MEMBERS(Type, ...)                                                      \
  template <class Each>                                                                 \
  void list(const Each& each,                                                           \
            auto&& s) requires std::is_same_v<std::remove_cvref_t<decltype(s)>, Type> { \
    auto& [__VA_ARGS__] = s;                                                            \
    each_named(each, #__VA_ARGS__, __VA_ARGS__);                                        \
  }

MOMENTA_MEMBERS(RunSettings, form, integrator, when_stiff, gauge, rtol, atol, step, end_time,
                samples, project, baumgarte_alpha, baumgarte_beta, beta, penalty, spectral_radius,
                kkt)
MOMENTA_MEMBERS(Growth, exponent, half_range, from, to)
MOMENTA_MEMBERS(Counters, steps, rejected, evaluations, jacobians, factorizations,
                newton_iterations, ode_restarts)
MOMENTA_MEMBERS(Series, t, position_drift, velocity_drift, angle_drift, angle_rate_drift, energy,
                energy_error, impulse, position_error, velocity_error, force_error,
                multiplier_error, multiplier_difference, momentum_error, impulse_error,
                effort_error, reaction_error, work_error)
MOMENTA_MEMBERS(RunResult::ReactionError, joint, error_max, not_unique)
MOMENTA_MEMBERS(Film, start, every, frames)
MOMENTA_MEMBERS(RunResult::DependentRow, loop, row)
MOMENTA_MEMBERS(RunResult::Faded, loop, row, evaluations)
MOMENTA_MEMBERS(RunResult::SingularCrossing, t, pivot, ambiguous)
MOMENTA_MEMBERS(RunResult::Undetermined, column, samples, from, to)
MOMENTA_MEMBERS(PassedLimit, joint, least, largest, since, farthest, farthest_at, slides, stops,
                of_slot, of_force)
MOMENTA_MEMBERS(FoundEvent, name, t, up, row)
MOMENTA_MEMBERS(StopContact, joint, limit, t, what, before, after, impulse)
MOMENTA_MEMBERS(RunResult, scene, settings, status, reason, departure, stopped_at, stiff_from,
                changed_at, counters, partitions, jacobian, linear_solver, cpu_s, wall_s, repeats,
                untimed, drift_unit, drift_rounding, angle_rounding, position_drift_max,
                velocity_drift_max, between_steps_max, position_growth, velocity_growth,
                angle_drift_max, angle_rate_drift_max, angle_between_steps_max, angle_growth,
                angle_rate_growth, energy_error_max, kinetic_energy_max, energy_scale,
                energy_turned_over, last_pose, position_error_max, velocity_error_max,
                force_error_max, multiplier_error_max, multiplier_difference_max,
                momentum_error_max, impulse_error_max, effort_error_max, reaction_error_max,
                work_error_max, reaction_errors, integrated, rank, dependent_rows, residue,
                weak_evaluations, faded_rows, singular_crossings, least_pivot, undetermined,
                passed_limits, events, event_remarks, stops, series, trajectory, film)
MOMENTA_MEMBERS(TimedRun, cpu_s, wall_s, counters, reason)
MOMENTA_MEMBERS(Contestant, form, integrator)
MOMENTA_MEMBERS(StressRun, contestant, rung, verdict, cause, at, position_drift, energy, error,
                velocity_drift, angle_drift, angle_rate_drift, run)
MOMENTA_MEMBERS(SweepCase::Watched, last, least, greatest, label, curve)
MOMENTA_MEMBERS(SweepCase, values, status, reason, stopped_at, drift_unit, position_drift_max,
                velocity_drift_max, angle_drift_max, angle_rate_drift_max, energy_error_max, steps,
                evaluations, times, watched, cpu_s)
MOMENTA_MEMBERS(Checkpoint, t, memory, so_far)

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

/// No study keeps one.
template <class T>
constexpr bool is_trajectory = std::is_same_v<std::remove_cvref_t<T>, Trajectory>;

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
    list(
        [&](const std::string& name, const auto& member) {
          if constexpr (!is_trajectory<decltype(member)>) record[name] = written(member);
        },
        value);
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
    list(
        [&](const std::string& name, auto& member) {
          if constexpr (!is_trajectory<decltype(member)>) read(record.at(name), member);
        },
        value);
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
