#pragma once
// The sweep study: numbers of a scene are varied, with a run for each combination of values, or for
// each point of a sample of their distributions.
//
// Cases are numbered from 0; of combinations the last varied number changes fastest. A case depends
// on its number alone, so threads, processes and continued studies give the same results.

#include <momenta/core/format/toml/setting.h>
#include <momenta/dae/analysis/sample/distribution.h>
#include <momenta/dae/analysis/sample/sample.h>
#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/run/run_form.h>

#include <cstddef>
#include <memory>

namespace momenta {

/// One number of the scene, or several together, and the values.
struct Varied {
  std::string place;                ///< as written: with commas between several
  std::vector<std::string> places;  ///< as in Setting: all of them have the value
  Distribution distribution;
  /// Values of a choice, each once in combinations; empty for other distributions.
  const std::vector<double>& values() const { return distribution.values; }

  /// "PLACE=FROM:TO:COUNT", evenly spaced; "PLACE=FROM:TO:COUNT:log", evenly in the logarithm;
  /// "PLACE=A,B,…"; for samples also "PLACE=FROM:TO", "PLACE=FROM:TO:log" and
  /// "PLACE=normal:MEAN:DEVIATION". PLACE,PLACE: both have the value; a comma within a name is
  /// written \\,. @throws std::invalid_argument, one sentence.
  explicit Varied(const std::string& text);
};

struct SweepRequest {
  std::string text, file;  ///< the scene, and what messages call it
  MechanismOptions mechanism;
  std::vector<Varied> varied;
  std::shared_ptr<const Sample> sample;  ///< a quantity per varied number; null: combinations
  std::vector<Setting> fixed;            ///< numbers that are the same in all cases
  /// Settings of a case's run, from its scene's defaults.
  std::function<RunSettings(const RunDefaults&)> settings;
  std::vector<std::string> watched;  ///< columns of the trajectory: "P.x", with the unit or without
  double max_cpu_seconds = 0;        ///< per case; 0: none
  std::function<bool()> going_on;    ///< false stops cases under way

  /// Number of cases. @throws std::invalid_argument beyond 10 million, for a place varied twice,
  /// and for a distribution without a sample.
  std::size_t cases() const;
  std::vector<double> values(std::size_t number) const;
};

/// Result of one case.
struct SweepCase {
  std::vector<double> values;   ///< varied numbers
  std::string status = "done";  ///< done, failed, time limit; refused: there is no such mechanism
  std::string reason;           ///< one sentence when not done, or not to be relied on
  double stopped_at = 0;        ///< [s]
  std::string drift_unit;       ///< this and the drifts as in RunResult
  double position_drift_max = not_measured, velocity_drift_max = not_measured,
         angle_drift_max = not_measured, angle_rate_drift_max = not_measured,
         energy_error_max = not_measured;
  long steps = 0, evaluations = 0;
  std::vector<double> times;  ///< with a sample and watched columns [s]
  struct Watched {
    double last = not_measured, least = not_measured, greatest = not_measured;
    std::string label;          ///< with a sample: column with its unit
    std::vector<double> curve;  ///< at `times`
  };
  std::vector<Watched> watched;
  double cpu_s = not_measured;  ///< loading, assembling and running
};

/// Runs one case; its faults are in the result. @throws std::invalid_argument for faults of all
/// cases: a place that the scene does not have, a column that no trajectory has.
SweepCase run_case(const SweepRequest& request, std::size_t number);

}  // namespace momenta
