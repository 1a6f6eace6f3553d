#include <momenta/dae/solver/extrapolation.h>
#include <momenta/dae/study/own_reference.h>
#include <momenta/dae/study/quad_motion.h>
#include <momenta/dae/study/run_form.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace momenta {
namespace {

using Rows = std::vector<std::vector<double>>;

constexpr double tight = 1e-22, loose = 1e-18;
/// Prescribed motion is a function of t, and t is a double: nothing is to be had below its
/// rounding.
constexpr double tight_in_time = 1e-14, loose_in_time = 1e-12;
constexpr double shortest = 1e-9;  ///< step, of the interval

[[noreturn]] void give_up(double t, const std::string& why) {
  char text[48];
  std::snprintf(text, sizeof text, "%.6g", t);
  throw std::runtime_error("the reference in quadruple precision ends at t = " + std::string(text) +
                           " s: " + why);
}

/// q and u at t = 0, end / count, …: as long a step as converges, never across an output.
Rows solve(const Mechanism& mechanism, const Start& start, double end, int count, double tolerance,
           const std::function<bool(double)>& going_on) {
  const auto motion = make_quad_motion(mechanism);
  const auto size = static_cast<std::size_t>(mechanism.nq() + mechanism.nv());
  std::vector<Quad> y(start.q.begin(), start.q.end());
  y.insert(y.end(), start.u.begin(), start.u.end());
  Extrapolation<Quad> method(size);
  Rows rows;
  const auto keep = [&] {
    rows.emplace_back(size);
    std::transform(y.begin(), y.end(), rows.back().begin(),
                   [](const Quad& x) { return value_of(x); });
  };
  const double interval = end / count;
  double t = start.t, h = interval;
  if (!motion->project(t, y.data())) give_up(t, "a joint has no inertia");
  keep();
  for (int i = 1; i <= count; ++i) {
    const double next = i == count ? end : interval * i;
    while (t < next) {
      const bool reaches = t + h >= next * (1 - 1e-14);
      const double step = reaches ? next - t : h;
      if (method.step(t, step, y, tolerance, [&](double at, const Quad* x, Quad* rate) {
            return motion->rates(at, x, rate);
          })) {
        t = reaches ? next : t + step;
        if (!motion->project(t, y.data())) give_up(t, "the projection failed");
        h = std::min(2 * step, interval);
      } else {
        h = step / 2;
        if (h < shortest * interval) give_up(t, "no step is short enough for it");
      }
      if (going_on && !going_on(t)) give_up(t, "interrupted");
    }
    keep();
  }
  return rows;
}

}  // namespace

OwnReference own_reference(const Mechanism& mechanism, const Start& start, double end, int count,
                           const std::function<bool(double)>& going_on) {
  std::vector<double> times;
  for (int i = 0; i <= count; ++i) times.push_back(i == count ? end : end / count * i);
  std::vector<std::string> columns;
  for (const auto& c : mechanism.coordinate_columns()) columns.push_back(c.label());
  for (const auto& c : mechanism.rate_columns()) columns.push_back(c.label());
  const bool in_time = mechanism.plan().drives;
  const Rows rows = solve(mechanism, start, end, count, in_time ? tight_in_time : tight, going_on),
             check = solve(mechanism, start, end, count, in_time ? loose_in_time : loose, going_on);
  OwnReference own{Reference("quadruple precision", columns, times, rows), 0};
  std::vector<std::string> bound{"t [s]"};
  bound.insert(bound.end(), columns.begin(), columns.end());
  own.reference.bind(bound);
  for (std::size_t i = 0; i < check.size(); ++i) {
    std::vector<double> row{times[i]};
    row.insert(row.end(), check[i].begin(), check[i].end());
    own.accuracy = std::max(own.accuracy, own.reference.error(i, row).position);
  }
  own.reference.bind(trajectory_columns(mechanism));
  return own;
}

}  // namespace momenta
