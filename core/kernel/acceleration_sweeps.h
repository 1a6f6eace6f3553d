#pragma once
// The articulated-body recursion (Featherstone) in space, (q, u, t) → u̇, in the frames and with the
// means of the momentum recursion, its twin.
//
//   outward   Ω of every body; c: what its acceleration has beside 𝒯ⱽ A_L and E u̇; bias wrench
//             b = (ω × (ω × m c), ω × J ω)
//   inward    M* as in the momentum recursion; e = τ − Eᵀ D, D_L += 𝒯ᶠ (D + h e + M' c)
//   outward   W = 𝒯ⱽ A_L + c, u̇ = M_j⁻¹ e − hᵀ W, A = W + E u̇
//
// A = (acceleration of O, dω/dt) in body axes. With the acceleration of O instead of the derivative
// of v in body axes, linear velocities drop out: only ω goes outward. Gravity is an acceleration −g
// of the ground. For a revolute joint with the way (x screw, z screw) from its parent,
//   c = R ω × (ω × r) + the joint's part,  α part of c = ω × z q̇ = (ω_y q̇, −ω_x q̇, 0).

#include <momenta/core/kernel/place_links.h>
#include <momenta/core/kernel/rotor.h>
#include <momenta/core/kernel/spherical.h>

namespace momenta {

template <class S>
struct RevoluteAcceleration {
  RevoluteColumn<S> h;
  S y0, inverse;                   ///< M_j⁻¹ e; with a rotor M_j⁻¹
  S bfx, bfy, bfz, bnx, bny, bnz;  ///< bias wrench
  S clx, cly, clz, cox, coy;       ///< c, in the frame before the revolute joint's screw
};
template <class S>
struct SphericalAcceleration {
  Mat3<S> R;
  SphericalPivot<S> pivot;
  Sym3<S> A;  ///< M' = (A, 0; 0, 0)
  Vec3<S> bf, bn, cl, co;
  bool constant = false;  ///< pivot and A are constant: eliminate_leaves()
};

template <class Space, class S>
class AccelerationSweeps;

template <class S>
class AccelerationSweeps<Spatial, S> {
 public:
  using Space = Spatial;
  explicit AccelerationSweeps(const LinkTree& tree)
      : tree_(&tree),
        angles_(tree.links.size()),
        revolutes_(tree.links.size()),
        sphericals_(tree.sphericals.size()),
        joints_(static_cast<std::size_t>(tree.records)),
        users_(static_cast<std::size_t>(tree.users)),
        slots_(static_cast<std::size_t>(tree.slots)),
        outward_slots_(static_cast<std::size_t>(tree.slots)) {
    eliminate_leaves<S>(tree, sphericals_);
  }

  /// u̇ (nv) from (q, u, t) and all generalised forces τ (nv) but weights. In and Out index like
  /// pointers to S. False at a singular joint: singular_joint(). O(bodies).
  template <class In, class InTau, class Out>
  bool operator()(const S& t, const In& q, const In& u, const InTau& tau, Out udot) {
    place(t, q);
    singular_joint_ = tree_->singular_joint;
    if (singular_joint_ >= 0) return false;
    velocities(u);
    if (!inward(tau)) return false;
    outward(udot);
    return true;
  }
  int singular_joint() const { return singular_joint_; }

  // Single sweeps, for remaining trees with their branches between (branch_accelerations.h).
  template <class In>
  void place(const S& t, const In& q) {
    singular_joint_ = -1;
    place_links(
        *tree_, t, q, angles_, joints_,
        users_, [&](std::size_t record) -> auto& { return sphericals_[record].R; });
  }
  template <class In>
  void velocities(const In& u);
  template <class InTau>
  bool inward(const InTau& tau);
  template <class Out>
  void outward(Out udot);
  /// Slots that branches fill before the inward sweep, and read after either outward one.
  Articulated<S>& carried(int slot) { return slots_[static_cast<std::size_t>(slot)]; }
  const OutwardMotion<S>& motion(int slot) const {
    return outward_slots_[static_cast<std::size_t>(slot)];
  }

 private:
  template <Turn turn, class InTau>
  __attribute__((noinline)) std::size_t chain_inward(std::size_t end, const InTau& tau,
                                                     Articulated<S>& articulated);
  template <class InTau>
  __attribute__((noinline)) std::size_t revolutes_inward(std::size_t end, const InTau& tau,
                                                         Articulated<S>& articulated);
  template <class InTau>
  __attribute__((noinline)) bool spherical_inward(std::size_t k, const InTau& tau,
                                                  Articulated<S>& articulated);
  template <class InTau>
  __attribute__((noinline)) bool axis_inward(std::size_t k, const InTau& tau,
                                             Articulated<S>& articulated);
  template <class Out>
  __attribute__((noinline)) void axis_outward(std::size_t k, Out udot,
                                              OutwardMotion<S>& articulated);
  template <class InTau>
  __attribute__((noinline)) bool general_inward(std::size_t k, const InTau& tau,
                                                Articulated<S>& articulated);
  template <class In>
  __attribute__((noinline)) void any_velocity(std::size_t k, const In& u,
                                              OutwardMotion<S>& articulated);
  template <class Out>
  __attribute__((noinline)) void general_outward(std::size_t k, Out udot,
                                                 OutwardMotion<S>& articulated);
  const Model<Spatial>::Body& body(std::size_t k) const { return tree_->model->bodies[k]; }
  Articulated<S>& slot_of_parent(const Link& l) {
    return slots_[static_cast<std::size_t>(tree_->links[static_cast<std::size_t>(l.parent)].slot)];
  }

