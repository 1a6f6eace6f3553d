#pragma once
#include <momenta/core/scene/scene.h>

#include <string>
#include <vector>

namespace momenta {

/// One row of Φ by name: what a rank report or a failure message calls it.
struct RowName {
  std::string loop;  ///< of the scene
  std::string what;  ///< "point along axis 1", "axis 3 against axis 1", "distance, driven"
};

/// Of all rows of a scene's loops, in their order.
std::vector<RowName> row_names(const Scene& scene, bool planar);

}  // namespace momenta
