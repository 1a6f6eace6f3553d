#include <momenta/dae/equations/equation_run.h>
#include <momenta/dae/equations/equation_system.h>
#include <momenta/dae/solver/integrators.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <stdexcept>

namespace momenta {

std::string integrator_for(const EquationFile& file, const EquationStart& start) {
  if (!file.integrator.empty()) return file.integrator;
  return start.point.found.index <= 1 ? "ida" : "radau5";
}

EquationRun run_equations(const EquationFile& file, const EquationStart& start,
                          const EquationRunRequest& request) {
  if (request.integrator != "ida" && request.integrator != "radau5")
    throw std::invalid_argument("integrator '" + request.integrator +
                                "' takes mechanisms, expected ida or radau5 for equations");
  const int index = start.point.found.index, most = request.integrator == "ida" ? 2 : 3;
  if (index > most)
    throw std::invalid_argument(
        file.where({}) + request.integrator + " takes equations of index up to " +
        std::to_string(most) + ", found index " + std::to_string(index) +
        (index == 3 ? ", expected --integrator radau5" : ", expected equations of a lower index"));
  EquationSystem system(file, start);
  IntegrationOptions options;
  options.rtol = request.rtol;
  options.atol = request.atol;
  options.step = request.step;
  options.max_cpu_seconds = request.max_cpu_seconds;
  EquationRun run;
  run.integrator = request.integrator;
  run.rtol = request.rtol, run.atol = request.atol;
  run.step = request.integrator == "radau5" ? request.step : 0;
  run.end = request.end;
  std::vector<double> times;
  for (int k = 0; k <= request.samples; ++k)
    times.push_back(k == request.samples
                        ? request.end
                        : file.start + (request.end - file.start) * k / request.samples);
  Observer observer;
  observer.sample = [&](double t, const double* y, const double*) {
    run.t.push_back(t);
    run.y.emplace_back(y, y + file.size());
    return true;
  };
  bool interrupted = false;
  if (request.going_on)
    observer.step = [&](double, double t, const Interpolant&) {
      interrupted = !request.going_on(t);
      return !interrupted;
    };
  const std::clock_t before = std::clock();
  IntegrationResult result =
      integrate(request.integrator, system, file.start, times, options, observer);
  run.cpu_s = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  run.done = result.done;
  run.reason = interrupted ? "interrupted" : result.reason;
  run.stopped_at = result.end_time;
  run.counters = result.counters;
  run.linear_solver = result.linear_solver;
  run.last = std::move(result.y);
  for (const double y : run.last)
    if (run.done && !std::isfinite(y)) {
      run.done = false;
      run.reason = "a value at the end is not a finite number";
    }
  return run;
}

Digits digits_of(const EquationRun& run, const EquationFile& file,
                 const std::vector<double>& reference, const std::vector<char>& judged) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), most = 17;
  if (!run.done) return {nan, nan};
  double relative = 0, mixed = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    if (!judged[i]) continue;
    const double error = std::abs(run.last[i] - reference[i]);
    const double size = std::abs(reference[i]);
    relative = std::max(relative, error == 0 ? 0 : error / size);
    mixed = std::max(mixed, error == 0 ? 0 : error / (run.atol / run.rtol * file.scales[i] + size));
  }
  const auto digits = [&](double x) { return x > 0 ? std::min(-std::log10(x), most) : most; };
  return {digits(relative), digits(mixed)};
}

}  // namespace momenta