  const LinkTree* tree_;
  Angles<S> angles_;
  std::vector<RevoluteAcceleration<S>> revolutes_;
  std::vector<SphericalAcceleration<S>> sphericals_;
  std::vector<JointRecord<Spatial, S>> joints_;
  std::vector<UserRecord<S>> users_;
  std::vector<Articulated<S>> slots_;
  std::vector<OutwardMotion<S>> outward_slots_;
  int singular_joint_ = -1;
};

template <class S>
template <class InTau>
bool AccelerationSweeps<Spatial, S>::inward(const InTau& tau) {
  const Link* links = tree_->links.data();
  Articulated<S> articulated;  // zero at a leaf
  for (std::size_t k = angles_.size(); k > 0;) {
    switch (links[k - 1].path) {
      case Path::chain_general:
        k = chain_inward<Turn::general>(k, tau, articulated);
        break;
      case Path::chain_right:
        k = chain_inward<Turn::right>(k, tau, articulated);
        break;
      case Path::chain_parallel:
        k = chain_inward<Turn::parallel>(k, tau, articulated);
        break;
      case Path::root:
      case Path::any:
        if (links[k - 1].kind == LinkKind::revolute) {
          k = revolutes_inward(k, tau, articulated);
          break;
        }
        --k;
        if (!(links[k].kind == LinkKind::spherical ? spherical_inward(k, tau, articulated)
              : links[k].one_axis                  ? axis_inward(k, tau, articulated)
                                                   : general_inward(k, tau, articulated)))
          singular_joint_ = static_cast<int>(k);
        break;
    }
    if (singular_joint_ >= 0) return false;
  }
  return true;
}

/// Last step of a revolute joint: A from the parent's frame to the joint's before its turning, left
/// in `wz`.
template <class Link, class Edge, class S>
MOMENTA_INLINE void accelerate_revolute(const Link& l, const Edge& edge,
                                        const RevoluteAcceleration<S>& w, const S& c, const S& s,
                                        S& vx, S& vy, S& vz, S& ox, S& oy, S& oz, S& wz) {
  constants_outward(l, edge, vx, vy, vz, ox, oy, oz);
  vx = vx + w.clx;
  vy = vy + w.cly;
  vz = vz + w.clz;
  ox = ox + w.cox;
  oy = oy + w.coy;
  screw_outward(c, s, l.d, vx, vy, ox, oy);
  wz = w.y0 - (w.h.fx * vx + w.h.fy * vy + w.h.fz * vz + w.h.nx * ox + w.h.ny * oy);
  if (l.has_rotor) wz = wz + l.rotor * w.inverse * oz;
}

template <class S>
template <class Out>
void AccelerationSweeps<Spatial, S>::outward(Out udot) {
  const Link* links = tree_->links.data();
  const auto& gravity = tree_->model->gravity;
  const S zero(0.0);
  S vx = zero, vy = zero, vz = zero, ox = zero, oy = zero, oz = zero;
  for (std::size_t k = 0; k < angles_.size(); ++k) {
    const Link& l = links[k];
    if (l.parent >= 0 && !l.first) {
      const auto& from =
          outward_slots_[static_cast<std::size_t>(links[static_cast<std::size_t>(l.parent)].slot)];
      vx = from.vx;
      vy = from.vy;
      vz = from.vz;
      ox = from.ox;
      oy = from.oy;
      oz = from.oz;
    } else if (l.parent < 0) {
      vx = S(-gravity[0]);
      vy = S(-gravity[1]);
      vz = S(-gravity[2]);
      ox = oy = oz = zero;
    }
    if (l.kind != LinkKind::revolute) {
      OutwardMotion<S> here{vx, vy, vz, ox, oy, oz, zero, zero, zero};
      if (l.one_axis)
        axis_outward(k, udot, here);
      else
        general_outward(k, udot, here);
      vx = here.vx;
      vy = here.vy;
      vz = here.vz;
      ox = here.ox;
      oy = here.oy;
      oz = here.oz;
    } else {
      const RevoluteAcceleration<S>& w = revolutes_[k];
      const S c = angles_.cosine(k), s = angles_.sine(k);
      if (l.parent < 0) {
        const Vec3<double>& at = tree_->weight[k];
        vx = -(c * at[0] + s * at[1]);
        vy = -(c * at[1] - s * at[0]);
        vz = S(-at[2]);
        oz = w.y0 - (w.h.fx * vx + w.h.fy * vy + w.h.fz * vz);
        udot[l.u] = oz;
      } else {
        S wz;
        accelerate_revolute(l, body(k).edge, w, c, s, vx, vy, vz, ox, oy, oz, wz);
        udot[l.u] = wz - oz;
        oz = wz;
      }
    }
    if (l.slot >= 0)
      outward_slots_[static_cast<std::size_t>(l.slot)] = {vx, vy, vz, ox, oy, oz, zero, zero, zero};
  }
}

}  // namespace momenta

#include <momenta/core/kernel/acceleration_joints.h>
#include <momenta/core/kernel/acceleration_revolutes.h>
#include <momenta/core/kernel/acceleration_velocities.h>
