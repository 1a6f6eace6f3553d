#include <momenta/dae/cut/merged_body.h>

namespace momenta {

BodySpec merged_body(BodySpec first, const BodySpec& second, const Eigen::Quaterniond& turn,
                     const Eigen::Vector3d& origin) {
  if (second.mass == 0 && second.inertia.isZero(0)) return first;
  const Eigen::Matrix3d r = turn.toRotationMatrix();
  const Eigen::Vector3d d = origin + r * second.com - first.com;
  first.inertia += r * second.inertia * r.transpose();
  if (second.mass > 0) {
    const double mass = first.mass + second.mass, share = second.mass / mass;
    first.inertia +=
        first.mass * share * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
    first.com = first.mass > 0 ? Eigen::Vector3d(first.com + share * d)
                               : Eigen::Vector3d(origin + r * second.com);
    first.mass = mass;
  }
  first.inertia = (0.5 * (first.inertia + first.inertia.transpose())).eval();
  first.any_inertia |= second.any_inertia;
  first.shape = {};
  return first;
}

}  // namespace momenta
