#pragma once
// Finished starts of searches as lines of a journal, which read back bit by bit.

#include <momenta/dae/fit/least.h>
#include <momenta/dae/study/journal.h>

#include <optional>
#include <string>

namespace momenta {

nlohmann::json record_of_start(const FitStart& start);
nlohmann::json record_of_start(const LeastStart& start);
/// False, with the start unusable, for an invalid record.
bool read_start(const nlohmann::json& record, FitStart& start);
bool read_start(const nlohmann::json& record, LeastStart& start);

/// The start from `from` in the journal, if any.
template <class Start>
std::optional<Start> recalled(Journal* journal, const std::string& key,
                              const Eigen::VectorXd& from) {
  const nlohmann::json* record = journal ? journal->find(key) : nullptr;
  Start start;
  if (!record || !read_start(*record, start) || start.from != from) return std::nullopt;
  journal->take_run();
  return start;
}

}  // namespace momenta
