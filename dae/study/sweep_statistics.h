#pragma once
// What the cases of a sweep say together: of each quantity mean, deviation and quantiles, and, of a
// sample made for them, Sobol' indices; of each watched column the same statistics at each time.
//
// Cases that are not done are no part of it: a quantity has as many values as cases are done and
// measured it. Times are those of the first case that is done; a case with others (its end time is
// varied, say) has no part in the curves.

#include <momenta/dae/sample/sensitivity.h>
#include <momenta/dae/sample/statistics.h>
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
  std::string name;            ///< of its column in sweep.csv, without the unit: "B.y last"
  std::vector<double> values;  ///< one a case; NaN where it is not done or nothing was measured
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
  std::vector<Summary> at;  ///< one a time
  std::size_t others = 0;   ///< cases that are done, at other times
};

struct SweepStatistics {
  std::vector<QuantityStatistics> quantities;
  std::vector<SweepCurve> curves;  ///< of a sample
};

/// Cost: a sort of each quantity, and of each curve at each time; 500 resamples of the indices.
SweepStatistics sweep_statistics(const SweepRequest&, const std::vector<SweepCase>&);

}  // namespace momenta
