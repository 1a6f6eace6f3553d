#pragma once
// A trajectory, written during the run in pieces.
//
// As text, trajectory.csv: see csv.h. As HDF5:
//
//   /trajectory/NAME   one dataset a column of trajectory.csv, doubles bit for bit, NaN for an
//   empty
//                      cell of the CSV; attribute `unit`. Attribute `columns` of the group:
//                      their labels in order, one a line
//   attributes of /    texts: scene, settings, environment; at the end, summary
//
// Either is FILE.part, whole lines or chunks at a time, and gets its name at the end of the run. A
// kill leaves FILE.part with the samples until shortly before: a continued run begins with it, any
// other replaces it.

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
  /// Removes FILE.part unless finished.
  virtual ~TrajectoryFile() = default;
  TrajectoryFile(const TrajectoryFile&) = delete;
  TrajectoryFile& operator=(const TrajectoryFile&) = delete;

  /// A row (columns); false on failure: problem().
  virtual bool write(const std::vector<double>& row) = 0;
  /// Writes rows so far; as write().
  virtual bool flush() = 0;
  /// Writes `summary` where the format has one, and gives the file its name. @pre flush()
  /// After a failure: with all whole samples. False where even that is impossible.
  virtual bool finish(const std::string& summary) = 0;
  const std::string& problem() const { return problem_; }
  /// Whether a run can continue from FILE.part.
  virtual bool can_go_on() const { return false; }
  /// Bytes in FILE.part. @pre flush(), can_go_on()
  virtual std::size_t size() const { return 0; }

 protected:
  std::string problem_;
};

/// Columns are labels, "O.q [rad]". `before`: start of the file, for a continued run.
std::unique_ptr<TrajectoryFile> csv_trajectory(std::filesystem::path file,
                                               const std::vector<std::string>& columns,
                                               std::string_view before = {});

/// Whether this build can write HDF5.
bool writes_hdf5();
/// @pre no two columns are the same; writes_hdf5()
std::unique_ptr<TrajectoryFile> hdf5_trajectory(
    std::filesystem::path file, const std::vector<std::string>& columns,
    const std::vector<std::pair<std::string, std::string>>& texts);

}  // namespace momenta
