#include <momenta/core/kernel/model.h>
#include <momenta/core/kernel/plan.h>

#include <cstdio>

namespace momenta {

Plan make_plan(const Tree& tree, const Scene& scene, Algebra algebra) {
  Plan plan;
  if (algebra == Algebra::spatial) {
    plan.planar_reason = "asked for";
  } else {
    const PlaneFinding plane = find_plane(tree, scene);
    if (plane.basis) {
      plan.planar = true;
      plan.basis = *plane.basis;
    } else if (algebra == Algebra::planar) {
      throw SceneError(scene.where({}) + "the planar kernel was asked for, but " + plane.why +
                       ", expected a mechanism in a plane, or the spatial kernel");
    } else {
      plan.planar_reason = plane.why;
    }
  }
  const Eigen::Vector3d in_plane = plan.basis.transpose() * tree.gravity;
  plan.gravity = plan.planar ? in_plane.head<2>().norm() > 0 : tree.gravity.norm() > 0;
  plan.drives = !tree.drives.empty();
  for (const auto& b : tree.bodies) {
    plan.quasi_velocities |= b.has_quaternion();
    plan.drives |= b.law != nullptr;  // its pose may depend on t
    plan.rotors += b.rotor != 0 ? b.nv : 0;
    plan.joint_forces |= b.stiffness != 0 || b.damping != 0 || b.torque != 0 || b.friction != 0 ||
                         b.stop_stiffness != 0 || b.stop_damping != 0;
  }
  for (const auto& joint : scene.joints)
    plan.third_sweep |= joint.kind == JointKind::spherical && has_stops(joint);
  for (const auto& force : scene.forces)
    plan.third_sweep |= force.kind != "torque" || !force.law.empty();
  return plan;
}

std::vector<std::pair<std::string, std::string>> Plan::lines() const {
  char normal[96];
  std::snprintf(normal, sizeof normal, "planar, normal (%.4g, %.4g, %.4g)", basis(0, 2),
                basis(1, 2), basis(2, 2));
  std::vector<std::pair<std::string, std::string>> all{
      {"kernel", planar ? normal : "spatial (" + planar_reason + ")"},
      {"gravity", !gravity ? "none, left out"
                  : loops  ? "weights on bodies"
                           : "carried as first moments"},
      {"drives", drives ? "rheonomic terms Ω_t, Φ_t evaluated" : "none, Ω_t and Φ_t left out"},
      {"quasi-velocities",
       quasi_velocities ? "spherical or free joints: quaternions in q" : "none, q̇ = u"},
      {"joint forces", joint_forces ? "springs, dampers, torques on joints" : "none, left out"},
      {"third sweep", loops         ? "wrenches of loops and forces, inward"
                      : third_sweep ? "forces between points of bodies"
                                    : "none, left out"},
  };
  if (rotors > 0)
    all.emplace_back("rotors", "on " + std::to_string(rotors) + (rotors == 1 ? " rate" : " rates") +
                                   ", added to the inertias of their joints");
  return all;
}

}  // namespace momenta
