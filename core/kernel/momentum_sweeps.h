#pragma once
// The recursion of the paper in space, (q, p, t) → (u, ṗ) in two sweeps, eqs. (35), (37)-(48), for
// trees of any joints. For a single revolute joint K with parent L, in the order of the code:
//
//   inward    M*_K, D_K, G_K are complete             (43), (44); G: first moment of the subtree
//             M_j⁻¹ = 1 / I_zz, h = M*E M_j⁻¹          (46)
//             e = p − Eᵀ D = p − D_nz
//             M' = M* − M*E hᵀ, D' = D + h e           (47), (48); D'_nz = p exactly
//             M*_L += 𝒯ᶠ M' 𝒯ⱽ, D_L += 𝒯ᶠ D', G_L += … (43), (44)
//   outward   W = 𝒯ⱽ Ω_L, u = M_j⁻¹ e − hᵀ W           (45); the last entry of h is 1
//             P* = M' W + D'                           (42)
//             ṗ = Eᵀ (T* − W × P*) + joint force       (35), T* = weight of the subtree at G
//
// P* is never formed: about the revolute joint's axis Ω × P* takes ten numbers of M'
// (turning_rate). Weight needs no accumulated T*: masses of subtrees are constants.
//
// A body's share for its parent stays in registers when the parent is the body before; other
// children leave theirs in the parent's slot. Wrenches between points of bodies need a third sweep.

#include <momenta/core/kernel/forces.h>
#include <momenta/core/kernel/place_links.h>
#include <momenta/core/kernel/rotor.h>
#include <momenta/core/kernel/spherical.h>
#include <momenta/core/kernel/sweeps.h>

namespace momenta {

/// Record of a revolute joint for the outward sweep, body axes.
template <class S>
struct RevoluteRecord {
  RevoluteTurning<S> M;  ///< part of M'
  RevoluteColumn<S> h;
  S Dfx, Dfy, Dnx, Dny;  ///< D'
  S inverse, y0;         ///< M_j⁻¹, M_j⁻¹ e
  S Gx, Gy;              ///< G across the joint's axis
};

/// Record of a spherical joint for the outward sweep. R: child components to the parent's. On the
/// ground R, A and Df are not computed: the origin rests, and gravity turns by the quaternion.
template <class S>
struct SphericalRecord {
  Mat3<S> R;
  SphericalPivot<S> pivot;
  Sym3<S> A;              ///< M' = (A, 0; 0, 0)
  Vec3<S> Df, p, G;       ///< D' = (Df, p); first moment of the subtree
  bool constant = false;  ///< pivot and A are constant: eliminate_leaves()
};

template <class Space, class S>
class MomentumSweeps;

template <class S>
class MomentumSweeps<Spatial, S> {
 public:
  using Space = Spatial;
  explicit MomentumSweeps(const LinkTree& tree)
      : tree_(&tree),
        angles_(tree.links.size()),
        revolutes_(tree.links.size()),
        sphericals_(tree.sphericals.size()),
        joints_(static_cast<std::size_t>(tree.records)),
        users_(static_cast<std::size_t>(tree.users)),
        slots_(static_cast<std::size_t>(tree.slots)),
        outward_slots_(static_cast<std::size_t>(tree.slots)),
        solution_(tree) {
    eliminate_leaves<S>(tree, sphericals_);
    tops_alone_ = tops_alone();
  }

  /// u (nv) and the open chain's ṗ (nv), without forces between points of bodies. In and Out index
  /// like pointers to S. False at a singular joint: singular_joint().
  template <class In, class Out>
  bool operator()(const S& t, const In& q, const In& p, Out u, Out pdot) {
    if (tops_alone_) {
      if (tree_->model->has_gravity)
        turn_tops<true>(q, p, u, pdot);
      else
        turn_tops<false>(q, p, u, pdot);
      return true;
    }
    place_links(*tree_, t, q, angles_, joints_, users_, WhereMet());
    singular_joint_ = tree_->singular_joint;
    if (singular_joint_ >= 0) return false;
    return tree_->model->has_gravity ? inward<true>(q, p) && outward<true>(q, u, pdot)
                                     : inward<false>(q, p) && outward<false>(q, u, pdot);
  }

  /// M⁻¹ x (nv) at the last configuration, without prescribed motion: inverse_mass.h. O(bodies).
  template <class In, class Out>
  void inverse_mass_times(const In& x, Out result);
  /// The same for S or, after sweeps on directions, for packs of right-hand sides.
  /// @pre S, or revolute joints alone.
  template <class X, class In, class Out>
  void inverse_mass_times(MassSolution<Spatial, X>& solution, const In& x, Out result);

