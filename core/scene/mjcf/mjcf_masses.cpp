// Changes of masses by <compiler>, as in MuJoCo. For a body with mass m and principal moments I1,
// I2, I3:
//
//   m ≥ boundmass and each Ii ≥ boundinertia, those below are raised to them; what has no mass and
//   no
//     <inertial> gets it at the point of its frame that its `pos` names in its parent's;
//   balanceinertia: where no rigid body has such moments, Ii + Ij < Ik, each is (I1 + I2 + I3)/3;
//   settotalmass M: then all m and Ii times M / Σ m, over all bodies but the world.

#include <momenta/core/scene/mjcf/mjcf_inertia.h>
#include <momenta/core/scene/mjcf/mjcf_model.h>

#include <Eigen/Eigenvalues>

namespace momenta::reading {

MjcfInertia bounded(const MjcfInertia& body, const MjcfSettings& settings) {
  MjcfInertia kept = body;
  if (body.mass >= 0) kept.mass = std::max(body.mass, settings.least_mass);
  if (settings.least_moment <= 0 && !settings.balances) return kept;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(body.inertia);
  const Eigen::Vector3d own = principal.eigenvalues();  // ascending
  Eigen::Vector3d moments = own.cwiseMax(settings.least_moment);
  if (settings.balances && moments[0] + moments[1] < moments[2])
    moments.setConstant(moments.mean());
  if (moments == own) return kept;
  const Eigen::Matrix3d& axes = principal.eigenvectors();
  const Eigen::Matrix3d inertia = axes * moments.asDiagonal() * axes.transpose();
  kept.inertia = 0.5 * (inertia + inertia.transpose());
  return kept;
}

void scale_to_total_mass(MjcfModel& model) {
  if (model.total_mass == 0) return;
  double sum = 0;
  for (const BodySpec& body : model.scene.bodies) sum += body.mass;
  if (sum == 0) return;
  const double factor = model.total_mass / sum;
  for (BodySpec& body : model.scene.bodies) {
    body.mass *= factor;
    body.inertia *= factor;
  }
  for (ForceSpec& force : model.scene.forces)
    if (force.kind == "wrench") force.force *= factor;  // force of gravcomp
}

}  // namespace momenta::reading
