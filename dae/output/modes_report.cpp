#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/output/json.h>
#include <momenta/dae/output/modes_report.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace momenta {
namespace {

std::string counted_modes(long n, const char* what) {
  return std::to_string(n) + " " + what + (n == 1 ? " mode" : " modes");
}

/// Growing modes, which come first, and rigid ones do not count.
const Mode* lowest(const ModesResult& r) {
  for (const Mode& mode : r.spectrum.modes)
    if (mode.kind() == Mode::Kind::oscillation && mode.s.real() <= 0) return &mode;
  return nullptr;
}

bool any_complex(const ModesResult& r) {
  return std::any_of(r.spectrum.modes.begin(), r.spectrum.modes.end(),
                     [](const Mode& mode) { return !mode.real; });
}

}  // namespace

std::string largest_entries(const ModesResult& r, const Mode& mode, std::size_t most) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(mode.shape.size()));
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Eigen::Index>(i);
  std::stable_sort(order.begin(), order.end(), [&](auto i, auto j) {
    return std::abs(mode.shape[i]) > std::abs(mode.shape[j]);
  });
  std::string text;
  const double largest = order.empty() ? 1 : std::abs(mode.shape[order.front()]);
  for (std::size_t k = 0; k < std::min(most, order.size()); ++k) {
    const std::complex<double> part = mode.shape[order[k]] / largest;
    if (std::abs(part) < 1e-3) break;
    text += (k == 0 ? "" : ", ") + r.shapes[static_cast<std::size_t>(order[k])].name + " ";
    const double degrees = std::arg(part) * 180 / std::numbers::pi;
    const bool in_phase = std::abs(part.imag()) < 0.01 * std::abs(part);
    text += in_phase ? compact(part.real(), 2)
                     : compact(std::abs(part), 2) + " at " + fixed(degrees, 0) + "°";
  }
  return text;
}

std::string modes_in_words(const ModesResult& r) {
  const auto& modes = r.spectrum.modes;
  const Equilibrium& at = r.equilibrium;
  if (r.spectrum.mobility == 0) return "Nothing moves: the loops leave no motion, so no mode.";
  std::string text =
      std::string(r.steady ? "The steady motion is " : "The equilibrium is ") + r.nature();
  if (!r.spectrum.complete) text += " as far as these modes tell";
  if (r.growing() > 0) text += ", " + counted_modes(r.growing(), "growing");
  if (r.rigid() > 0) text += ", " + counted_modes(r.rigid(), "rigid") + " that nothing holds";
  if (r.steady)
    text += "; " + std::to_string(r.steady->left_out) + " of " +
            std::to_string(r.steady->positions) +
            " positions act on nothing and are left out of the modes";
  else
    text += at.steps == 0 ? "; it is the assembled pose itself"
                          : (r.of_formulas ? "; coordinates are up to " : "; joints are up to ") +
                                compact(at.moved, 3) +
                                (r.of_formulas ? " away from the start"
                                               : " rad or m away from the assembled pose");
  text += ". ";
  const long all = static_cast<long>(modes.size());
  text += std::to_string(all) + (all == 1 ? " mode" : " modes") + " of " +
          std::to_string(r.spectrum.mobility) +
          (r.spectrum.mobility == 1 ? " degree of freedom" : " degrees of freedom");
  if (const Mode* mode = lowest(r)) {
    text += "; the lowest swings at " + compact(mode->frequency(), 4) + " Hz, once in " +
            time_text(1 / mode->frequency());
    if (mode->s.real() < 0) text += ", damping ratio " + compact(mode->damping_ratio(), 3);
  }
  text += ".";
  if (r.singular_here())
    text +=
        " The pose is singular: the loop equations have rank " + std::to_string(r.spectrum.rank) +
        " here and " + std::to_string(r.rank_nearby) +
        " nearby, so these are modes of the linearised loops, not all of which can be followed.";
  return text;
}

