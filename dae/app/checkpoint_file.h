#pragma once
// A run that can continue after a kill. DIR/checkpoint.json has a checkpoint and the trajectory's
// length up to it; it is replaced as a whole from time to time.

#include <momenta/dae/output/trajectory_file.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/journal.h>

#include <chrono>
#include <optional>

#include "options.h"

namespace momenta::program {

class CheckpointFile {
 public:
  /// Looks in --out for a run of the same command; rows have `columns` columns.
  /// @throws std::invalid_argument where another command was killed there
  CheckpointFile(const Options& o, std::size_t columns);

  /// Where to continue; null: at the start.
  const Checkpoint* from() const { return from_ ? &*from_ : nullptr; }
  /// Beginning of the trajectory, if continued; else empty.
  const std::string& trajectory() const { return trajectory_; }
  /// Takes the directory: reports whether the run continues, and removes useless files.
  void begin();
  /// Replaces the checkpoint now and then; between two steps, after a row.
  void note(TrajectoryFile& trajectory, const std::vector<double>& row,
            const std::function<Checkpoint()>& make);
  /// Removes the checkpoint of a run whose results are written.
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
