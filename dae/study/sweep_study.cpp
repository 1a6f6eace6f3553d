#include <momenta/core/scene/scene.h>
#include <momenta/dae/integrator/stopping.h>
#include <momenta/dae/study/column_named.h>
#include <momenta/dae/study/sweep_study.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <new>
#include <set>
#include <stdexcept>

namespace momenta {
namespace {

constexpr std::size_t most_cases = Sample::most_cases;

std::vector<std::string> parts(const std::string& text, char between) {
  std::vector<std::string> all(1);
  for (const char c : text)
    if (c == between)
      all.emplace_back();
    else
      all.back() += c;
  return all;
}

/// Places with commas between; in "\\," the comma belongs to the place.
std::vector<std::string> places_in(const std::string& text) {
  std::vector<std::string> all(1);
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '\\' && i + 1 < text.size() && text[i + 1] == ',')
      all.back() += text[++i];
    else if (text[i] == ',')
      all.emplace_back();
    else
      all.back() += text[i];
  return all;
}

class VariedText {
 public:
  explicit VariedText(const std::string& text) : text_(text) {}

  void read(Varied& varied) const {
    const std::size_t equals = text_.rfind('=');
    if (equals == std::string::npos || equals == 0) refuse();
    varied.place = text_.substr(0, equals);
    varied.places = places_in(varied.place);
    for (const std::string& place : varied.places)
      if (place.empty()) refuse();
    varied.distribution = distribution(text_.substr(equals + 1));
  }

 private:
  [[noreturn]] void refuse() const {
    throw std::invalid_argument(
        "--vary '" + text_ +
        "': expected PLACE=FROM:TO:COUNT, PLACE=FROM:TO:COUNT:log or PLACE=VALUE,VALUE,…, as in "
        "body.crank.mass=1:10:100, or with --sample PLACE=FROM:TO, PLACE=FROM:TO:log or "
        "PLACE=normal:MEAN:DEVIATION");
  }
  Distribution distribution(const std::string& values) const {
    using Kind = Distribution::Kind;
    auto range = parts(values, ':');
    if (range.size() == 1) {
      Distribution list;
      for (const std::string& value : parts(values, ',')) list.values.push_back(number(value));
      return list;
    }
    if (range[0] == "normal") {
      if (range.size() != 3) refuse();
      const Distribution normal{Kind::normal, number(range[1]), number(range[2]), {}};
      if (!(normal.b > 0))
        throw std::invalid_argument("--vary '" + text_ + "': found a standard deviation of " +
                                    range[2] + ", expected one above zero");
      return normal;
    }
    const bool log = range.back() == "log";
    if (log) range.pop_back();
    if (range.size() != 2 && range.size() != 3) refuse();
    const double from = number(range[0]), to = number(range[1]);
    if (log && !(from > 0 && to > 0))
      throw std::invalid_argument("--vary '" + text_ +
                                  "': a logarithmic range, expected both ends above zero");
    if (range.size() == 3) return {Kind::choice, 0, 0, spaced(from, to, range[2], log)};
    return {log ? Kind::log_uniform : Kind::uniform, from, to, {}};
  }
  double number(const std::string& text) const {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) refuse();
    return value;
  }
  std::vector<double> spaced(double from, double to, const std::string& count_text,
                             bool log) const {
    const double count = number(count_text);
    if (count < 1 || count != std::floor(count) || count > static_cast<double>(most_cases))
      throw std::invalid_argument("--vary '" + text_ + "': found " + count_text +
                                  " values, expected 1 to " + std::to_string(most_cases));
    const auto n = static_cast<std::size_t>(count);
    std::vector<double> values(n, from);
    for (std::size_t i = 1; i < n; ++i) {
      const double part = static_cast<double>(i) / static_cast<double>(n - 1);
      values[i] = i + 1 == n ? to
                  : log      ? from * std::pow(to / from, part)
                             : from + (to - from) * part;
    }
    return values;
  }

  const std::string& text_;
};

/// Places of the watched columns; "P.x" finds "P.x [m]".
std::vector<std::size_t> columns_of(const SweepRequest& request,
                                    const std::vector<std::string>& columns) {
  std::vector<std::size_t> places;
  for (const std::string& name : request.watched) {
    const auto place = column_named(columns, name);
    if (!place) {
      std::string all;
      for (const std::string& c : columns) all += (all.empty() ? "" : ", ") + c;
      throw std::invalid_argument("--watch '" + name + "': no such column, expected one of " + all);
    }
    places.push_back(*place);
  }
  return places;
}

