#pragma once
// Output of a verb, and its files in --out.

#include <momenta/dae/output/figure.h>
#include <momenta/dae/output/json.h>
#include <momenta/dae/output/part_file.h>
#include <momenta/dae/output/trajectory_file.h>
#include <momenta/dae/study/journal.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "options.h"

namespace momenta::program {

/// Sets scene, command, machine and interruption of a study.
void describe(StudyResult& study, const Options& o, const Mechanism& mechanism,
              const Assembly& assembly);

/// Picture by show(); reports omissions unless --quiet is given.
void show(StudyResult& study, const Options& o, const Mechanism& mechanism,
          const Assembly& assembly);

/// Intervals of one film of `runs`; 0 without --out or drawing.
int film_intervals_of(const Mechanism& mechanism, const Options& o, std::size_t runs);

/// All or none; on failure prints the sentence and returns false.
bool write_results(const std::vector<ResultFile>& files);

/// The trajectory for --out, as text that begins with `before`, or as HDF5.
/// @throws std::invalid_argument; std::runtime_error where it cannot be written
std::unique_ptr<TrajectoryFile> trajectory_file(const Options& o, const Mechanism& mechanism,
                                                const RunSettings& settings,
                                                std::string_view before);

/// @throws std::invalid_argument for figures without --out
void expect_place_for_figures(const Options& o);
/// Adds figures/ in --out.
void add_figures(std::vector<ResultFile>& files, std::vector<Figure> figures, const Options& o);

/// The JSON of an answer, with the command, if that is told, and the machine behind it.
std::string json_text(nlohmann::ordered_json json, const std::string& command = "");

/// Prints JSON with --json, else the table, unless --quiet is given; and the file of --out to look
/// at.
void tell(const Options& o, const std::string& json, const std::string& table,
          const std::string& file = "");

/// Command and program of a study.
Journal::Study study_of(const Options& o);
/// Finished runs, kept beside results until the end of the study; null without --out.
std::unique_ptr<Journal> keep_runs(const Options& o, const char* file = "runs.jsonl");

/// Writes a study's files, `files` among them, to --out, prints its table and `words`, or JSON;
/// returns the exit status.
int publish(const StudyResult& study, const std::string& words, const Options& o, Journal* journal,
            std::vector<ResultFile> files = {});

/// Whether `file` is one of those read, by whatever name.
bool is_read(const std::filesystem::path& file, const std::vector<std::filesystem::path>& read);
/// @throws std::invalid_argument for results written over a file that is read
void expect_inputs_kept(const Options& o);

/// @throws std::invalid_argument for a directory with results of another verb than that of `own`
void expect_own_results(const std::filesystem::path& out, std::string_view own);
/// Reports runs from the journal and its problems; removes it once the study is written.
void close(Journal* journal, std::size_t runs, bool over, const Options& o);

}  // namespace momenta::program
