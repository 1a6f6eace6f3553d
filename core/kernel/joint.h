#pragma once
// Joints in each algebra: place at q, motion E u, projection Eᵀ F. All E but those of user joints
// are constant in body axes (revolute, prismatic: z; helical: z twice, E = (0, 0, pitch; 0, 0, 1);
// spherical, free: unit matrices), so Ė of eq. (35) vanishes. A user joint brings E and Ė with its
// formula. Other kinds are chains of these.

#include <momenta/core/kernel/planar_joint.h>
#include <momenta/core/kernel/spatial_joint.h>

namespace momenta {

/// q̇ = ½ q ∘ (0, ω) of a quaternion, ω in child axes.
template <class S>
MOMENTA_INLINE void quaternion_rates(const S* q, const S* w, S* qdot) {
  qdot[0] = -0.5 * (q[1] * w[0] + q[2] * w[1] + q[3] * w[2]);
  qdot[1] = 0.5 * (q[0] * w[0] + q[2] * w[2] - q[3] * w[1]);
  qdot[2] = 0.5 * (q[0] * w[1] + q[3] * w[0] - q[1] * w[2]);
  qdot[3] = 0.5 * (q[0] * w[2] + q[1] * w[1] - q[2] * w[0]);
}

/// Rates of the coordinates of one built-in joint: q̇ = u, or the kinematics of position and
/// quaternion.
/// position rate = R v, v in child axes too.
template <class S>
void coordinate_rates(JointKind kind, const S* q, const S* u, S* qdot) {
  switch (kind) {
    case JointKind::revolute:
    case JointKind::prismatic:
    case JointKind::helical:
      qdot[0] = u[0];
      return;
    default:  // weld
      return;
    case JointKind::free: {
      const Vec3<S> v = rotation_of(q + 3) * Vec3<S>{{u[0], u[1], u[2]}};
      for (int i = 0; i < 3; ++i) qdot[i] = v[i];
      q += 3;
      u += 3;
      qdot += 3;
      [[fallthrough]];
    }
    case JointKind::spherical:
      quaternion_rates(q, u, qdot);
      return;
  }
}

/// The inverse: rates u from q̇; for a quaternion ω = 2 vec(q* ∘ q̇) / |q|².
template <class S>
void joint_rates(JointKind kind, const S* q, const S* qdot, S* u) {
  switch (kind) {
    case JointKind::revolute:
    case JointKind::prismatic:
    case JointKind::helical:
      u[0] = qdot[0];
      return;
    default:  // weld
      return;
    case JointKind::free: {
      const Vec3<S> v = transpose_times(rotation_of(q + 3), Vec3<S>{{qdot[0], qdot[1], qdot[2]}});
      for (int i = 0; i < 3; ++i) u[i] = v[i];
      q += 3;
      u += 3;
      qdot += 3;
      [[fallthrough]];
    }
    case JointKind::spherical: {
      const S two = S(2.0) / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
      u[0] = two * (q[0] * qdot[1] - q[1] * qdot[0] - q[2] * qdot[3] + q[3] * qdot[2]);
      u[1] = two * (q[0] * qdot[2] - q[2] * qdot[0] - q[3] * qdot[1] + q[1] * qdot[3]);
      u[2] = two * (q[0] * qdot[3] - q[3] * qdot[0] - q[1] * qdot[2] + q[2] * qdot[1]);
      return;
    }
  }
}

}  // namespace momenta