std::string modes_table(const ModesResult& r) {
  std::string text = (r.scene.empty() ? "" : r.scene + ": ") + modes_in_words(r) + "\n";
  if (r.spectrum.modes.empty()) return text;
  std::vector<std::vector<std::string>> rows{
      {"mode", "kind", "f [Hz]", "ω [rad/s]", "damping ratio", "growth [1/s]", "moves most"}};
  int number = 0;
  for (const Mode& mode : r.spectrum.modes) {
    const bool swings = mode.kind() == Mode::Kind::oscillation;
    rows.push_back({std::to_string(++number), name_of(mode.kind()),
                    swings ? compact(mode.frequency(), 5) : "-",
                    swings ? compact(mode.angular_frequency(), 5) : "-",
                    swings ? compact(mode.damping_ratio(), 4) : "-", compact(mode.s.real(), 4),
                    largest_entries(r, mode)});
  }
  return text + "\n" + in_columns(rows);
}

std::string modes_csv(const ModesResult& r) {
  const bool imaginary = any_complex(r);
  std::vector<std::string> cells{"mode",         "kind",           "s_re [1/s]",
                                 "s_im [rad/s]", "frequency [Hz]", "damping_ratio"};
  for (const Column& c : r.shapes) {
    cells.push_back(csv_cell(c.label()));
    if (imaginary) cells.push_back(csv_cell(c.name + ".im [" + c.unit + "]"));
  }
  std::string text = csv_line(cells);
  int number = 0;
  for (const Mode& mode : r.spectrum.modes) {
    cells = {std::to_string(++number),     name_of(mode.kind()),
             round_trip(mode.s.real()),    round_trip(mode.s.imag()),
             round_trip(mode.frequency()), round_trip(mode.damping_ratio())};
    for (const std::complex<double>& x : mode.shape) {
      cells.push_back(round_trip(x.real()));
      if (imaginary) cells.push_back(round_trip(x.imag()));
    }
    text += csv_line(cells);
  }
  return text;
}

Json modes_json(const ModesResult& r) {
  const Equilibrium& at = r.equilibrium;
  Json q = Json::object();
  for (std::size_t i = 0; i < r.coordinates.size(); ++i)
    q[r.coordinates[i].label()] = number_or_null(at.q[static_cast<Eigen::Index>(i)]);
  Json modes = Json::array();
  for (const Mode& mode : r.spectrum.modes) {
    Json shape = Json::object();
    for (std::size_t i = 0; i < r.shapes.size(); ++i) {
      const std::complex<double> x = mode.shape[static_cast<Eigen::Index>(i)];
      shape[r.shapes[i].label()] = mode.real
                                       ? number_or_null(x.real())
                                       : Json{number_or_null(x.real()), number_or_null(x.imag())};
    }
    modes.push_back({{"kind", name_of(mode.kind())},
                     {"s", {number_or_null(mode.s.real()), number_or_null(mode.s.imag())}},
                     {"angular_frequency", number_or_null(mode.angular_frequency())},
                     {"frequency", number_or_null(mode.frequency())},
                     {"damping_ratio", number_or_null(mode.damping_ratio())},
                     {"shape", shape}});
  }
  Json json{{"scene", r.scene},
            {"nature", r.nature()},
            {"growing", r.growing()},
            {"rigid", r.rigid()},
            {"degrees_of_freedom", r.spectrum.mobility},
            {"rank", r.spectrum.rank},
            {"rank_nearby", r.rank_nearby > 0 ? Json(r.rank_nearby) : Json()},
            {"singular", r.singular_here()},
            {"conservative", r.spectrum.conservative},
            {"complete", r.spectrum.complete},
            {"drives", r.drives_run ? "running" : "held"},
            {"route", r.spectrum.dense ? "dense" : "sparse"},
            {"equilibrium",
             {{"q", q},
              {"lambda", std::vector<double>(at.lambda.begin(), at.lambda.end())},
              {"potential", number_or_null(at.potential)},
              {"moved", number_or_null(at.moved)},
              {"left", number_or_null(at.left)},
              {"steps", at.steps}}},
            {"modes", modes}};
  if (r.steady)
    json["steady_motion"] = {{"u", std::vector<double>(r.steady->u.begin(), r.steady->u.end())},
                             {"positions", r.steady->positions},
                             {"rates", r.steady->rates},
                             {"left_out", r.steady->left_out}};
  return json;
}

}  // namespace momenta
