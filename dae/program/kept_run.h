#pragma once
// A run that can continue after it was killed. While it runs, DIR/checkpoint.json has a checkpoint
// and the length of the trajectory up to it; the file is replaced as a whole from time to time.

#include <momenta/dae/report/trajectory_file.h>
#include <momenta/dae/study/journal.h>
#include <momenta/dae/study/run_form.h>

#include <chrono>
#include <optional>

#include "options.h"

namespace momenta::program {

class KeptRun {
 public:
  /// Looks for what a run of the same command has left in --out; rows have so many columns.
  /// @throws std::invalid_argument where another command was killed there
  KeptRun(const Options& o, std::size_t columns);

  /// Where the run goes on; null: at its start.
  const Checkpoint* from() const { return from_ ? &*from_ : nullptr; }
  /// How the trajectory begins then; else empty.
  const std::string& trajectory() const { return trajectory_; }
  /// The directory is this process's own: tells that the run goes on, or why it begins anew, and
  /// removes what is of no use.
  void begin();
  /// Between two steps, after a row: replaces the checkpoint where it is time to.
  void note(TrajectoryFile& trajectory, const std::vector<double>& row,
            const std::function<Checkpoint()>& make);
  /// The run is over and its results are written.
  void remove() const;

 private:
  using Clock = std::chrono::steady_clock;
  void read(const std::string& text, std::size_t columns);

  const Options& o_;
  std::filesystem::path file_, part_;
  Journal::Study study_;
  std::optional<Checkpoint> from_;
  std::string trajectory_, anew_;
  Clock::time_point next_;
  bool failed_ = false;
};

}  // namespace momenta::program
