#pragma once
// Signs of runs on pages and figures: colour by form, marker by integrator, dash for other
// differences.

#include <momenta/dae/study/run_result.h>

#include <array>
#include <vector>

namespace momenta {

/// Colours of Okabe and Ito. "ink" is black, or white on dark ground; yellow, the last, needs an
/// outline on white.
inline constexpr std::array<const char*, 8> palette{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                    "ink",     "#e69f00", "#56b4e9", "#f0e442"};
inline constexpr int yellow = 7;

struct Sign {
  int colour = 0;            ///< place in the palette
  std::vector<double> dash;  ///< lengths of strokes and gaps [px]; empty: unbroken
  std::string marker = "circle";
};

/// Signs by run; rungs have that of their ladder.
std::vector<Sign> signs_of(const StudyResult&);

/// Sign of the i-th of like curves: colours in turn, then the same with dashes.
Sign sign_in_turn(std::size_t i);

}  // namespace momenta
