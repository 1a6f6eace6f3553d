#pragma once
// The name of a run in a table, a sentence or at a curve: as short as is unique in its study.

#include <momenta/dae/run/run_result.h>

#include <array>
#include <string>
#include <vector>

namespace momenta {

/// One label a run: the form, then settings (integrator, gauge, tolerance or step, projection, way
/// of solving (7)) in which runs of that form differ: "momentum", "momentum, dop853, leak:10",
/// "acceleration, 1e-6". Without the tolerance: name of a ladder.
std::vector<std::string> run_labels(const StudyResult&, bool with_tolerance = true);

/// "1e-8" where rtol = atol, else "1e-8/1e-10"; "h = 0.005 s" for a fixed step.
std::string tolerance_text(const RunSettings&);

/// Drawn runs: all of a drift study; the first rung of each ladder. Indices into StudyResult::runs,
/// ascending.
std::vector<std::size_t> runs_with_curves(const StudyResult&);

/// First run of each run's ladder, with the same form, integrator, gauge and projection.
std::vector<std::size_t> ladders(const StudyResult&);

// Signs of runs on pages and figures: colour by form, marker by integrator, dash for other
// differences.

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
