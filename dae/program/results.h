#pragma once
// What a verb tells, and the files it leaves where --out says.

#include <momenta/dae/assembly/assembly.h>
#include <momenta/dae/report/atomic_write.h>
#include <momenta/dae/report/figure.h>
#include <momenta/dae/report/json.h>
#include <momenta/dae/report/trajectory_file.h>
#include <momenta/dae/study/journal.h>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "options.h"

namespace momenta::program {

/// What a study tells of its scene, its command and the machine; and that it was interrupted.
void describe(StudyResult& study, const Options& o, const Mechanism& mechanism,
              const Assembly& assembly);

/// The picture of a study, as show() makes it, and what it leaves out told unless --quiet is given.
void show(StudyResult& study, const Options& o, const Mechanism& mechanism,
          const Assembly& assembly);

/// Prints what its runs integrated in place of the scene as written, if that is another one.
void print_integrated(const StudyResult& study);

/// Intervals of the film of one of so many runs; 0 without --out and where nothing is drawn.
int film_intervals_of(const Mechanism& mechanism, const Options& o, std::size_t runs);

/// Writes result files, all or none; on failure prints the sentence and returns false.
bool write_results(const std::vector<ResultFile>& files);

/// The run's trajectory, where --out asks for one, as text, which begins with `before`, or as HDF5.
/// @throws std::invalid_argument; std::runtime_error where it cannot be written
std::unique_ptr<TrajectoryFile> trajectory_file(const Options& o, const Mechanism& mechanism,
                                                const RunSettings& settings,
                                                std::string_view before);

/// Where figures are asked for there must be a place for them. @throws std::invalid_argument
void expect_place_for_figures(const Options& o);
/// Adds them, as files of figures/ where --out says.
void add_figures(std::vector<ResultFile>& files, std::vector<Figure> figures, const Options& o);

/// The JSON document with --json, else, unless --quiet is given, the table on standard output; and
/// which file of --out to look at, where one is named.
void tell(const Options& o, const std::string& json, const std::string& table,
          const std::string& file = "");

/// What was asked, and which program was.
Journal::Study study_of(const Options& o);
/// Finished runs of this study, kept beside its results until it is over; null without --out.
std::unique_ptr<Journal> keep_runs(const Options& o, const char* file = "runs.jsonl");

/// Writes a study's files, `files` among them, where --out says, prints its table and `words`, or
/// its JSON, and returns the exit status.
int publish(const StudyResult& study, const std::string& words, const Options& o, Journal* journal,
            std::vector<ResultFile> files = {});

/// Whether a file to be written is one of these that are read, by whatever name.
bool is_read(const std::filesystem::path& file, const std::vector<std::filesystem::path>& read);
/// Refuses results that would be written over a file which the command reads.
/// @throws std::invalid_argument
void expect_inputs_kept(const Options& o);

/// Refuses a directory that holds results of another verb than the one that writes `own`.
/// @throws std::invalid_argument
void expect_own_results(const std::filesystem::path& out, std::string_view own);
/// Says how many runs were taken from the journal and what is amiss with it; removes it where the
/// study is over and written.
void close(Journal* journal, std::size_t runs, bool over, const Options& o);

}  // namespace momenta::program
