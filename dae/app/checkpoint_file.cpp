#include "checkpoint_file.h"

#include <momenta/dae/output/csv.h>
#include <momenta/dae/study/run_record.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "loading.h"
#include "results.h"

namespace momenta::program {
namespace {

constexpr std::chrono::milliseconds least_between{200};
constexpr int times_its_cost = 20;  // checkpoints take a twentieth of the time at most

std::string last_line(const std::string& text) {
  const std::size_t before =
      text.size() < 2 ? std::string::npos : text.rfind('\n', text.size() - 2);
  return before == std::string::npos ? text : text.substr(before + 1);
}

}  // namespace

CheckpointFile::CheckpointFile(const Options& o, std::size_t columns)
    : o_(o),
      file_(o.out / "checkpoint.json"),
      part_(o.out / (o.data == "hdf5" ? "run.h5.part" : "trajectory.csv.part")),
      next_(Clock::now() + least_between) {
  if (o.out.empty()) return;
  study_ = study_of(o);
  read(content_of(file_), columns);
  if (!from_ && anew_.empty() && std::filesystem::exists(part_))
    anew_ = part_.string() + " of a run that was killed has no checkpoint beside it";
}

void CheckpointFile::read(const std::string& text, std::size_t columns) {
  const auto all = nlohmann::json::parse(text, nullptr, false);
  if (!all.is_object()) return;
  const auto told = [&](const char* name) {
    const auto at = all.find(name);
    return at != all.end() && at->is_string() ? at->get<std::string>() : std::string();
  };
  if (told("study") != study_.digest) {
    // Results of an interrupted run are replaced like others.
    if (!std::filesystem::exists(part_)) return;
    throw std::invalid_argument(file_.string() + " belongs to an unfinished run, '" +
                                told("command") +
                                "'; expected that command to finish it, another --out, or the file "
                                "removed");
  }
  if (told("build") != study_.build) {
    anew_ = file_.string() + " is of another build of the program";
    return;
  }
  Checkpoint found;
  const auto size = all.find("trajectory");
  if (size == all.end() || !size->is_number_unsigned() || !all.contains("run") ||
      !read_record(all["run"], found))
    return;
  auto& rows = found.so_far.trajectory.rows;
  for (const auto& file : {part_, o_.out / "trajectory.csv"}) {
    std::string begins = content_of(file);
    if (begins.size() < *size) continue;
    begins.resize(*size);
    if (last_line(begins) != told("last_row") || !read_trajectory_rows(begins, columns, rows) ||
        rows.size() != found.so_far.series.t.size())
      continue;
    from_ = std::move(found);
    trajectory_ = std::move(begins);
    return;
  }
  anew_ = file_.string() + " is not of the trajectory beside it";
}

void CheckpointFile::begin() {
  if (o_.out.empty()) return;
  if (!from_) remove();
  if (o_.quiet) return;
  if (from_)
    std::fprintf(stderr, "momenta: the run goes on from t = %.6g s, of %s\n", from_->t,
                 file_.c_str());
  else if (!anew_.empty())
    std::fprintf(stderr, "momenta: %s: begun anew\n", anew_.c_str());
}

void CheckpointFile::note(TrajectoryFile& trajectory, const std::vector<double>& row,
                          const std::function<Checkpoint()>& make) {
  const auto began = Clock::now();
  if (failed_ || began < next_ || row.empty() || !trajectory.can_go_on() || !trajectory.flush())
    return;
  const nlohmann::json all{{"study", study_.digest},
                           {"build", study_.build},
                           {"command", o_.command},
                           {"trajectory", trajectory.size()},
                           {"last_row", trajectory_line(row)},
                           {"run", record_of(make())}};
  using Text = nlohmann::json::error_handler_t;
  const auto problem = atomic_write(file_, all.dump(-1, ' ', false, Text::replace));
  failed_ = problem.has_value();  // the last checkpoint stays
  if (failed_) std::fprintf(stderr, "momenta: %s\n", problem->c_str());
  const auto now = Clock::now();
  next_ = now + std::max<Clock::duration>(least_between, times_its_cost * (now - began));
}

void CheckpointFile::remove() const {
  if (o_.out.empty()) return;
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
  // Left by a run that was killed while writing.
  std::filesystem::remove(file_.string() + ".part", ignored);
}

}  // namespace momenta::program
