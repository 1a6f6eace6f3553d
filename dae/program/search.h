#pragma once
// What `fit` does alike for wanted poses and for a formula that is to be least.

#include <momenta/dae/report/fit_picture.h>

#include <functional>
#include <string>
#include <vector>

#include "answers.h"
#include "progress_line.h"

namespace momenta::program {

/// The way that is asked for.
SweptWay way_of(const FitOptions& options);
/// `fit --least`
int least_verb(const Options& o, const FitOptions& options, std::vector<FittedParameter> parameters,
               const ParametricMechanism& family);

/// Shows the start under way and the least so far, as `what`; false at an interruption, or beyond
/// --cpu-limit. Both references must outlive it.
std::function<bool(int, double)> search_progress(const Options& o, ProgressLine& line, int starts,
                                                 const std::string& what);

/// What the page shows: the mechanism found and the one before. `first` as of FitPicture.
struct ShownSearch {
  StudyResult study;
  double first = 0;
};
/// Of `found`, its parameters, swept coordinate, wanted poses and places are taken.
ShownSearch shown_search(const Options& o, const ParametricMechanism& family,
                         const FitResult& found);

}  // namespace momenta::program
