#include <momenta/dae/study/sweep_statistics.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

/// Statistics take the rows of A and B; those of A_B^(i) repeat their values.
bool of_statistics(const SweepRequest& request, std::size_t number) {
  return !request.sample || !request.sample->settings().indices ||
         number % request.sample->cases_of_a_point() < 2;
}

std::vector<double> of_statistics(const SweepRequest& request, const std::vector<double>& values) {
  std::vector<double> kept;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (of_statistics(request, i)) kept.push_back(values[i]);
  return kept;
}

SweepCurve curve_of(const SweepRequest& request, const std::vector<SweepCase>& cases,
                    std::size_t column) {
  SweepCurve curve;
  curve.name = request.watched[column];
  std::vector<const SweepCase*> together;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const SweepCase& c = cases[i];
    if (c.status != "done" || !of_statistics(request, i)) continue;
    if (together.empty()) {
      curve.times = c.times;
      curve.label = c.watched[column].label;
    }
    if (c.times == curve.times)
      together.push_back(&c);
    else
      ++curve.others;
  }
  for (std::size_t k = 0; k < curve.times.size(); ++k) {
    std::vector<double> values;
    for (const SweepCase* c : together) values.push_back(c->watched[column].curve[k]);
    curve.at.push_back(summary_of(std::move(values)));
  }
  return curve;
}

}  // namespace

const std::vector<SweepMeasure>& sweep_measures() {
  static const std::vector<SweepMeasure> all{
      {"position_drift_max", "|Φ| [m]", [](const SweepCase& c) { return c.position_drift_max; }},
      {"velocity_drift_max", "|Φ̇| [m/s]", [](const SweepCase& c) { return c.velocity_drift_max; }},
      {"angle_drift_max", "|Φ| [rad]", [](const SweepCase& c) { return c.angle_drift_max; }},
      {"angle_rate_drift_max", "|Φ̇| [rad/s]",
       [](const SweepCase& c) { return c.angle_rate_drift_max; }},
      {"energy_error_max", "energy [J]", [](const SweepCase& c) { return c.energy_error_max; }}};
  return all;
}

std::vector<SweepQuantity> sweep_quantities(const SweepRequest& request,
                                            const std::vector<SweepCase>& cases) {
  std::vector<SweepQuantity> all;
  const auto add = [&](const std::string& name, auto&& of) {
    SweepQuantity quantity{name, {}};
    for (const SweepCase& c : cases)
      quantity.values.push_back(c.status == "done" ? of(c) : not_measured);
    all.push_back(std::move(quantity));
  };
  for (const SweepMeasure& measure : sweep_measures()) {
    add(measure.name, measure.of);
    const auto& values = all.back().values;
    if (std::none_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); }))
      all.pop_back();
  }
  for (std::size_t i = 0; i < request.watched.size(); ++i) {
    const std::string& name = request.watched[i];
    add(name + " last", [i](const SweepCase& c) { return c.watched[i].last; });
    add(name + " least", [i](const SweepCase& c) { return c.watched[i].least; });
    add(name + " greatest", [i](const SweepCase& c) { return c.watched[i].greatest; });
  }
  return all;
}

SweepStatistics sweep_statistics(const SweepRequest& request, const std::vector<SweepCase>& cases) {
  SweepStatistics found;
  for (const SweepQuantity& quantity : sweep_quantities(request, cases)) {
    found.quantities.push_back(
        {quantity.name, summary_of(of_statistics(request, quantity.values)), {}});
    if (request.sample && request.sample->settings().indices)
      found.quantities.back().indices =
          sobol_indices(quantity.values, request.varied.size(), request.sample->settings().seed);
  }
  if (request.sample)
    for (std::size_t i = 0; i < request.watched.size(); ++i)
      found.curves.push_back(curve_of(request, cases, i));
  return found;
}

}  // namespace momenta
