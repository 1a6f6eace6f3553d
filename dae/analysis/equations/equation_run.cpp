#include <momenta/dae/analysis/equations/equation_run.h>
#include <momenta/dae/analysis/equations/switched_run.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <stdexcept>

namespace momenta {

std::string integrator_for(const EquationFile& file, const EquationStart& start) {
  if (!file.integrator.empty()) return file.integrator;
  return start.point.found.index <= 1 ? "ida" : "radau5";
}

int largest_index(std::string_view integrator) {
  return integrator == "ida" ? 2 : 3;
}

EquationRun run_equations(const EquationFile& file, const EquationStart& start,
                          const EquationRunRequest& request) {
  if (request.integrator != "ida" && request.integrator != "radau5")
    throw std::invalid_argument("integrator '" + request.integrator +
                                "' takes mechanisms, expected ida or radau5 for equations");
  const int index = start.point.found.index, most = largest_index(request.integrator);
  if (index > most)
    throw std::invalid_argument(
        file.where({}) + request.integrator + " takes equations of index up to " +
        std::to_string(most) + ", found index " + std::to_string(index) +
        (index == 3 ? ", expected --integrator radau5" : ", expected equations of a lower index"));
  EquationRun run;
  run.integrator = request.integrator;
  run.rtol = request.rtol, run.atol = request.atol;
  run.step = request.integrator == "radau5" ? request.step : 0;
  run.end = request.end;
  run.start = file.start;
  const std::clock_t before = std::clock();
  if (request.step > 0 || !SwitchedRun(file, request).run(start, run))
    integrate_piece(file, start, request, {}, 0, run);
  run.cpu_s = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
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
