#pragma once
// A trajectory, written while the run goes on: no more than a piece of it is held in memory.
//
// As text, trajectory.csv: see csv.h. As HDF5:
//
//   /trajectory/NAME   one dataset a column of trajectory.csv, doubles bit for bit, NaN where the
//                      CSV has an empty cell; attribute `unit`. Attribute `columns` of the group:
//                      their labels in order, one a line
//   attributes of /    texts: scene, settings, environment; once it is over, summary
//
// Either is written as FILE.part, whole lines or chunks at a time, and gets its name once the run
// is over. What a kill leaves is a FILE.part with the samples until shortly before: a run that goes
// on begins with it, any other replaces it.

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace momenta {

class TrajectoryFile {
 public:
  TrajectoryFile() = default;
  /// Not finished: removes FILE.part.
  virtual ~TrajectoryFile() = default;
  TrajectoryFile(const TrajectoryFile&) = delete;
  TrajectoryFile& operator=(const TrajectoryFile&) = delete;

  /// A row (columns); false when something is amiss, then problem() has the sentence.
  virtual bool write(const std::vector<double>& row) = 0;
  /// Writes what is held; as write().
  virtual bool flush() = 0;
  /// Writes `summary` where the format holds one, and gives the file its name. @pre flush()
  /// After a problem: with the samples that are in it whole. False where not even that is possible.
  virtual bool finish(const std::string& summary) = 0;
  const std::string& problem() const { return problem_; }
  /// Whether a run can go on from FILE.part.
  virtual bool can_go_on() const { return false; }
  /// Bytes in FILE.part. @pre flush(), can_go_on()
  virtual std::size_t size() const { return 0; }

 protected:
  std::string problem_;
};

/// Columns are labels, "O.q [rad]". `before`: how the file begins, of a run that goes on.
std::unique_ptr<TrajectoryFile> csv_trajectory(std::filesystem::path file,
                                               const std::vector<std::string>& columns,
                                               std::string_view before = {});

/// Whether this build can write HDF5.
bool writes_hdf5();
/// No two columns the same. @pre writes_hdf5()
std::unique_ptr<TrajectoryFile> hdf5_trajectory(
    std::filesystem::path file, const std::vector<std::string>& columns,
    const std::vector<std::pair<std::string, std::string>>& texts);

}  // namespace momenta