  int singular_joint() const { return singular_joint_; }
  /// In a remaining tree: slots that branches fill before an evaluation, and read after it.
  Articulated<S>& carried(int slot) { return slots_[static_cast<std::size_t>(slot)]; }
  const OutwardMotion<S>& motion(int slot) const {
    return outward_slots_[static_cast<std::size_t>(slot)];
  }

 private:
  template <bool Gravity, class In>
  bool inward(const In& q, const In& p);
  template <bool Gravity, class In, class Out>
  bool outward(const In& q, Out u, Out pdot);

  bool tops_alone() const;
  template <bool Gravity, class In, class Out>
  void turn_tops(const In& q, const In& p, Out u, Out pdot);

  // Out of line: what a chain's loop holds in registers must have no address.
  template <Turn turn, bool Gravity, class In>
  __attribute__((noinline)) std::size_t chain_inward(std::size_t end, const In& p,
                                                     Articulated<S>& articulated);
  template <bool Gravity, class In>
  __attribute__((noinline)) std::size_t revolutes_inward(std::size_t end, const In& p,
                                                         Articulated<S>& articulated);
  template <bool Gravity, class In>
  __attribute__((noinline)) std::size_t sphericals_inward(std::size_t end, const In& q, const In& p,
                                                          Articulated<S>& articulated);
  template <bool Gravity, class In, class Out>
  __attribute__((noinline)) std::size_t sphericals_outward(std::size_t k, const In& q, Out u,
                                                           Out pdot, OutwardMotion<S>& articulated);
  template <bool Gravity, class In>
  __attribute__((noinline)) bool axis_inward(std::size_t k, const In& p,
                                             Articulated<S>& articulated);
  template <bool Gravity, class In, class Out>
  __attribute__((noinline)) void axis_outward(std::size_t k, const In& q, Out u, Out pdot,
                                              OutwardMotion<S>& articulated);
  template <bool Gravity, class In>
  __attribute__((noinline)) bool general_inward(std::size_t k, const In& p,
                                                Articulated<S>& articulated);
  template <bool Gravity, class In, class Out>
  __attribute__((noinline)) void general_outward(std::size_t k, const In& q, Out u, Out pdot,
                                                 OutwardMotion<S>& articulated);
  const Model<Spatial>::Body& body(std::size_t k) const { return tree_->model->bodies[k]; }
  Articulated<S>& slot_of_parent(const Link& l) {
    return slots_[static_cast<std::size_t>(tree_->links[static_cast<std::size_t>(l.parent)].slot)];
  }

