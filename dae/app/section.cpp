#include <momenta/dae/output/section_report.h>
#include <momenta/dae/study/column_named.h>
#include <momenta/dae/study/environment.h>

#include <charconv>
#include <cstdio>
#include <stdexcept>

#include "loading.h"
#include "progress.h"
#include "results.h"
#include "verb.h"

namespace momenta::program {
namespace {

struct SectionOptions {
  std::string when, axes, starts, led;
  bool up = false, down = false;
};

/// "O.u=-1:1:9", or "O.u=0.5,1".
void take_starts(const std::string& text, SectionRequest& request) {
  const std::size_t equals = text.find('=');
  const auto refuse = [&] {
    throw std::invalid_argument("--starts '" + text +
                                "': expected NAME=FROM:TO:COUNT or NAME=X,..., as in "
                                "O.u=-1:1:9, at most 1000 values");
  };
  if (equals == 0 || equals == std::string::npos) refuse();
  request.varied = text.substr(0, equals);
  std::vector<double> numbers;
  char between = 0;
  const char *at = text.data() + equals + 1, *end = text.data() + text.size();
  while (at < end) {
    const auto [next, error] = std::from_chars(at, end, numbers.emplace_back());
    if (error != std::errc{} || !std::isfinite(numbers.back())) refuse();
    at = next;
    if (at == end) break;
    if ((*at != ',' && *at != ':') || (between != 0 && between != *at) || at + 1 == end) refuse();
    between = *at++;
  }
  constexpr double most = 1000;
  if (between != ':') {
    if (numbers.empty() || static_cast<double>(numbers.size()) > most) refuse();
    request.values = numbers;
    return;
  }
  if (numbers.size() != 3 || !(numbers[2] >= 2) || !(numbers[2] <= most) ||
      numbers[2] != std::floor(numbers[2]))
    refuse();
  const int count = static_cast<int>(numbers[2]);
  for (int i = 0; i + 1 < count; ++i)
    request.values.push_back(
        i == 0 ? numbers[0] : (numbers[0] * (count - 1 - i) + numbers[1] * i) / (count - 1));
  request.values.push_back(numbers[1]);
}

/// Column of an axis, with its unit. @throws std::invalid_argument
std::string column(const std::vector<std::string>& columns, const std::string& name) {
  if (const auto at = column_named(columns, name)) return columns[*at];
  throw std::invalid_argument("--axes: '" + name + "' is no column of the trajectory, expected " +
                              "coordinates, rates and markers, as in O.q,O.u");
}

int section(const Options& o, const SectionOptions& s) {
  Scene scene = read(o);
  EventSpec event;
  event.when.text = s.when;
  event.direction = s.up ? "up" : s.down ? "down" : "both";
  scene.events = {event};
  const Mechanism mechanism(std::move(scene), mechanism_options(o));
  SectionRequest request;
  request.settings = run_settings(o, mechanism.scene().run);
  request.led = s.led;
  if (!s.starts.empty())
    take_starts(s.starts, request);
  else if (!s.led.empty())
    throw std::invalid_argument("--energy is given without --starts, expected starts to be varied");
  const std::vector<std::string> columns = trajectory_columns(mechanism);
  std::vector<std::string> axes = names_in(s.axes);
  if (axes.empty()) {
    const auto q = mechanism.coordinate_columns(), u = mechanism.rate_columns();
    if (q.empty())
      throw std::invalid_argument(
          "the scene has no coordinate, so that no section is; expected one that moves");
    axes = {q.back().name, u.back().name};
  }
  if (axes.size() != 2)
    throw std::invalid_argument("--axes has " + std::to_string(axes.size()) +
                                " names, expected two, as in O.q,O.u");
  const SectionPicture picture{mechanism.scene().name,   s.when,
                               event.direction,          request.varied,
                               column(columns, axes[0]), column(columns, axes[1])};
  request.max_cpu_seconds = o.cpu_limit.value_or(0);
  expect_own_results(o.out, "section.csv");
  ProgressLine line(o.quiet);
  const std::size_t count = std::max<std::size_t>(1, request.values.size());
  request.progress = [&](std::size_t k) {
    line.show("[" + std::to_string(k + 1) + "/" + std::to_string(count) + "] starts");
    return !interrupted();
  };
  watch_signals();
  const std::vector<SectionOrbit> orbits = momenta::section(mechanism, request);
  line.show("");
  const Environment here = environment();
  auto json = section_json(picture, orbits);
  json["command"] = o.command;
  json["environment"] = environment_json(here);
  const std::string summary = json.dump(2) + "\n";
  if (!o.out.empty() &&
      !write_results({{o.out / "section.csv", section_csv(picture, orbits)},
                      {o.out / "section.json", summary},
                      {o.out / "index.html", section_page(picture, orbits, here, o.command)}}))
    return run_failed;
  tell(o, summary, section_table(picture, orbits));
  bool all = !orbits.empty();
  for (const SectionOrbit& orbit : orbits) {
    for (const std::string& sentence : orbit.run.event_remarks)
      if (!o.quiet) std::fprintf(stderr, "momenta: %s\n", sentence.c_str());
    all &= !orbit.left_out.empty() || finished(orbit.run);
  }
  return all ? done : run_failed;
}

}  // namespace

Verb declare_section(CLI::App& app, Options& o) {
  const auto own = std::make_shared<SectionOptions>();
  CLI::App& verb = add_verb(app, "section", "Poincaré section: where runs pass a surface",
                            "momenta section examples/section/scene.toml --when x --up --end 100");
  add_scene(verb, o);
  verb.add_option("--when", own->when, "The surface: where this formula is zero")
      ->type_name("FORMULA")
      ->required();
  auto* upwards = verb.add_flag("--up", own->up, "From below zero to above alone");
  verb.add_flag("--down", own->down, "From above zero to below alone")->excludes(upwards);
  verb.add_option("--axes", own->axes,
                  "Two columns to be drawn (default: the last coordinate and rate)")
      ->type_name("COLUMN,COLUMN");
  verb.add_option("--starts", own->starts, "A start value in turn: O.u=FROM:TO:COUNT or O.u=X,...")
      ->type_name("NAME=VALUES");
  verb.add_option("--energy", own->led,
                  "With --starts: the rate that is led so that the energy stays")
      ->type_name("NAME");
  add_form(verb, o);
  add_run_options(verb, o);
  without(verb, {"--reference", "--figures", "--samples", "--mesh-bytes", "--spectral-radius",
                 "--baumgarte-alpha", "--baumgarte-beta", "--beta", "--penalty"});
  verb.get_option("--end")->description("End time [s]");
  verb.get_option("--out")->description("Directory for section.csv, .json, index.html");
  return {&verb, [&o, own] { return section(o, *own); }};
}

}  // namespace momenta::program
