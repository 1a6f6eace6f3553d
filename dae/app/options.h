#pragma once
// Options that several verbs share, the kinds of their values, and the exit status.

#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/output/meshes.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace momenta::program {

inline constexpr int done = 0, run_failed = 1, bad_input = 2;

struct Options {
  std::string command;                        ///< words as typed
  std::string asked;                          ///< the verb and options, but for output
  std::vector<std::string> given;             ///< names of options
  std::vector<std::filesystem::path> inputs;  ///< files named for reading
  std::filesystem::path scene;
  ReadOptions reading;           ///< values missing in a URDF
  std::vector<std::string> set;  ///< numbers in place of the scene's: PLACE=NUMBER
  std::string stops;             ///< stops at limits: STIFFNESS[,DAMPING]; empty: none
  std::string at;                ///< start values in place of the scene's; empty: its own
  std::string algebra = "auto", kkt = "auto", cut = "auto";
  std::string level;  ///< level of the kernels; empty: the machine's best, or MOMENTA_LEVEL
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
  std::string data = "csv";                   ///< for run: csv or hdf5
  bool reactions = false;                     ///< for run: columns of joints' reactions
  std::size_t mesh_bytes = usual_mesh_bytes;  ///< bytes of meshes in a page
  bool json = false, quiet = false;
};

// Kinds of values

/// One of these words, shown as type name.
CLI::Option* one_of(CLI::Option* option, const std::vector<std::string>& words);
/// Greater than 0, shown as `type_name`.
CLI::Option* positive(CLI::Option* option, const std::string& type_name);
/// The option takes a number from `least` to `most`, shown as `type_name`.
template <class Number>
CLI::Option* within(CLI::Option* option, const std::string& type_name, Number least, Number most) {
  const auto check = [=](const std::string& text) -> std::string {
    Number x{};
    if (CLI::detail::lexical_cast(text, x) && least <= x && x <= most) return {};
    const auto digits = [](Number n) {
      if constexpr (std::is_integral_v<Number>) return std::to_string(n);
      return reading::digits(static_cast<double>(n));
    };
    return "found " + reading::in_quotes(text) + ", expected a " +
           (std::is_integral_v<Number> ? "whole number" : "number") + " from " + digits(least) +
           " to " + digits(most);
  };
  return option->check(check)->type_name(type_name);
}

// Options of several verbs

void add_scene(CLI::App& verb, Options& o);
/// Without options of runs, but with values missing in a URDF.
void add_scene_file(CLI::App& verb, Options& o, bool required = true);
void add_level(CLI::App& verb, Options& o);
/// Options of verbs that time their runs.
void add_timing(CLI::App& verb, Options& o);
/// `cpu_limit`: default for this verb, in words.
void add_run_options(CLI::App& verb, Options& o, const char* cpu_limit = "none");
void add_results(CLI::App& verb, Options& o);
void add_form(CLI::App& verb, Options& o, const char* what = "Which equations");
/// `what`: the files that it gets.
void add_out(CLI::App& verb, Options& o, const char* what);
/// Removes options that this verb does not take.
void without(CLI::App& verb, std::initializer_list<const char*> options);
/// Option of verbs without runs (progress.h); `usual`: default, in words.
void add_cpu_limit(CLI::App& verb, Options& o, const char* usual = "none");
/// Option of verbs that write pages.
void add_mesh_bytes(CLI::App& verb, Options& o);

/// "a,b,c" as a list.
std::vector<std::string> names_in(const std::string& list);

/// "A", or "A=1,B=-0.5": names and amounts other than zero, 1 by default. `like`: for messages.
/// @throws std::invalid_argument
std::vector<std::pair<std::string, double>> amounts_in(const std::string& option,
                                                       const std::string& list,
                                                       const std::string& like);

}  // namespace momenta::program
