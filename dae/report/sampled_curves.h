#pragma once
// Curves through samples and films of sampled poses, as pages of poses and of efforts have them.

#include <momenta/dae/study/picture.h>

#include <Eigen/Core>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// Curves of one unit over the same samples.
struct SampledCurves {
  std::string key, title;  ///< the title has the unit in it
  std::string x_title;     ///< empty: time
  std::string unit, file;  ///< file: where curves stand that a page leaves out
  std::vector<std::pair<std::string, std::vector<double>>> curves;  ///< names, values
};

/// Adds a chart (dae/report/page/timeline.js) of those curves over x; none where there are none. A
/// page holds 24.
void add_chart(nlohmann::ordered_json& charts, const std::vector<double>& x,
               const SampledCurves& sampled);

/// The poses q(i) of ascending x at equal steps of x, so many intervals, straight between them.
Film film_of(const std::vector<double>& x,
             const std::function<const Eigen::VectorXd&(std::size_t)>& q, int intervals);

}  // namespace momenta
