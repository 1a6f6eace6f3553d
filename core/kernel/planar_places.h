#pragma once
// Records and places of bodies at (t, q), shared by both recursions in a plane.

#include <momenta/core/kernel/general_joint.h>
#include <momenta/core/kernel/planar_joint.h>
#include <momenta/core/kernel/sweeps.h>

namespace momenta {

/// Quantities that bodies pass inward, and outward.
template <class S>
struct PlanarArticulated {
  S Axx, Axy, Ayy, Hx, Hy, I, Dx, Dy, Dn, G;
};
template <class S>
struct PlanarMotion {
  S vx, vy, omega;
};

template <class S>
struct PlanarRevolute {
  S rx, ry;          ///< O_K − O_L
  S Axx, Axy, Ayy;   ///< A'
  S Dx, Dy, hx, hy;  ///< D', h
  S inverse, y0, G;  ///< M_j⁻¹, M_j⁻¹ e, moment of the subtree's weight
  S kx, ky;          ///< own first moment; in the acceleration form
};

/// Absolute angles of all bodies, their sines and cosines, joints of the general links.
template <class S>
class PlanarPlaces {
 public:
  explicit PlanarPlaces(const PlanarTree& tree)
      : tree_(&tree),
        angles_(tree.links.size()),
        revolutes_(tree.links.size()),
        joints_(static_cast<std::size_t>(tree.records)),
        slots_(static_cast<std::size_t>(tree.slots)),
        outward_slots_(static_cast<std::size_t>(tree.slots)) {}
  int singular_joint() const { return singular_joint_; }

 protected:
  template <class In>
  void place(const S& t, const In& q) {
    const PlanarLink* links = tree_->links.data();
    const std::size_t n = angles_.size();
    S before(0.0);  // angle of the body before: chains sum consecutively
    for (std::size_t k = 0; k < n; ++k) {
      const PlanarLink& l = links[k];
      S angle(tree_->theta0[k]);
      if (l.revolute) angle = angle + l.sign * q[l.q];
      if (l.parent >= 0)
        angle = angle + (l.first ? before : S(angles_[static_cast<std::size_t>(l.parent)]));
      before = angle;
      if (l.revolute) {
        angles_.set(k, angle);
        continue;
      }
      const auto& b = body(k);
      auto& x = joints_[static_cast<std::size_t>(l.record)];
      if (b.drive >= 0)
        prescribe(tree_->model->drives[static_cast<std::size_t>(b.drive)], t, x.drive, x.drive_rate,
                  x.drive_acceleration);
      x.value = b.drive >= 0 ? x.drive : b.nq == 1 ? S(q[b.q]) : S(0.0);
      if (b.kind == JointKind::revolute) angle += l.sign * x.value;
      before = angle;
      angles_.set(k, angle);
    }
    angles_.turn();
    if (joints_.empty()) return;
    for (std::size_t k = 0; k < n; ++k) {
      const PlanarLink& l = links[k];
      if (l.revolute) continue;
      auto& x = joints_[static_cast<std::size_t>(l.record)];
      x.edge.r = step(l);
      x.edge.sign = S(l.sign);
      if (body(k).kind != JointKind::prismatic) continue;
      x.edge.prismatic = turned(l.parent, l.prismatic_x, l.prismatic_y);
      x.edge.r += x.value * x.edge.prismatic;
    }
  }

  /// A vector of the parent's frame in ground axes.
  Vec2<S> turned(int parent, double x, double y) const {
    if (parent < 0) return {{S(x), S(y)}};
    const auto k = static_cast<std::size_t>(parent);
    return {
        {angles_.cosine(k) * x - angles_.sine(k) * y, angles_.sine(k) * x + angles_.cosine(k) * y}};
  }
  /// O_K − O_L with the joint at zero.
  MOMENTA_INLINE Vec2<S> step(const PlanarLink& l) const {
    if (!l.first) return turned(l.parent, l.x, l.y);
    const auto k = static_cast<std::size_t>(l.parent);
    return {{l.x * angles_.cosine(k), l.x * angles_.sine(k)}};
  }
  const Model<Planar>::Body& body(std::size_t k) const { return tree_->model->bodies[k]; }
  PlanarArticulated<S>& slot_of_parent(const PlanarLink& l) {
    return slots_[static_cast<std::size_t>(tree_->links[static_cast<std::size_t>(l.parent)].slot)];
  }
  /// Ω of the parent's joint, where the parent is not the body before.
  const PlanarMotion<S>& motion_of_parent(const PlanarLink& l) const {
    return outward_slots_[static_cast<std::size_t>(
        tree_->links[static_cast<std::size_t>(l.parent)].slot)];
  }

