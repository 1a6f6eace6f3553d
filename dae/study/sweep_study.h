#pragma once
// The sweep study: some numbers of a scene are varied, with one run for each combination of values,
// or one for each point of a sample of their distributions.
//
// Cases are numbered from 0; of combinations the last varied number changes fastest. A case depends
// on its number alone, so threads, processes and continued studies give the same results.

#include <momenta/core/scene/toml/setting.h>
#include <momenta/dae/mechanism.h>
#include <momenta/dae/sample/distribution.h>
#include <momenta/dae/sample/sample.h>
#include <momenta/dae/study/run_form.h>

#include <cstddef>
#include <memory>

namespace momenta {

/// One number of the scene, or several that move together, and the values it takes.
struct Varied {
  std::string place;                ///< as written: with commas between several
  std::vector<std::string> places;  ///< as in Setting: all of them have the value
  Distribution distribution;
  /// Of a choice, each of them once in combinations; empty of what can be sampled alone.
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
  std::shared_ptr<const Sample>
      sample;                  ///< of as many quantities as are varied; null: combinations
  std::vector<Setting> fixed;  ///< numbers of the scene that are the same in all cases
  /// The run of a case, from what its scene asks for.
  std::function<RunSettings(const RunDefaults&)> settings;
  std::vector<std::string> watched;  ///< columns of the trajectory: "P.x", with the unit or without
  double max_cpu_seconds = 0;        ///< of a case; 0: none
  std::function<bool()> going_on;    ///< false stops cases under way

  /// How many cases there are. @throws std::invalid_argument beyond 10 million, of a place that is
  /// varied twice, and of a distribution without a sample.
  std::size_t cases() const;
  std::vector<double> values(std::size_t number) const;
};

/// What came of one case.
struct SweepCase {
  std::vector<double> values;   ///< of the varied numbers
  std::string status = "done";  ///< done, failed, time limit; refused: there is no such mechanism
  std::string reason;           ///< one sentence when not done, or not to be relied on
  double stopped_at = 0;        ///< [s]
  std::string drift_unit;       ///< and the drifts: as of RunResult
  double position_drift_max = not_measured, velocity_drift_max = not_measured,
         angle_drift_max = not_measured, angle_rate_drift_max = not_measured,
         energy_error_max = not_measured;
  long steps = 0, evaluations = 0;
  std::vector<double> times;  ///< of a sample, where columns are watched: when [s]
  struct Watched {
    double last = not_measured, least = not_measured, greatest = not_measured;
    std::string label;          ///< of a sample: the column with its unit
    std::vector<double> curve;  ///< at `times`
  };
  std::vector<Watched> watched;
  double cpu_s = not_measured;  ///< loading, assembling and running
};

/// One case from beginning to end. Whatever is wrong with it is in the result. @throws
/// std::invalid_argument for what is wrong with all of them: a place that the scene does not have,
/// a column that no trajectory has.
SweepCase run_case(const SweepRequest& request, std::size_t number);

}  // namespace momenta
