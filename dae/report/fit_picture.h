#pragma once
// A fitted mechanism and the one before, moving on top of each other: one scene of both, with small
// balls where markers are wanted, and their poses at equal places of the swept coordinate, or
// times.

#include <momenta/dae/fit/identification.h>
#include <momenta/dae/study/picture.h>

#include <memory>

namespace momenta {

/// In front of the names of the one before, which pages draw pale and without names.
inline constexpr const char* before_mark = "before: ";

struct FitPicture {
  /// What moves: both, names of the one before after before_mark; the fitted one alone where the
  /// other cannot be assembled, or has equations that name coordinates. No forces, of a swept
  /// motion drives held.
  std::unique_ptr<Mechanism> mechanism;
  double first = 0;  ///< place of the swept coordinate at the first frame [rad or m], 0 of runs
  Film film;         ///< over its way from there [rad or m]
};

/// At most so many frames, half a turn to each side of the start where both come so far.
FitPicture fit_picture(const ParametricMechanism& family, const FitResult& result, int frames);

/// The runs of both, drives as they are, so many intervals over the time that was measured [s].
FitPicture identification_picture(const ParametricMechanism& family, const Identification& result,
                                  int frames);

}  // namespace momenta
