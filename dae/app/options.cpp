#include "options.h"

#include <momenta/core/text/quoting.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/run/run_result.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace momenta::program {

CLI::Option* one_of(CLI::Option* option, const std::vector<std::string>& words) {
  std::string type_name;
  for (const std::string& word : words) type_name += (type_name.empty() ? "" : "|") + word;
  const auto check = [words](const std::string& text) -> std::string {
    if (std::find(words.begin(), words.end(), text) != words.end()) return {};
    const std::vector<std::string_view> known(words.begin(), words.end());
    return "found " + reading::in_quotes(text) + ", expected one of: " + listed(words) +
           reading::did_you_mean(text, known);
  };
  return option->check(check)->type_name(type_name);
}

CLI::Option* positive(CLI::Option* option, const std::string& type_name) {
  const auto check = [](const std::string& text) -> std::string {
    double x = 0;
    const bool is_number = CLI::detail::lexical_cast(text, x);
    if (is_number && x > 0 && std::isfinite(x)) return {};
    return "found " + (is_number ? text : reading::in_quotes(text)) +
           ", expected a positive number";
  };
  return option->check(check)->type_name(type_name);
}

void add_scene_file(CLI::App& verb, Options& o, bool required) {
  verb.add_option("scene", o.scene, "TOML, URDF (.urdf), MJCF (.xml, .mjcf) or SDF (.sdf)")
      ->required(required)
      ->type_name("SCENE");
  verb.add_option("--loops", o.reading.loops, "Of a URDF: its loops (default: the .yaml beside it)")
      ->type_name("FILE");
  verb.add_flag("--free-root", o.reading.free_root, "Of a URDF: the root link floats");
  verb.add_option("--set", o.set, "PLACE=NUMBER in place of the scene's; repeatable")
      ->type_name("SETTING")
      ->allow_extra_args(false);
  verb.add_option("--control", o.reading.controls, "Of an MJCF: actuators act; start at a <key>")
      ->type_name("CONTROL")
      ->allow_extra_args(false);
  verb.add_option("--key", o.reading.key, "Of an MJCF: start at this <key>, by name or number")
      ->type_name("KEY");
  verb.add_option("--stops", o.stops, "Limits push back: STIFFNESS[,DAMPING], SI units")
      ->type_name("STIFFNESS");
  verb.add_option("--at", o.at, "Start values: JSON {\"q\": {..}, \"v\": {..}}, or its file")
      ->type_name("STATE");
}

void add_scene(CLI::App& verb, Options& o) {
  add_scene_file(verb, o);
  one_of(verb.add_option("--algebra", o.algebra, "Kernel (default: auto)"),
         {"auto", "planar", "spatial"});
  one_of(verb.add_option("--kkt", o.kkt, "Solver of the loop equations (default: auto)"),
         {"auto", "sweeps", "sparse", "dense"});
  one_of(verb.add_option("--cut", o.cut, "What runs integrate (default: auto, the least work)"),
         {"auto", "scene"});
  add_level(verb, o);
  verb.add_flag("--json", o.json, "JSON on standard output; no progress, no table");
  verb.add_flag("--quiet", o.quiet, "No progress, no table");
}

void add_level(CLI::App& verb, Options& o) {
  one_of(verb.add_option("--level", o.level, "x86-64 level of the kernels (default: best)"),
         {"1", "3", "4"});
}

void add_timing(CLI::App& verb, Options& o) {
  one_of(verb.add_option("--timing", o.timing, "How runs are timed"), {"rounds", "once", "none"})
      ->capture_default_str();
}

