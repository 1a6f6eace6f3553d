#include <momenta/core/open_chain/poses.h>
#include <momenta/dae/topology/assembly/displacement_of_mass.h>

namespace momenta {

double displacement_of_mass(const Mechanism& mechanism, double t, const Eigen::VectorXd& q,
                            const Eigen::VectorXd& other) {
  const Tree& tree = mechanism.tree();
  Poses poses(tree, mechanism.scene());
  const std::vector<Eigen::Isometry3d> here = poses(t, q.data()), there = poses(t, other.data());
  double sum = 0;
  for (const BodySpec& body : mechanism.scene().bodies) {
    const auto k = static_cast<std::size_t>(tree.body(body.name));
    const Eigen::Matrix3d second = 0.5 * body.inertia.trace() * Eigen::Matrix3d::Identity() -
                                   body.inertia,
                          turned = here[k].linear() - there[k].linear();
    sum += body.mass * (here[k] * body.com - there[k] * body.com).squaredNorm() +
           (turned * second * turned.transpose()).trace();
  }
  return sum;
}

}  // namespace momenta
