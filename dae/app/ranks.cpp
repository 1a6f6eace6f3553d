#include "ranks.h"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>

#ifdef MOMENTA_MPI
#include <mpi.h>
#endif

namespace momenta::program {
namespace {

/// Numbers not yet handed out.
class Queue {
 public:
  Queue(const std::vector<std::size_t>& wanted, const std::function<bool()>& going_on)
      : wanted_(wanted), going_on_(going_on) {}
  std::optional<std::size_t> next() {
    if (!going_on_()) return std::nullopt;
    const std::size_t i = next_++;
    if (i >= wanted_.size()) return std::nullopt;
    return wanted_[i];
  }
  void end() { next_ = wanted_.size(); }
  /// Ends the study with an exception of a thread.
  void fail(std::exception_ptr thrown) {
    end();
    const std::lock_guard lock(turn_);
    if (!thrown_) thrown_ = std::move(thrown);
  }
  void rethrow() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  const std::vector<std::size_t>& wanted_;
  const std::function<bool()>& going_on_;
  std::atomic<std::size_t> next_{0};
  std::mutex turn_;
  std::exception_ptr thrown_;
};

}  // namespace

#ifdef MOMENTA_MPI

namespace {

// Message of a rank that asks: first empty, then "NUMBER RECORD", or "! sentence" for an exception.
// Answer: a number, or none_left.
constexpr int tag = 1;
constexpr long long none_left = -1;

bool launched() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"})
    if (std::getenv(name)) return true;
  return false;
}

std::optional<std::size_t> asked(const std::string& message) {
  MPI_Send(message.data(), static_cast<int>(message.size()), MPI_CHAR, 0, tag, MPI_COMM_WORLD);
  long long number = none_left;
  MPI_Recv(&number, 1, MPI_LONG_LONG, 0, tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  if (number == none_left) return std::nullopt;
  return static_cast<std::size_t>(number);
}

/// A waiting message, if any, and its rank.
std::optional<std::pair<int, std::string>> received() {
  int there = 0, size = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &there, &status);
  if (!there) return std::nullopt;
  MPI_Get_count(&status, MPI_CHAR, &size);
  std::string text(static_cast<std::size_t>(size), '\0');
  MPI_Recv(text.data(), size, MPI_CHAR, status.MPI_SOURCE, tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return std::pair(status.MPI_SOURCE, std::move(text));
}

/// Answers other ranks until all know that no number is left. Polls: waiting inside MPI would keep
/// a processor busy.
void hand_out(Queue& queue, int others,
              const std::function<void(std::size_t, const std::string&)>& keep) {
  while (others > 0) {
    const auto message = received();
    if (!message) {
      std::this_thread::sleep_for(std::chrono::microseconds(200));
      continue;
    }
    const auto& [rank, text] = *message;
    if (text.starts_with("! ")) {
      queue.fail(std::make_exception_ptr(std::invalid_argument(text.substr(2))));
    } else if (!text.empty()) {
      const std::size_t space = text.find(' ');
      keep(std::stoull(text.substr(0, space)), text.substr(space + 1));
    }
    const auto next = queue.next();
    const long long answer = next ? static_cast<long long>(*next) : none_left;
    MPI_Send(&answer, 1, MPI_LONG_LONG, rank, tag, MPI_COMM_WORLD);
    if (!next) --others;
  }
}

}  // namespace

Ranks::Ranks() {
  if (!launched()) return;
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &count_);
  if (rank_ == 0) return;
  // Only rank 0 prints: every rank meets the same mistakes.
  if (!std::freopen("/dev/null", "w", stdout) || !std::freopen("/dev/null", "w", stderr))
    throw std::runtime_error("/dev/null cannot be written");
}
bool Ranks::agreed(bool ready) {
  int said = ready;
  if (count_ > 1) MPI_Bcast(&said, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return said != 0;
}
Ranks::~Ranks() {
  int initialised = 0;
  MPI_Initialized(&initialised);
  if (initialised) MPI_Finalize();
}

#else

namespace {
std::optional<std::size_t> asked(const std::string&) {
  return std::nullopt;
}
void hand_out(Queue&, int, const std::function<void(std::size_t, const std::string&)>&) {}
}  // namespace

Ranks::Ranks() = default;
bool Ranks::agreed(bool ready) {
  return ready;
}
Ranks::~Ranks() = default;

#endif

void Ranks::share(const std::vector<std::size_t>& wanted, int threads,
                  const std::function<std::string(std::size_t)>& make,
                  const std::function<void(std::size_t, const std::string&)>& keep,
                  const std::function<bool()>& going_on) {
  if (rank_ > 0) {
    std::string message;
    while (const auto number = asked(message)) try {
        message = std::to_string(*number) + " " + make(*number);
      } catch (const std::invalid_argument& e) {
        message = std::string("! ") + e.what();
      }
    return;
  }
  Queue queue(wanted, going_on);
  const auto work = [&] {
    try {
      while (const auto number = queue.next()) keep(*number, make(*number));
    } catch (...) {
      queue.fail(std::current_exception());
    }
  };
  {
    std::vector<std::jthread> workers;
    for (int k = 0; k < threads; ++k) workers.emplace_back(work);
    hand_out(queue, count_ - 1, keep);
  }
  queue.rethrow();
}

}  // namespace momenta::program
