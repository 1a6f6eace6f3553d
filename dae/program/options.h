#pragma once
// What several verbs take from the command line, and the exit status.

#include <momenta/core/scene/files/read_scene.h>
#include <momenta/dae/report/meshes.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace momenta::program {

inline constexpr int done = 0, run_failed = 1, bad_input = 2;

struct Options {
  std::string command;  ///< as typed
  std::string asked;    ///< the verb and its options, but for where and how results are told
  std::vector<std::string> given;             ///< names of the options that were given
  std::vector<std::filesystem::path> inputs;  ///< files that they name to be read
  std::filesystem::path scene;
  ReadOptions reading;           ///< what a URDF does not say
  std::vector<std::string> set;  ///< numbers in place of the scene's: PLACE=NUMBER
  std::string stops;             ///< at limits: STIFFNESS[,DAMPING]; empty: none
  std::string at;                ///< start values in place of the scene's; empty: its own
  std::string algebra = "auto", kkt = "auto", cut = "auto";
  std::string level;  ///< of the kernels; empty: the machine's best, or MOMENTA_LEVEL
  std::string form = "momentum", integrator, gauge;
  double rtol = 1e-8;
  std::optional<double> atol, step, end;
  std::optional<int> samples;
  double spectral_radius = 0.8;
  double baumgarte_alpha = 0, baumgarte_beta = 0;
  double beta = 0, penalty = 0;
  bool project = false, no_project = false;  ///< neither: as the scene says
  std::optional<double> cpu_limit;
  std::string timing = "rounds";
  std::filesystem::path reference, out;
  std::string figures;                        ///< svg or none
  std::string data = "csv";                   ///< of run: csv or hdf5
  bool reactions = false;                     ///< of run: those of joints are columns
  std::size_t mesh_bytes = usual_mesh_bytes;  ///< of a page
  bool json = false, quiet = false;
};

void add_scene(CLI::App& verb, Options& o);
/// The scene alone, with what a URDF does not say.
void add_scene_file(CLI::App& verb, Options& o, bool required = true);
void add_level(CLI::App& verb, Options& o);
/// Of verbs that time what they ran.
void add_timing(CLI::App& verb, Options& o);
/// `cpu_limit`: that of a run of this verb, in words.
void add_run_options(CLI::App& verb, Options& o, const char* cpu_limit = "none");
void add_results(CLI::App& verb, Options& o);
/// Of verbs without runs (cpu_limit.h); `usual`: theirs, in words.
void add_cpu_limit(CLI::App& verb, Options& o, const char* usual = "none");
/// Of verbs that write pages.
void add_mesh_bytes(CLI::App& verb, Options& o);

/// "a,b,c" as a list.
std::vector<std::string> names_in(const std::string& list);

/// "A", or "A=1,B=-0.5": names and amounts other than zero, 1 where none stands. `like`: what was
/// expected. @throws std::invalid_argument
std::vector<std::pair<std::string, double>> amounts_in(const std::string& option,
                                                       const std::string& list,
                                                       const std::string& like);

}  // namespace momenta::program