  const LinkTree* tree_;
  Angles<S> angles_;
  std::vector<RevoluteRecord<S>> revolutes_;
  std::vector<SphericalRecord<S>> sphericals_;
  std::vector<JointRecord<Spatial, S>> joints_;
  std::vector<UserRecord<S>> users_;
  std::vector<Articulated<S>> slots_;
  std::vector<OutwardMotion<S>> outward_slots_;
  MassSolution<Spatial, S> solution_;
  int singular_joint_ = -1;
  bool tops_alone_ = false;
};

/// A revolute joint's outward step: Ω and g from the parent's frame to the joint's before its
/// turning, left in `wz`; (45), and ṗ without the joint's force, (35).
template <bool Gravity, class Link, class Edge, class S>
MOMENTA_INLINE void move_revolute(const Link& l, const Edge& edge, const RevoluteRecord<S>& w,
                                  const S& c, const S& s, S& vx, S& vy, S& vz, S& ox, S& oy, S& oz,
                                  S& gx, S& gy, S& gz, S& wz, S& rate) {
  constants_outward(l, edge, vx, vy, vz, ox, oy, oz);
  if constexpr (Gravity) constants_outward(l, edge, gx, gy, gz);
  screw_outward(c, s, l.d, vx, vy, ox, oy);
  rate = turning_rate(w.M, w.Dfx, w.Dfy, w.Dnx, w.Dny, vx, vy, vz, ox, oy);
  if constexpr (Gravity) {
    turn_outward(c, s, gx, gy);
    rate = rate + w.Gx * gy - w.Gy * gx;
  }
  wz = w.y0 - (w.h.fx * vx + w.h.fy * vy + w.h.fz * vz + w.h.nx * ox + w.h.ny * oy);
  if (l.has_rotor) [[unlikely]] {
    rate = rate + rotor_rate(w.h, l.rotor, vx, vy, ox, oy, oz);
    wz = wz + l.rotor * w.inverse * oz;
  }
}

template <class S>
template <bool Gravity, class In>
bool MomentumSweeps<Spatial, S>::inward(const In& q, const In& p) {
  const Link* links = tree_->links.data();
  Articulated<S> articulated;  // share of the next body; zero at a leaf
  for (std::size_t k = angles_.size(); k > 0;) {
    switch (links[k - 1].path) {
      case Path::chain_general:
        k = chain_inward<Turn::general, Gravity>(k, p, articulated);
        break;
      case Path::chain_right:
        k = chain_inward<Turn::right, Gravity>(k, p, articulated);
        break;
      case Path::chain_parallel:
        k = chain_inward<Turn::parallel, Gravity>(k, p, articulated);
        break;
      case Path::root:
      case Path::any:
        if (links[k - 1].kind == LinkKind::revolute) {
          k = revolutes_inward<Gravity>(k, p, articulated);
          break;
        }
        if (links[k - 1].kind == LinkKind::spherical) {
          k = sphericals_inward<Gravity>(k, q, p, articulated);
          break;
        }
        --k;
        if (!(links[k].one_axis ? axis_inward<Gravity>(k, p, articulated)
                                : general_inward<Gravity>(k, p, articulated)))
          singular_joint_ = static_cast<int>(k);
        break;
    }
    if (singular_joint_ >= 0) return false;
  }
  return true;
}

template <class S>
template <bool Gravity, class In, class Out>
bool MomentumSweeps<Spatial, S>::outward(const In& q, Out u, Out pdot) {
  const Link* links = tree_->links.data();
  const std::size_t n = angles_.size();
  // v of O, ω, g: first of the body before, then of this one.
  const S zero(0.0);
  S vx = zero, vy = zero, vz = zero, ox = zero, oy = zero, oz = zero, gx = zero, gy = zero,
    gz = zero;
  for (std::size_t k = 0; k < n; ++k) {
    const Link& l = links[k];
    if (!l.first && l.parent >= 0) {
      const auto& from =
          outward_slots_[static_cast<std::size_t>(links[static_cast<std::size_t>(l.parent)].slot)];
      vx = from.vx;
      vy = from.vy;
      vz = from.vz;
      ox = from.ox;
      oy = from.oy;
      oz = from.oz;
      if constexpr (Gravity) {
        gx = from.gx;
        gy = from.gy;
        gz = from.gz;
      }
    }
    if (l.kind != LinkKind::revolute) {
      OutwardMotion<S> here{vx, vy, vz, ox, oy, oz, gx, gy, gz};
      if (l.kind == LinkKind::spherical)
        k = sphericals_outward<Gravity>(k, q, u, pdot, here);
      else if (l.one_axis)
        axis_outward<Gravity>(k, q, u, pdot, here);
      else
        general_outward<Gravity>(k, q, u, pdot, here);
      vx = here.vx;
      vy = here.vy;
      vz = here.vz;
      ox = here.ox;
      oy = here.oy;
      oz = here.oz;
      if constexpr (Gravity) {
        gx = here.gx;
        gy = here.gy;
        gz = here.gz;
      }
    } else {
      const RevoluteRecord<S>& w = revolutes_[k];
      const S c = angles_.cosine(k), s = angles_.sine(k);
      S wz, own, rate;
      if (l.parent < 0) {
        rate = zero;
        if constexpr (Gravity) {
          const Vec3<double>& at = tree_->weight[k];
          gx = c * at[0] + s * at[1];
          gy = c * at[1] - s * at[0];
          gz = S(at[2]);
          rate = w.Gx * gy - w.Gy * gx;
        }
        vx = vy = vz = ox = oy = zero;
        own = wz = w.y0;
      } else {
        move_revolute<Gravity>(l, body(k).edge, w, c, s, vx, vy, vz, ox, oy, oz, gx, gy, gz, wz,
                               rate);
        own = wz - oz;
      }
      oz = wz;
      if (l.has_force) rate = rate + joint_force(body(k), S(q[l.q]), own);
      u[l.u] = own;
      pdot[l.u] = rate;
    }
    if (links[k].slot >= 0)
      outward_slots_[static_cast<std::size_t>(links[k].slot)] = {vx, vy, vz, ox, oy,
                                                                 oz, gx, gy, gz};
  }
  return true;
}

}  // namespace momenta

#include <momenta/core/kernel/momentum_joints.h>
#include <momenta/core/kernel/momentum_revolutes.h>
#include <momenta/core/kernel/momentum_sphericals.h>
