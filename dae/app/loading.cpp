#include "loading.h"

#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/analysis/equations/equation_file.h>
#include <momenta/dae/run/force_columns.h>
#include <momenta/dae/run/motion.h>
#include <momenta/dae/run/state_input.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>

#include "results.h"

namespace momenta::program {

std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<Setting> settings_of(const Options& o) {
  std::vector<Setting> settings;
  for (const std::string& text : o.set) {
    const std::size_t equals = text.rfind('=');
    Setting setting{text.substr(0, equals), 0};
    const char* end = text.data() + text.size();
    const char* begin = equals == text.npos ? end : text.data() + equals + 1;
    const auto [read, error] = std::from_chars(begin, end, setting.value);
    if (equals == 0 || begin == end || error != std::errc{} || read != end ||
        !std::isfinite(setting.value))
      throw std::invalid_argument("--set '" + text +
                                  "': expected PLACE=NUMBER, as in body.crank.mass=2 or, of a "
                                  "parameter, a=0.6");
    settings.push_back(setting);
  }
  return settings;
}

namespace {

/// --stops. @throws std::invalid_argument
std::optional<std::array<double, 2>> stops_of(const std::string& text) {
  if (text.empty()) return std::nullopt;
  std::array<double, 2> stops{0, 0};
  const char *at = text.data(), *end = at + text.size();
  bool good = true;
  for (std::size_t i = 0; i < 2 && good && at != nullptr; ++i) {
    const auto [stop, error] = std::from_chars(at, end, stops[i]);
    good = error == std::errc{} && stops[i] >= 0 && std::isfinite(stops[i]) &&
           (stop == end || (*stop == ',' && i == 0));
    at = good && stop != end ? stop + 1 : nullptr;
  }
  if (!good || !(stops[0] > 0))
    throw std::invalid_argument("--stops '" + text +
                                "': expected STIFFNESS or STIFFNESS,DAMPING, numbers >= 0, as in "
                                "1e4,100");
  return stops;
}

}  // namespace

Scene read(const Options& o) {
  ReadOptions reading = o.reading;
  reading.stops = stops_of(o.stops);
  Scene scene = read_scene(o.scene, reading, settings_of(o));
  if (!o.at.empty()) start_at(o.at, scene);
  if (!o.quiet)
    for (const std::string& remark : scene.remarks)
      std::fprintf(stderr, "momenta: %s: %s\n", o.scene.c_str(), remark.c_str());
  return scene;
}

MechanismOptions mechanism_options(const Options& o) {
  MechanismOptions options;
  options.algebra = o.algebra == "planar"    ? Algebra::planar
                    : o.algebra == "spatial" ? Algebra::spatial
                                             : Algebra::automatic;
  options.kkt = o.kkt == "dense"    ? KktChoice::dense
                : o.kkt == "sweeps" ? KktChoice::sweeps
                : o.kkt == "sparse" ? KktChoice::sparse
                                    : KktChoice::automatic;
  options.cut = o.cut == "scene" ? CutChoice::scene : CutChoice::automatic;
  return options;
}

bool names_equations(const Options& o) {
  std::error_code error;
  return o.scene.extension() == ".toml" && std::filesystem::is_regular_file(o.scene, error) &&
         holds_equations(content_of(o.scene));
}

std::unique_ptr<Mechanism> load(const Options& o) {
  expect_place_for_figures(o);
  return std::make_unique<Mechanism>(read(o), mechanism_options(o));
}

RunSettings run_settings(const Options& o, const RunDefaults& defaults) {
  RunSettings s = default_settings(defaults, o.form, o.integrator, o.rtol);
  if (!o.gauge.empty()) s.gauge = o.gauge;
  s.atol = o.atol.value_or(s.atol);
  s.step = o.step.value_or(s.step);
  s.spectral_radius = o.spectral_radius;
  s.end_time = o.end.value_or(s.end_time);
  s.samples = o.samples.value_or(s.samples);
  s.project = o.project || (s.project && !o.no_project);
  s.baumgarte_alpha = o.baumgarte_alpha;
  s.baumgarte_beta = o.baumgarte_beta;
  s.beta = o.beta;
  s.penalty = o.penalty;
  return s;
}

std::unique_ptr<Reference> load_reference(const Options& o, const Mechanism& mechanism) {
  if (o.reference.empty()) return nullptr;
  auto reference = std::make_unique<Reference>(o.reference);
  reference->bind(measured_columns(mechanism));
  return reference;
}

}  // namespace momenta::program