  static MOMENTA_INLINE void add(PlanarArticulated<S>& a, const PlanarArticulated<S>& b) {
    a.Axx = a.Axx + b.Axx;
    a.Axy = a.Axy + b.Axy;
    a.Ayy = a.Ayy + b.Ayy;
    a.Hx = a.Hx + b.Hx;
    a.Hy = a.Hy + b.Hy;
    a.I = a.I + b.I;
    a.Dx = a.Dx + b.Dx;
    a.Dy = a.Dy + b.Dy;
    a.Dn = a.Dn + b.Dn;
    a.G = a.G + b.G;
  }
  /// Leaves the share of a child beside the first in its parent's slot.
  static MOMENTA_INLINE void leave(const PlanarLink& l, PlanarArticulated<S>& slot,
                                   const PlanarArticulated<S>& a) {
    if (l.opens)
      slot = a;
    else
      add(slot, a);
  }
  static MOMENTA_INLINE void add_body(PlanarArticulated<S>& a, const PlanarLink& l, const S& kx,
                                      const S& ky) {
    a.Axx = a.Axx + l.m;
    a.Ayy = a.Ayy + l.m;
    a.Hx = a.Hx - ky;
    a.Hy = a.Hy + kx;
    a.I = a.I + l.J;
  }
  /// Takes A', D' of a joint from O_K to O_L; D'_n = n.
  static MOMENTA_INLINE void carry(PlanarArticulated<S>& a, const S& rx, const S& ry, const S& n) {
    a.Hx = a.Axy * rx - a.Axx * ry;
    a.Hy = a.Ayy * rx - a.Axy * ry;
    a.I = rx * a.Hy - ry * a.Hx;
    a.Dn = n + (rx * a.Dy - ry * a.Dx);
  }
  /// The same with a rotor, whose H' = I_r h and I' = I_r (1 − I_r M_j⁻¹) remain: rotor.h.
  static MOMENTA_INLINE void carry_with_rotor(PlanarArticulated<S>& a, const PlanarLink& l,
                                              const S& hx, const S& hy, const S& inverse,
                                              const S& rx, const S& ry, const S& n) {
    carry(a, rx, ry, n);
    const S Hx = l.rotor * hx, Hy = l.rotor * hy, across = rx * Hy - ry * Hx;
    a.Hx = a.Hx + Hx;
    a.Hy = a.Hy + Hy;
    a.I = a.I + (l.rotor * (1.0 - l.rotor * inverse) + (across + across));
  }
  /// The same for M' and D' of any joint.
  static void carry(PlanarArticulated<S>& a, const JointRecord<Planar, S>& x,
                    const Planar::ArticulatedInertia<S>& M, const Planar::Force<S>& D) {
    const auto m = Planar::to_parent({}, JointKind::weld, x.edge, M);
    const auto d = Planar::to_parent({}, JointKind::weld, x.edge, D);
    const S G = a.G;
    a = {m.xx, m.xy, m.yy, m.H[0], m.H[1], m.I, d.f[0], d.f[1], d.n, G};
  }
  static Planar::ArticulatedInertia<S> blocks(const PlanarArticulated<S>& a) {
    return {a.Axx, a.Axy, a.Ayy, {{a.Hx, a.Hy}}, a.I};
  }

  const PlanarTree* tree_;
  Angles<S> angles_;
  std::vector<PlanarRevolute<S>> revolutes_;
  std::vector<JointRecord<Planar, S>> joints_;
  std::vector<PlanarArticulated<S>> slots_;
  std::vector<PlanarMotion<S>> outward_slots_;
  int singular_joint_ = -1;
};

}  // namespace momenta
