#pragma once
// A fitted mechanism and the one before, moving on top of each other: one scene of both, with small
// balls at wanted places of markers, and their poses at equal places of the swept coordinate, or
// times.

#include <momenta/dae/run/picture.h>
#include <momenta/dae/study/fit/identification.h>

#include <memory>

namespace momenta {

/// Prefix of names of the mechanism before, which pages draw pale and without names.
inline constexpr const char* before_mark = "before: ";

struct FitPicture {
  /// Both mechanisms, names of the one before after before_mark; the fitted one alone where the
  /// other cannot be assembled, or has equations that name coordinates. Without forces; drives are
  /// held in a swept motion.
  std::unique_ptr<Mechanism> mechanism;
  double first = 0;  ///< place of the first frame [rad or m]; 0 for runs
  Film film;         ///< over the way from there [rad or m]
};

/// At most `frames`, half a turn to each side of the start where both reach it.
FitPicture fit_picture(const ParametricMechanism& family, const FitResult& result, int frames);

/// Runs of both, with drives, in `frames` intervals over the measured time [s].
FitPicture identification_picture(const ParametricMechanism& family, const Identification& result,
                                  int frames);

}  // namespace momenta
