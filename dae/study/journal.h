#pragma once
// The finished runs of a study, kept in a file while it continues. A study that is started again
// after it was killed takes them from there.
//
// The file has lines of JSON: the first names the study and the build of the program; then each
// finished run has a line under its key, appended in one piece. An incomplete last line is ignored.
// Runs of another build are dropped, as their numbers may differ.

#include <atomic>
#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

class Journal {
 public:
  /// Contents of the first line.
  struct Study {
    std::string digest;   ///< digest of scene and request
    std::string build;    ///< as build_digest()
    std::string command;  ///< for the reader
  };

  /// Opens `file`, or makes it and its directory; locked until closed.
  /// @throws std::invalid_argument when it belongs to another study, or another process has it
  /// open; std::runtime_error when it cannot be written.
  Journal(std::filesystem::path file, const Study& study);
  /// Closes the file, and removes it if it holds no run.
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// Record of a key from before the study was started again; null: none. Keys of one study differ
  /// in what a run depends on.
  const nlohmann::json* find(const std::string& key) const;
  /// Appends a line. May be called from several threads.
  void add(const std::string& key, const nlohmann::json& record);

  /// Build that made a file; empty: it is no journal.
  static std::string build_of(const std::filesystem::path& file);

  const std::filesystem::path& file() const { return file_; }
  void take_run() { ++runs_taken_; }  ///< counts a recalled run
  int runs_taken() const { return runs_taken_; }
  bool of_another_build() const { return of_another_build_; }  ///< the file's runs were dropped
  /// Reason why lines could not be appended, one sentence; else empty.
  std::string trouble() const;
  /// Removes the file once the study's results are written.
  void remove();

 private:
  void read(const Study& study);
  void append(const std::string& line);

  std::filesystem::path file_;
  std::string study_;
  int descriptor_ = -1;
  std::map<std::string, nlohmann::json> records_;
  std::atomic<int> runs_taken_{0};
  bool of_another_build_ = false, holds_runs_ = false;
  mutable std::mutex turn_;
  std::string trouble_;
};

}  // namespace momenta
