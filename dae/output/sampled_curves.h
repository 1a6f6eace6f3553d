#pragma once
// Fewer points for a curve, with visible features kept.

#include <momenta/dae/run/picture.h>

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// Indices (ascending, at most `limit` ≥ 8) of the points to draw of y over t on a logarithmic t
/// axis: only t > 0 and finite y; all points if few; else of each of equal stretches of log t the
/// first, the smallest and the largest |y|, and the very last point. Not logarithmic: any t, equal
/// stretches of t, smallest and largest y.
std::vector<std::size_t> thinned(const std::vector<double>& t, const std::vector<double>& y,
                                 std::size_t limit, bool logarithmic = true);

// Curves through samples and films of sampled poses, for pages of poses and efforts.

/// Curves of one unit over the same samples.
struct SampledCurves {
  std::string key, title;  ///< title with the unit
  std::string x_title;     ///< empty: time
  std::string unit, file;  ///< file: place of curves that a page leaves out
  std::vector<std::pair<std::string, std::vector<double>>> curves;  ///< names, values
};

/// At most 24 curves over x (dae/output/page/timeline.js); no chart without curves.
void add_chart(nlohmann::ordered_json& charts, const std::vector<double>& x,
               const SampledCurves& sampled);

/// Poses q(i) at equal steps of ascending x, linear between samples.
Film film_of(const std::vector<double>& x,
             const std::function<const Eigen::VectorXd&(std::size_t)>& q, int intervals);

}  // namespace momenta
