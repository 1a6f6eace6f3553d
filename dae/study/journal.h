#pragma once
// The finished runs of a study, kept in a file while the study continues. A study that is started
// again after it was killed takes them from there and makes the others.
//
// The file has lines of JSON: the first says which study it is and which build of the program made
// it; then each finished run has a line under its key, appended in one piece. An incomplete last
// line, left when the study was killed, is ignored. Runs of another build are not taken, because
// its numbers may differ.

#include <atomic>
#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

class Journal {
 public:
  /// What is written on the first line.
  struct Study {
    std::string digest;   ///< of the scene and of all that was asked
    std::string build;    ///< of program and processor, as build_digest()
    std::string command;  ///< for the reader
  };

  /// Opens `file`, or makes it and its directory. It is this process's own until it is closed.
  /// @throws std::invalid_argument when it belongs to another study, or another process has it
  /// open; std::runtime_error when it cannot be written.
  Journal(std::filesystem::path file, const Study& study);
  /// Closes the file, and removes it if it holds no run.
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// What was recorded under a key before this study was started again; null: nothing. Keys of one
  /// study differ in what a run depends on.
  const nlohmann::json* find(const std::string& key) const;
  /// Appends a line. May be called from several threads.
  void add(const std::string& key, const nlohmann::json& record);

  /// The build that made a file; empty where it has no first line, or is none.
  static std::string build_of(const std::filesystem::path& file);

  const std::filesystem::path& file() const { return file_; }
  void take_run() { ++runs_taken_; }  ///< counts what a study did not make again
  int runs_taken() const { return runs_taken_; }
  bool of_another_build() const { return of_another_build_; }  ///< its runs were dropped
  /// Why lines could not be appended, one sentence; empty: all were.
  std::string trouble() const;
  /// The study is over and its results are written.
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