void add_run_options(CLI::App& verb, Options& o, const char* cpu_limit) {
  std::vector<std::string> names;
  for (const Integrator& i : integrators()) names.push_back(i.name);
  one_of(verb.add_option("--integrator", o.integrator,
                         "Default: ida, or dp5, dop853, vern9 by --rtol"),
         names)
      ->type_name("INTEGRATOR");
  verb.add_option("--gauge", o.gauge, "How momentum forms keep σ small [1/s]")
      ->type_name("none|reset|flip|leak|leak:RATE");
  positive(verb.add_option("--rtol", o.rtol, "Relative, absolute tolerance"), "X")
      ->capture_default_str();
  positive(
      verb.add_option("--atol", o.atol, "Absolute tolerance, scaled per unknown (default: rtol)"),
      "X");
  positive(verb.add_option("--step", o.step, "Step of the fixed-step integrators [s]"), "S");
  within(verb.add_option("--spectral-radius", o.spectral_radius, "Of generalised-alpha, below 1"),
         "X", 0.0, 1.0)
      ->capture_default_str();
  positive(verb.add_option("--end", o.end, "End time [s]; output intervals"), "S");
  within(verb.add_option("--samples", o.samples, "Output intervals"), "N", 1, most_samples);
  auto* project =
      verb.add_flag("--project", o.project, "Correct positions after each step, or not");
  verb.add_flag("--no-project", o.no_project, "No correction, even if the scene asks for it")
      ->excludes(project);
  positive(
      verb.add_option("--baumgarte-alpha", o.baumgarte_alpha, "α, β of Φ̈ + 2αΦ̇ + β²Φ = 0 [1/s]"),
      "X");
  positive(verb.add_option("--baumgarte-beta", o.baumgarte_beta, "β of it [1/s]"), "X");
  positive(verb.add_option("--beta", o.beta, "Momentum forms: Φ̇ = −βΦ [1/s] (default: 0)"), "X");
  positive(verb.add_option("--penalty", o.penalty, "Of augmented Lagrangians (default: 1e7)"), "X");
  positive(verb.add_option("--cpu-limit", o.cpu_limit,
                           std::string("CPU time of a run [s] (default: ") + cpu_limit + ")"),
           "S");
  verb.add_option("--reference", o.reference, "CSV with a reference solution")->type_name("FILE");
  add_results(verb, o);
}

void add_cpu_limit(CLI::App& verb, Options& o, const char* usual) {
  positive(verb.add_option("--cpu-limit", o.cpu_limit,
                           std::string("CPU time of all of it [s] (default: ") + usual + ")"),
           "S");
}

void add_mesh_bytes(CLI::App& verb, Options& o) {
  within(verb.add_option("--mesh-bytes", o.mesh_bytes, "Of meshes in a page; 0: none"), "N", 0,
         1'000'000'000)
      ->capture_default_str();
}

void add_form(CLI::App& verb, Options& o, const char* what) {
  verb.add_option("--form", o.form, what)->capture_default_str()->type_name("FORM");
}

void add_out(CLI::App& verb, Options& o, const char* what) {
  verb.add_option("--out", o.out, what)->type_name("DIR");
}

void without(CLI::App& verb, std::initializer_list<const char*> options) {
  for (const char* option : options) verb.remove_option(verb.get_option(option));
}

void add_results(CLI::App& verb, Options& o) {
  add_out(verb, o, "Directory for results; bytes of meshes in a page");
  add_mesh_bytes(verb, o);
  one_of(verb.add_option("--figures", o.figures, "Every chart for papers, in DIR/figures"),
         {"svg"});
}

std::vector<std::string> names_in(const std::string& list) {
  std::vector<std::string> names;
  std::stringstream in(list);
  for (std::string name; std::getline(in, name, ',');) names.push_back(name);
  return names;
}

std::vector<std::pair<std::string, double>> amounts_in(const std::string& option,
                                                       const std::string& list,
                                                       const std::string& like) {
  std::vector<std::pair<std::string, double>> all;
  for (const std::string& part : names_in(list)) {
    const std::size_t equals = part.find('=');
    double amount = 1;
    if (equals != std::string::npos) {
      const char *begin = part.data() + equals + 1, *end = part.data() + part.size();
      const auto [read, error] = std::from_chars(begin, end, amount);
      if (error != std::errc{} || read != end || !std::isfinite(amount) || amount == 0)
        throw std::invalid_argument(option + " '" + list +
                                    "': expected NAME or NAME=AMOUNT, amounts other than zero, as "
                                    "in " +
                                    like);
    }
    all.emplace_back(part.substr(0, equals), amount);
  }
  return all;
}

}  // namespace momenta::program
