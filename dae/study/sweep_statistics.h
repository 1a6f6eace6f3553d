#pragma once
// Statistics of a sweep's cases: of each quantity mean, deviation, quantiles and, with a sample
// made for them, Sobol' indices; of each watched column the same statistics at each time.
//
// Cases that are not done are left out: a quantity has as many values as done cases measured it.
// Times are those of the first case that is done; cases with others (a varied end time, say) are
// not in the curves.

#include <momenta/dae/analysis/sample/sensitivity.h>
#include <momenta/dae/analysis/sample/statistics.h>
#include <momenta/dae/study/sweep_study.h>

namespace momenta {

/// A measure of a case, by its name and as tables head it.
struct SweepMeasure {
  std::string name, heading;
  double (*of)(const SweepCase&);
};
/// Drifts and energy error.
const std::vector<SweepMeasure>& sweep_measures();

struct SweepQuantity {
  std::string name;            ///< column of sweep.csv without its unit: "B.y last"
  std::vector<double> values;  ///< by case; NaN: not done or not measured
};
/// Measures that any case has, then last, least and greatest of each watched column.
std::vector<SweepQuantity> sweep_quantities(const SweepRequest&, const std::vector<SweepCase>&);

struct QuantityStatistics {
  std::string name;
  Summary summary;
  SobolIndices indices;  ///< `of` is empty without a sample made for them
};

/// A watched column along time.
struct SweepCurve {
  std::string name, label;  ///< as asked for, and with its unit
  std::vector<double> times;
  std::vector<Summary> at;  ///< by time
  std::size_t others = 0;   ///< cases that are done, at other times
};

struct SweepStatistics {
  std::vector<QuantityStatistics> quantities;
  std::vector<SweepCurve> curves;  ///< with a sample only
};

/// Cost: a sort of each quantity and each curve at each time; 500 resamples of the indices.
SweepStatistics sweep_statistics(const SweepRequest&, const std::vector<SweepCase>&);

}  // namespace momenta
