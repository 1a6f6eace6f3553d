#pragma once
// Runs of a file of equations, and how far their ends are from a reference.

#include <momenta/dae/analysis/equations/equation_start.h>
#include <momenta/dae/integrator/integration.h>

#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace momenta {

struct EquationRunRequest {
  std::string integrator;           ///< ida or radau5
  double rtol = 1e-6, atol = 1e-6;  ///< atol times the scale of each variable
  double step = 0;                  ///< radau5: > 0 for steps of this length without error control
  double end = 1;
  int samples = 1;                         ///< output intervals
  double max_cpu_seconds = 0;              ///< 0: none
  std::function<bool(double t)> going_on;  ///< may be empty; false stops the run
};

struct EquationRun {
  std::string integrator;
  double rtol = 0, atol = 0, step = 0, start = 0, end = 0;
  bool done = false;
  std::string reason;  ///< one sentence unless done
  double stopped_at = 0;
  Counters counters;
  int switchings = 0;  ///< events of switches in formulas, at which the run began anew
  std::string linear_solver;
  double cpu_s = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> t;               ///< output times
  std::vector<std::vector<double>> y;  ///< y[k] at t[k]
  std::vector<double> last;            ///< y where the run ended

  /// Output time k of `samples` intervals.
  double output_time(int k, int samples) const {
    return k == samples ? end : start + (end - start) * k / samples;
  }
};

/// "ida" up to index 1, else "radau5"; the file's own where it names one.
std::string integrator_for(const EquationFile& file, const EquationStart& start);

/// Of equations that it takes: 2 for ida, 3 for radau5.
int largest_index(std::string_view integrator);

/// @throws std::invalid_argument where the integrator does not take the index
EquationRun run_equations(const EquationFile& file, const EquationStart& start,
                          const EquationRunRequest& request);

/// Correct digits of the end of a run, over the variables that are judged:
struct Digits {
  double scd;    ///< −log₁₀ max |y − ref| / |ref|, significant correct digits
  double mescd;  ///< −log₁₀ max |y − ref| / (atol/rtol · scale + |ref|), mixed
};
/// As the IVP test set defines them. NaN where the run is not done; at most 17.
Digits digits_of(const EquationRun& run, const EquationFile& file,
                 const std::vector<double>& reference, const std::vector<char>& judged);

}  // namespace momenta
