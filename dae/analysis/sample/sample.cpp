#include <momenta/dae/analysis/sample/sample.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace momenta {
namespace {

constexpr std::uint64_t golden = 0x9e3779b97f4a7c15ull;

std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// Streams of noise of a column: its draws, and its order or shift.
std::uint64_t drawn(std::size_t column) {
  return 2 * static_cast<std::uint64_t>(column);
}
std::uint64_t arranged(std::size_t column) {
  return drawn(column) + 1;
}

/// 0 … n-1 in a random order (Fisher, Yates).
std::vector<std::uint32_t> shuffled(std::size_t n, std::uint64_t seed, std::uint64_t stream) {
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  for (std::size_t i = n; i > 1; --i) {
    const double place = in_unit_interval(noise(seed, stream, i)) * static_cast<double>(i);
    std::swap(order[i - 1], order[static_cast<std::size_t>(place)]);
  }
  return order;
}

}  // namespace

std::uint64_t noise(std::uint64_t seed, std::uint64_t stream, std::uint64_t number) {
  std::uint64_t x = mixed(seed + golden);
  x = mixed(x + (stream + 1) * golden);
  return mixed(x + (number + 1) * golden);
}

double in_unit_interval(std::uint64_t bits) {
  return (static_cast<double>(bits >> 12) + 0.5) * 0x1p-52;
}

std::optional<SampleSettings> sample_settings(const std::string& kind,
                                              const std::optional<std::size_t>& points,
                                              const std::optional<std::uint64_t>& seed,
                                              bool indices) {
  using Kind = SampleSettings::Kind;
  if (kind.empty()) {
    if (points || seed || indices)
      throw std::invalid_argument(std::string(points ? "points"
                                              : seed ? "seed"
                                                     : "indices") +
                                  " asked for without a sample, expected sample random, latin or "
                                  "sobol");
    return std::nullopt;
  }
  SampleSettings settings;
  settings.kind = kind == "random" ? Kind::random : kind == "latin" ? Kind::latin : Kind::sobol;
  if (settings.kind == Kind::sobol && kind != "sobol")
    throw std::invalid_argument("sample '" + kind +
                                "' is not known, expected random, latin or sobol");
  settings.points = points.value_or(settings.points);
  settings.seed = seed.value_or(settings.seed);
  settings.indices = indices;
  return settings;
}

Sample::Sample(const SampleSettings& settings, std::size_t quantities)
    : settings_(settings), quantities_(quantities) {
  if (settings.points < 1 || quantities < 1 || settings.points > most_cases / cases_of_a_point())
    throw std::invalid_argument(
        "a sample of " + std::to_string(settings.points) + " points" +
        (settings.indices ? ", " + std::to_string(cases_of_a_point()) + " cases each" : "") +
        ": expected 1 to " + std::to_string(most_cases) + " cases");
  const std::size_t columns = settings.indices ? 2 * quantities : quantities;
  if (settings.kind == SampleSettings::Kind::sobol) {
    if (columns > SobolSequence::most_dimensions)
      throw std::invalid_argument(
          "a Sobol sequence for " + std::to_string(quantities) + " varied quantities" +
          (settings.indices ? " and their indices" : "") + ": expected at most " +
          std::to_string(SobolSequence::most_dimensions / (settings.indices ? 2 : 1)) +
          "; random and latin take any number");
    sobol_.emplace(static_cast<int>(columns));
    for (std::size_t i = 0; i < columns; ++i)
      shifts_.push_back(static_cast<std::uint32_t>(noise(settings.seed, arranged(i), 0) >> 32));
  }
  if (settings.kind == SampleSettings::Kind::latin)
    for (std::size_t i = 0; i < columns; ++i)
      strata_.push_back(shuffled(settings.points, settings.seed, arranged(i)));
}

double Sample::coordinate(std::size_t point, std::size_t column) const {
  if (sobol_) {
    const auto bits = sobol_->bits(static_cast<std::uint32_t>(point), static_cast<int>(column));
    return (static_cast<double>(bits ^ shifts_[column]) + 0.5) * 0x1p-32;
  }
  const double u = in_unit_interval(noise(settings_.seed, drawn(column), point));
  if (strata_.empty()) return u;
  const double x = (strata_[column][point] + u) / static_cast<double>(settings_.points);
  return std::min(x, std::nextafter(1.0, 0.0));
}

double Sample::at(std::size_t number, std::size_t quantity) const {
  if (!settings_.indices) return coordinate(number, quantity);
  const std::size_t point = number / cases_of_a_point(), of_it = number % cases_of_a_point();
  const bool of_b = of_it == 1 || of_it == quantity + 2;
  return coordinate(point, of_b ? quantities_ + quantity : quantity);
}

}  // namespace momenta
