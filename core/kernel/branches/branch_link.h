#pragma once
// Constants of one body of several mechanisms of one shape, a mechanism in each lane of S.

#include <momenta/core/kernel/link.h>

namespace momenta {

/// The turn whose code serves both.
inline Turn common_turn(Turn a, Turn b) {
  if (a == b) return a;
  return a == Turn::tilted || b == Turn::tilted ? Turn::tilted : Turn::general;
}

/// Names as in Link, EdgeConstants and Body.
template <class S>
struct BranchLink {
  struct Edge {
    S cos_gamma, sin_gamma, delta, cos_alpha, sin_alpha, a, cos_beta, sin_beta;
    bool about_z, about_x, about_y;
  };
  S ca, sa, a, cc, cs, ss, cs2, ss2, d, m, moment[3], c[3], J[6];
  S theta0;
  Edge edge;
  S stiffness, rest, damping, torque, friction, friction_rate, rotor;
  int slot, parent_slot;  ///< within the branch
  Turn turn;
  bool root, first, leaf, opens, screwed, has_force, is_curved, has_rotor;

  /// Sets one lane to the numbers of a body.
  void take(const Link& l, const Model<Spatial>::Body& b, double angle, int lane) {
    const auto set = [lane](S& x, double value) { x.set_lane(lane, value); };
    set(ca, l.ca), set(sa, l.sa), set(a, l.a), set(d, l.d);
    set(cc, l.cc), set(cs, l.cs), set(ss, l.ss), set(cs2, l.cs2), set(ss2, l.ss2);
    set(m, l.m);
    for (int i = 0; i < 3; ++i) set(moment[i], l.moment[i]), set(c[i], l.c[i]);
    for (int i = 0; i < 6; ++i) set(J[i], l.J[i]);
    set(theta0, angle);
    const Spatial::EdgeConstants& e = b.edge;
    set(edge.cos_gamma, e.cos_gamma), set(edge.sin_gamma, e.sin_gamma);
    set(edge.delta, e.delta);
    set(edge.cos_alpha, e.cos_alpha), set(edge.sin_alpha, e.sin_alpha), set(edge.a, e.a);
    set(edge.cos_beta, e.cos_beta), set(edge.sin_beta, e.sin_beta);
    set(stiffness, b.stiffness), set(rest, b.rest);
    set(damping, b.damping), set(torque, b.torque);
    set(friction, b.friction), set(friction_rate, b.friction_rate);
    set(rotor, l.rotor);
  }
};

}  // namespace momenta