void watch(const RunResult& run, const std::vector<std::size_t>& columns, bool curves,
           SweepCase& result) {
  if (curves && !columns.empty())
    for (const auto& row : run.trajectory.rows) result.times.push_back(row.front());
  for (const std::size_t column : columns) {
    SweepCase::Watched w;
    if (curves) w.label = run.trajectory.columns[column];
    for (const auto& row : run.trajectory.rows) {
      const double x = row[column];
      if (curves) w.curve.push_back(x);
      w.last = x;
      if (!(x >= w.least)) w.least = x;
      if (!(x <= w.greatest)) w.greatest = x;
    }
    result.watched.push_back(w);
  }
}

void make(const SweepRequest& request, SweepCase& result) {
  std::vector<Setting> settings = request.fixed;
  for (std::size_t i = 0; i < request.varied.size(); ++i)
    for (const std::string& place : request.varied[i].places)
      settings.push_back({place, result.values[i]});
  Scene scene = parse_scene(request.text, request.file, settings);
  const Mechanism mechanism(std::move(scene), request.mechanism);
  const auto columns = columns_of(request, trajectory_columns(mechanism));
  const Assembly assembly = assemble(mechanism);
  RunRequest one;
  one.settings = request.settings(mechanism.scene().run);
  one.keep_trajectory = !columns.empty();
  one.max_cpu_seconds = request.max_cpu_seconds;
  one.progress = [&](double) { return !request.going_on || request.going_on(); };
  const RunResult run = run_form(mechanism, assembly.start, one);
  result.status = run.status;
  result.reason = run.reason.empty() ? run.departure : run.reason;
  result.stopped_at = run.stopped_at;
  result.drift_unit = run.drift_unit;
  result.position_drift_max = run.position_drift_max;
  result.angle_drift_max = run.angle_drift_max;
  result.angle_rate_drift_max = run.angle_rate_drift_max;
  result.velocity_drift_max = run.velocity_drift_max;
  result.energy_error_max = run.energy_error_max;
  result.steps = run.counters.steps;
  result.evaluations = run.counters.evaluations;
  watch(run, columns, request.sample != nullptr, result);
}

}  // namespace

Varied::Varied(const std::string& text) {
  VariedText(text).read(*this);
}

std::size_t SweepRequest::cases() const {
  std::set<std::string> seen;
  for (const Varied& v : varied)
    for (const std::string& place : v.places)
      if (!seen.insert(place).second)
        throw std::invalid_argument("--vary: '" + place + "' is varied twice, expected once");
  if (sample) return sample->cases();
  std::size_t count = 1;
  for (const Varied& v : varied) {
    if (v.values().empty())
      throw std::invalid_argument("--vary '" + v.place + "': " + v.distribution.words() +
                                  ", is a distribution: expected --sample random, latin or sobol, "
                                  "or values, PLACE=FROM:TO:COUNT say");
    if (v.values().size() > most_cases / count)
      throw std::invalid_argument("--vary: more than " + std::to_string(most_cases) +
                                  " combinations, expected fewer values");
    count *= v.values().size();
  }
  return count;
}

std::vector<double> SweepRequest::values(std::size_t number) const {
  std::vector<double> all(varied.size());
  if (sample) {
    for (std::size_t i = 0; i < varied.size(); ++i)
      all[i] = varied[i].distribution.quantile(sample->at(number, i));
    return all;
  }
  for (std::size_t i = varied.size(); i-- > 0;) {
    const auto& values = varied[i].values();
    all[i] = values[number % values.size()];
    number /= values.size();
  }
  return all;
}

SweepCase run_case(const SweepRequest& request, std::size_t number) {
  SweepCase result;
  result.values = request.values(number);
  const double from = thread_seconds();
  const auto refuse = [&](const std::string& reason) {
    result.status = "refused";
    result.reason = reason;
  };
  try {
    make(request, result);
  } catch (const std::bad_alloc&) {
    refuse("not enough memory for this case");
  } catch (const std::runtime_error& e) {
    refuse(e.what());
  }
  result.cpu_s = thread_seconds() - from;
  result.watched.resize(request.watched.size());
  return result;
}

}  // namespace momenta
