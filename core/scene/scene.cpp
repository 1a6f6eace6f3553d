#include <momenta/core/scene/near_name.h>
#include <momenta/core/scene/scene.h>

namespace momenta {

std::string Scene::where(Location at) const {
  std::string prefix = file.empty() ? std::string("scene") : reading::on_one_line(file);
  if (at.line > 0) prefix += ":" + std::to_string(at.line) + ":" + std::to_string(at.column);
  return prefix + ": ";
}

}  // namespace momenta
