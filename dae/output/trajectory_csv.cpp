#include <momenta/dae/output/csv.h>
#include <momenta/dae/output/part_file.h>
#include <momenta/dae/output/trajectory_file.h>

#include <chrono>
#include <utility>

namespace momenta {
namespace {

class CsvTrajectory final : public TrajectoryFile {
 public:
  CsvTrajectory(std::filesystem::path file, const std::vector<std::string>& labels,
                std::string_view before)
      : part_(std::move(file), before), held_(before.empty() ? trajectory_head(labels) : "") {
    problem_ = part_.problem();
    flush();  // the head, to notice a full disk at once
  }

  bool write(const std::vector<double>& row) override {
    if (!problem_.empty()) return false;
    held_ += trajectory_line(row);
    return (held_.size() < most_held && Clock::now() - flushed_ < longest_held) || flush();
  }

  /// Removes a partial last line.
  bool flush() override {
    if (!problem_.empty()) return false;
    const std::size_t before = part_.size();
    if (!part_.append(held_)) {
      const std::size_t written = part_.size() - before;
      const std::size_t end = written > 0 ? held_.rfind('\n', written - 1) : std::string::npos;
      part_.cut(end == std::string::npos ? before : before + end + 1);
      problem_ = part_.problem();
    }
    held_.clear();
    flushed_ = Clock::now();
    return problem_.empty();
  }

  bool can_go_on() const override { return true; }
  std::size_t size() const override { return part_.size(); }

  bool finish(const std::string&) override {
    if (part_.put_in_place()) return true;
    if (problem_.empty()) problem_ = part_.problem();
    return false;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t most_held = 1 << 16;  // bytes
  static constexpr std::chrono::seconds longest_held{1};

  PartFile part_;
  std::string held_;  ///< lines still to be written
  Clock::time_point flushed_;
};

}  // namespace

std::unique_ptr<TrajectoryFile> csv_trajectory(std::filesystem::path file,
                                               const std::vector<std::string>& labels,
                                               std::string_view before) {
  return std::make_unique<CsvTrajectory>(std::move(file), labels, before);
}

}  // namespace momenta
