#pragma once
// A run as JSON that reads back bit by bit, for journals: all of a run except its trajectory.

#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/journal.h>
#include <momenta/dae/study/own_reference.h>
#include <momenta/dae/study/stress_study.h>
#include <momenta/dae/study/sweep_study.h>

#include <optional>
#include <type_traits>

namespace momenta {

/// Key of what a run depends on beside the scene.
std::string key_of(const RunSettings& settings);

/// Records; non-finite numbers are strings, since JSON has none.
nlohmann::json record_of(const RunResult& run);
nlohmann::json record_of(const TimedRun& run);
nlohmann::json record_of(const StressRun& run);
nlohmann::json record_of(const SweepCase& run);
nlohmann::json record_of(const OwnReference& reference);
nlohmann::json record_of(const Checkpoint& checkpoint);

/// Reads a record back; false, with the value unusable, for another kind.
bool read_record(const nlohmann::json& record, RunResult& run);
bool read_record(const nlohmann::json& record, TimedRun& run);
bool read_record(const nlohmann::json& record, StressRun& run);
bool read_record(const nlohmann::json& record, SweepCase& run);
bool read_record(const nlohmann::json& record, OwnReference& reference);
bool read_record(const nlohmann::json& record, Checkpoint& checkpoint);

/// Record in the journal under a key, if any.
template <class T>
std::optional<T> recall(Journal* journal, const std::string& key) {
  const nlohmann::json* record = journal ? journal->find(key) : nullptr;
  std::optional<T> value(std::in_place);
  if (!record || !read_record(*record, *value)) return std::nullopt;
  if constexpr (!std::is_same_v<T, OwnReference> && !std::is_same_v<T, TimedRun>)
    journal->take_run();
  return value;
}

}  // namespace momenta
