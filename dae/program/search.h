#pragma once
// What `fit` does alike for wanted poses, for a measured motion and for a formula that is to be
// least.

#include <momenta/dae/report/fit_picture.h>

#include <functional>
#include <string>
#include <vector>

#include "answers.h"
#include "progress_line.h"

namespace momenta::program {

/// The way that is asked for.
SweptWay way_of(const FitOptions& options);
/// The scene as text, of runs: integrated as it is written.
SceneText run_text(const Options& o);
/// `fit` with a measured motion.
int identify_verb(const Options& o, const FitOptions& options,
                  std::vector<FittedParameter> parameters, const ParametricMechanism& family);
/// `fit --least`
int least_verb(const Options& o, const FitOptions& options, std::vector<FittedParameter> parameters,
               const ParametricMechanism& family);

/// Shows the start under way and the least so far, as `what`; false at an interruption, or beyond
/// --cpu-limit. Both references must outlive it.
std::function<bool(int, double)> search_progress(const Options& o, ProgressLine& line, int starts,
                                                 const std::string& what);

/// What the page shows: the mechanism found and the one before, `frames` of them. `name`: of the
/// scene.
StudyResult shown_search(const Options& o, const FitPicture& picture, int frames,
                         const std::string& name);

}  // namespace momenta::program
