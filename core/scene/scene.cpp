#include <momenta/core/scene/near_name.h>
#include <momenta/core/scene/scene.h>
#include <momenta/core/user_joint.h>

#include <cmath>

namespace momenta {

std::string Scene::where(Location at) const {
  std::string prefix = file.empty() ? std::string("scene") : reading::on_one_line(file);
  if (at.line > 0) prefix += ":" + std::to_string(at.line) + ":" + std::to_string(at.column);
  return prefix + ": ";
}

int coordinates_of(const JointSpec& joint) {
  return joint.kind == JointKind::user ? (joint.law ? joint.law->coordinates() : 0)
                                       : coordinates_of(joint.kind);
}
int rates_of(const JointSpec& joint) {
  return joint.kind == JointKind::user ? coordinates_of(joint) : rates_of(joint.kind);
}

Eigen::Vector3d perpendicular_to(const Eigen::Vector3d& axis) {
  constexpr double tie = 1e-9;  // so that rounding does not choose
  const Eigen::Vector3d a = axis.normalized();
  int nearest = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(a[i]) > std::abs(a[nearest]) + tie) nearest = i;
  const Eigen::Vector3d next = Eigen::Vector3d::Unit((nearest + 1) % 3);
  return (next - next.dot(a) * a).normalized();
}

}  // namespace momenta
