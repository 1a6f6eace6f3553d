#pragma once
// Which sign stands for which run: colour for the form, marker for the integrator, dash for what
// still differs. Pages and figures take it from here.

#include <momenta/dae/study/run_result.h>

#include <array>
#include <vector>

namespace momenta {

/// The eight colours of Okabe and Ito. "ink" is black, on dark ground white; the last, yellow,
/// needs an outline on white.
inline constexpr std::array<const char*, 8> palette{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                    "ink",     "#e69f00", "#56b4e9", "#f0e442"};
inline constexpr int yellow = 7;

struct Sign {
  int colour = 0;            ///< place in the palette
  std::vector<double> dash;  ///< lengths of strokes and gaps [px]; empty: an unbroken line
  std::string marker = "circle";
};

/// One for each run; the rungs of a ladder have the one of their ladder.
std::vector<Sign> signs_of(const StudyResult&);

/// Of the i-th of several like curves: the colours in turn, then the same with dashes.
Sign sign_in_turn(std::size_t i);

}  // namespace momenta
