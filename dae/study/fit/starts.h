#pragma once
// Finished starts of searches as lines of a journal, which read back bit by bit.

#include <momenta/dae/study/fit/least.h>
#include <momenta/dae/study/journal.h>

#include <optional>
#include <string>
#include <utility>

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

// The starts of a search, one after another, and the best of them.

/// Whether a start so far was possible; `Result`: FitResult, LeastResult or Identification.
template <class Result>
bool has_best(const Result& result) {
  return !result.starts.empty() && result.starts[result.best].to.size() > 0;
}

/// Whether `a` is better than `b`: keeps the conditions where `b` does not; of two that do, has
/// less of `value`; of two that don't, is nearer to them.
template <class Start>
bool is_better(const Start& a, const Start& b, double Start::*value) {
  const bool a_keeps = a.violation <= kept_within, b_keeps = b.violation <= kept_within;
  if (a_keeps != b_keeps) return a_keeps;
  return a_keeps ? a.*value < b.*value : a.violation < b.violation;
}

inline constexpr const char* no_parameters_near = "no parameters near it keep the conditions";
/// Why a search came to no minimum; `refused`: why a step was last taken back, or empty.
std::string why_no_minimum(const SearchRequest& request, int iterations,
                           const std::string& refused);

/// Recalls starts from the journal, makes others by `search(number, from)`, which returns none to
/// stop. The best, by `is_better(a, b)`, is left in result.best.
/// @throws SceneError where no start is possible
template <class Request, class Result, class Search, class Better>
void take_starts(const ParametricMechanism& family, const Request& request, Result& result,
                 const Search& search, const Better& is_better) {
  using Start = typename decltype(result.starts)::value_type;
  DrawnStarts starts(family, request.parameters, request.seed);
  for (int k = 0; k < request.starts && !result.stopped; ++k) {
    const Eigen::VectorXd from = starts.next();
    const std::string key = "start " + std::to_string(k);
    std::optional<Start> start = recalled<Start>(request.journal, key, from);
    if (!start) {
      start = search(k, from);
      if (!start) break;
      if (request.journal && !result.stopped) request.journal->add(key, record_of_start(*start));
    }
    if (start->to.size() > 0 &&
        (!has_best(result) || is_better(*start, result.starts[result.best])))
      result.best = result.starts.size();
    result.starts.push_back(std::move(*start));
  }
  if (!has_best(result))
    throw SceneError(result.starts.empty() ? "the search was stopped before its first start"
                                           : "no start is possible; the first is not, as " +
                                                 result.starts.front().why);
}

}  // namespace momenta
