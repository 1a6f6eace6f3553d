#pragma once
// Common parts of `fit` for wanted poses, measured motions and formulas to minimise.

#include <momenta/dae/report/fit_picture.h>

#include <functional>
#include <string>
#include <vector>

#include "options.h"
#include "progress.h"

namespace momenta::program {

struct FitOptions {
  std::string vary;   ///< NAME=FROM:TO, comma-separated
  std::string sweep;  ///< a coordinate; empty: a run
  /// Wanted poses, or without `sweep` a measured motion; empty: wanted.csv or measured.csv beside
  /// the scene.
  std::filesystem::path to;
  std::string least;              ///< a formula of the motion; empty: none
  std::vector<std::string> keep;  ///< conditions
  std::string over;               ///< FROM:TO of the swept coordinate; empty: a turn
  std::optional<int> poses;
  std::optional<double> rate;
  int starts = 1, iterations = 500;
  std::uint64_t seed = 1;
};

SweptWay way_of(const FitOptions& options);
/// The scene's text for runs, integrated as it is written.
SceneText run_text(const Options& o);
/// `fit` with a measured motion.
int identify_verb(const Options& o, const FitOptions& options,
                  std::vector<FittedParameter> parameters, const ParametricMechanism& family);
/// `fit --least`
int least_verb(const Options& o, const FitOptions& options, std::vector<FittedParameter> parameters,
               const ParametricMechanism& family);

/// Shows the start under way and the least value so far, as `what`; false at an interruption or
/// --cpu-limit. Both references must outlive it.
std::function<bool(int, double)> search_progress(const Options& o, ProgressLine& line, int starts,
                                                 const std::string& what);

/// The page's study: the mechanism found and the one before, in `frames` frames. `name`: of the
/// scene.
StudyResult shown_search(const Options& o, const FitPicture& picture, int frames,
                         const std::string& name);

}  // namespace momenta::program
