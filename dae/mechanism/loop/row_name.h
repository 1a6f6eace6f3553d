#pragma once
#include <momenta/core/scene/scene.h>

#include <string>
#include <vector>

namespace momenta {

/// The name of one row of Φ, for rank reports and messages.
struct RowName {
  std::string loop;  ///< name in the scene
  std::string what;  ///< "point along axis 1", "axis 3 against axis 1", "distance, driven"
};

/// The names of all rows of a scene's loops, in the order of Φ.
std::vector<RowName> row_names(const Scene& scene, bool planar);

}  // namespace momenta
