#pragma once
// A trajectory as HDF5, written while the run goes on: no more than a chunk of it is held in
// memory.
//
//   /trajectory/NAME   one dataset a column of trajectory.csv, doubles bit for bit, NaN where the
//                      CSV has an empty cell; attribute `unit`. Attribute `columns` of the group:
//                      their labels in order, one a line
//   attributes of /    texts: scene, settings, environment; once it is over, summary
//
// It is written as FILE.part, whole chunks at a time, and gets its name when it is whole. What a
// kill leaves is a FILE.part that holds the chunks until then; the next run replaces it.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// Whether this build can write such files.
bool writes_hdf5();

class TrajectoryFile {
 public:
  using Texts = std::vector<std::pair<std::string, std::string>>;
  /// Columns are labels, "O.q [rad]"; no two the same. @pre writes_hdf5()
  TrajectoryFile(std::filesystem::path file, const std::vector<std::string>& columns,
                 const Texts& texts);
  /// Not finished: removes FILE.part.
  ~TrajectoryFile();
  TrajectoryFile(const TrajectoryFile&) = delete;
  TrajectoryFile& operator=(const TrajectoryFile&) = delete;

  /// A row (columns); false when something is amiss, then problem() has the sentence.
  bool write(const std::vector<double>& row);
  /// Writes what is left and `summary`, and gives the file its name.
  bool finish(const std::string& summary);
  const std::string& problem() const { return problem_; }

 private:
  struct Open;
  bool fail(const std::string& what);
  std::filesystem::path file_, part_;
  std::unique_ptr<Open> open_;
  std::string problem_;
};

}  // namespace momenta
