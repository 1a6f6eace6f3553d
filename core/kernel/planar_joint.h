#pragma once
// A body of a planar tree for the fused sweeps. All vectors are in ground axes, moments about each
// body's own joint; a frame is turned so that the first child's joint lies on its x axis, which
// saves half of the products that place it.

#include <momenta/core/kernel/model.h>

#include <cstdint>
#include <limits>
#include <vector>

namespace momenta {

struct PlanarLink {
  double x = 0, y = 0;    ///< joint in the parent's frame [m]; y = 0 for a first child
  double m = 0, J = 0;    ///< [kg], about O [kg m²]
  double cx = 0, cy = 0;  ///< own first moment, body frame [kg m]
  double wx = 0,
         wy = 0;  ///< moment of the weight of all mass at rest in the frame: wx cos + wy sin
  double prismatic_x = 0, prismatic_y = 0;  ///< direction of a slider in the parent's frame
  double rotor = 0;                         ///< inertia on the joint's rate: rotor.h [kg m² or kg]
  double sign = 1;  ///< revolute joints: +1 when the axis is the plane's normal
  int q = 0, u = 0;
  int parent = -1;
  int slot = -1;
  int record = -1;
  bool revolute = true;  ///< undriven revolute joint
  bool first = false, leaf = false, has_force = false, has_rotor = false;
  bool forced = false;  ///< springs or wrenches act at its points
  bool opens = false;   ///< last child of its parent, first in the inward sweep
};

struct PlanarTree {
  const Model<Planar>* model = nullptr;
  std::vector<PlanarLink> links;
  std::vector<double> theta0;      ///< angle of the body's frame in its parent's at q = 0 [rad]
  std::vector<double> frame_turn;  ///< turn of this frame in the model's frame [rad]
  int slots = 0, records = 0;
};

PlanarTree build_links(const Model<Planar>& model);

// Joints in a plane: Joint<Planar> of joint.h.

template <class Space>
struct Joint;

template <>
struct Joint<Planar> {
  using Body = Model<Planar>::Body;

  template <class S>
  static void place(const Body& b, const Planar::Edge<S>* parent, const S& value, const S* /*q*/,
                    Planar::Edge<S>& e) {
    using std::cos, std::sin;
    const auto turned = [&](double x, double y) -> Vec2<S> {
      if (!parent) return {{S(x), S(y)}};
      return {{parent->c * x - parent->s * y, parent->s * x + parent->c * y}};
    };
    e.r = turned(b.edge.x, b.edge.y);
    if (b.kind == JointKind::revolute) {
      e.angle = b.edge.sign * value;
      if (parent) e.angle += parent->angle;
      e.c = cos(e.angle);
      e.s = sin(e.angle);
      e.sign = S(b.edge.sign);
      return;
    }
    if (parent) {
      e.angle = parent->angle;
      e.c = parent->c;
      e.s = parent->s;
    }
    if (b.kind == JointKind::prismatic) {
      e.prismatic = turned(b.edge.prismatic_x, b.edge.prismatic_y);
      e.r += value * e.prismatic;
    }
  }

  template <class S>
  static void add_motion(const Body& b, const Planar::Edge<S>& e, const S* u,
                         Planar::Motion<S>& v) {
    if (b.kind == JointKind::revolute)
      v.w += b.edge.sign * u[0];
    else if (b.kind == JointKind::prismatic)
      v.v += u[0] * e.prismatic;
  }

  template <class S>
  static void project(const Body& b, const Planar::Edge<S>& e, const Planar::Force<S>& f, S* p) {
    if (b.kind == JointKind::revolute)
      p[0] = b.edge.sign * f.n;
    else if (b.kind == JointKind::prismatic)
      p[0] = dot(e.prismatic, f.f);
  }

  template <class S>
  static S along(const Body& b, const Planar::Edge<S>& e, const Planar::Force<S>& f) {
    return b.kind == JointKind::revolute ? S(b.edge.sign * f.n) : dot(e.prismatic, f.f);
  }

  template <class S>
  static Planar::Force<S> column(const Body& b, const Planar::Edge<S>& e,
                                 const Planar::ArticulatedInertia<S>& m) {
    if (b.kind == JointKind::revolute) return {e.sign * m.H, e.sign * m.I};
    const Vec2<S>& s = e.prismatic;
    return {{{m.xx * s[0] + m.xy * s[1], m.xy * s[0] + m.yy * s[1]}}, dot(m.H, s)};
  }

  template <class S>
  static S inertia_margin(const Body& b, const Planar::ArticulatedInertia<S>&,
                          const S& joint_mass) {
    constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
    return b.kind == JointKind::revolute ? joint_mass : joint_mass - S(rounding * b.subtree_mass);
  }

  template <class S>
  static void reduce(const Body& b, Planar::ArticulatedInertia<S>& m, const Planar::Force<S>& u,
                     const Planar::Force<S>& h) {
    m.xx -= u.f[0] * h.f[0];
    m.xy -= u.f[0] * h.f[1];
    m.yy -= u.f[1] * h.f[1];
    m.H[0] -= u.f[0] * h.n;
    m.H[1] -= u.f[1] * h.n;
    m.I -= u.n * h.n;
    if (b.kind == JointKind::revolute && !b.has_rotor()) {
      m.H = {};
      m.I = S(0.0);
    }
  }
};

}  // namespace momenta
