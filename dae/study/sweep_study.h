#pragma once
// The sweep study: some numbers of a scene are varied, with one run for each combination of values.
//
// Cases are numbered from 0; the last varied number changes fastest. A case depends on its number
// alone, so threads, processes and continued studies give the same results.

#include <momenta/core/scene/toml/setting.h>
#include <momenta/dae/mechanism.h>
#include <momenta/dae/study/run_form.h>

#include <cstddef>

namespace momenta {

/// One number of the scene and the values it takes.
struct Varied {
  std::string place;  ///< as in Setting
  std::vector<double> values;

  /// "PLACE=FROM:TO:COUNT", evenly spaced; "PLACE=FROM:TO:COUNT:log", evenly in the logarithm;
  /// "PLACE=A,B,…". @throws std::invalid_argument, one sentence.
  explicit Varied(const std::string& text);
};

struct SweepRequest {
  std::string text, file;  ///< the scene, and what messages call it
  MechanismOptions mechanism;
  std::vector<Varied> varied;
  std::vector<Setting> fixed;  ///< numbers of the scene that are the same in all cases
  /// The run of a case, from what its scene asks for.
  std::function<RunSettings(const RunDefaults&)> settings;
  std::vector<std::string> watched;  ///< columns of the trajectory: "P.x", with the unit or without
  double max_cpu_seconds = 0;        ///< of a case; 0: none
  std::function<bool()> going_on;    ///< false stops cases under way

  /// How many cases there are. @throws std::invalid_argument beyond 10 million.
  std::size_t cases() const;
  std::vector<double> values(std::size_t number) const;
};

/// What came of one case.
struct SweepCase {
  std::vector<double> values;   ///< of the varied numbers
  std::string status = "done";  ///< done, failed, time limit; refused: there is no such mechanism
  std::string reason;           ///< one sentence when not done
  double stopped_at = 0;        ///< [s]
  std::string drift_unit;       ///< and the drifts: as of RunResult
  double position_drift_max = not_measured, velocity_drift_max = not_measured,
         angle_drift_max = not_measured, angle_rate_drift_max = not_measured,
         energy_error_max = not_measured;
  long steps = 0, evaluations = 0;
  struct Watched {
    double last = not_measured, least = not_measured, greatest = not_measured;
  };
  std::vector<Watched> watched;
  double cpu_s = not_measured;  ///< loading, assembling and running
};

/// One case from beginning to end. Whatever is wrong with it is in the result. @throws
/// std::invalid_argument for what is wrong with all of them: a place that the scene does not have,
/// a column that no trajectory has.
SweepCase run_case(const SweepRequest& request, std::size_t number);

}  // namespace momenta
