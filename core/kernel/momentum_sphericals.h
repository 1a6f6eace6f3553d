#pragma once
// Spherical joints in the momentum recursion, both sweeps, one after the other; what neighbours
// pass on stays in registers.
//
// A spherical joint leaves its body no angular inertia towards the parent: M' = (A', 0; 0, 0) with
// A' = A − H I⁻¹ Hᵀ, D' = (D_f + H I⁻¹ e, p). At the parent arrives A' turned, and shifted by the
// step r: H = −A r̃, I = r̃ H. Where a body carries nothing, A' and the factors of I are constants, D
// = 0 and e = p. On the ground nothing is passed on, and v = 0:
//
//   ω = I⁻¹ e,  ṗ = G × Rᵀg − ω × p
//
// Where all bodies are tops, on the ground and carrying nothing, that is the whole evaluation,
// without sweeps.

#include <momenta/core/kernel/momentum_sweeps.h>

namespace momenta {

/// ω, g in body axes and ṗ of a joint on the ground; g0: gravity before its turn.
template <bool Gravity, class S, class In>
MOMENTA_INLINE void turn_on_ground(const SphericalPivot<S>& pivot, const Vec3<S>& p,
                                   const Vec3<S>& G, const Vec3<double>& g0, const In& q, int first,
                                   Vec3<S>& omega, Vec3<S>& g, Vec3<S>& net) {
  omega = pivot.omega();
  net = cross(p, omega);
  if constexpr (Gravity) {
    g = turned_back_by<S>(q[first], q[first + 1], q[first + 2], q[first + 3], g0);
    net += cross(G, g);
  }
}

template <class S>
bool MomentumSweeps<Spatial, S>::tops_alone() const {
  if (tree_->links.empty()) return false;
  for (const Link& l : tree_->links)
    if (l.kind != LinkKind::spherical || l.parent >= 0 ||
        !sphericals_[static_cast<std::size_t>(l.record)].constant)
      return false;
  return true;
}
template <class S>
template <bool Gravity, class In, class Out>
void MomentumSweeps<Spatial, S>::turn_tops(const In& q, const In& p, Out u, Out pdot) {
  for (std::size_t k = 0; k < sphericals_.size(); ++k) {
    const Link& l = tree_->links[k];
    const Vec3<S> here{{p[l.u], p[l.u + 1], p[l.u + 2]}};
    SphericalPivot<S>& pivot = sphericals_[k].pivot;
    pivot.take(here);
    Vec3<S> omega, g, net;
    turn_on_ground<Gravity>(pivot, here, Vec3<S>{{S(l.moment[0]), S(l.moment[1]), S(l.moment[2])}},
                            tree_->weight[k], q, l.q, omega, g, net);
    for (int i = 0; i < 3; ++i) {
      u[l.u + i] = omega[i];
      pdot[l.u + i] = net[i];
    }
  }
}

/// Spherical joints from `end` − 1 down, while their bodies follow each other; returns the end of
/// the rest.
template <class S>
template <bool Gravity, class In>
std::size_t MomentumSweeps<Spatial, S>::sphericals_inward(std::size_t end, const In& q, const In& p,
                                                          Articulated<S>& from) {
  const Link* links = tree_->links.data();
  Articulated<S> articulated;
  const auto copy = [](S& a, const S& b) { a = b; };
  if (!links[end - 1].leaf) in_pairs<Gravity>(articulated, from, copy);
  std::size_t k = end;
  do {
    --k;
    const Link& l = links[k];
    const auto record = static_cast<std::size_t>(l.record);
    SphericalRecord<S>& w = sphericals_[record];
    w.p = {{p[l.u], p[l.u + 1], p[l.u + 2]}};
    if (w.constant) {
      if constexpr (Gravity) w.G = {{S(l.moment[0]), S(l.moment[1]), S(l.moment[2])}};
      if (l.parent < 0) {
        w.pivot.take(w.p);
        continue;
      }
      w.Df = w.pivot.remainder(w.p);
    } else {
      if (l.leaf) articulated = {};
      add_body<Gravity>(articulated, l);
      if (l.slot >= 0) add<Gravity>(articulated, slots_[static_cast<std::size_t>(l.slot)]);
      if constexpr (Gravity) w.G = {{articulated.Gx, articulated.Gy, articulated.Gz}};
      const Vec3<S> e{
          {w.p[0] - articulated.Dnx, w.p[1] - articulated.Dny, w.p[2] - articulated.Dnz}};
      const bool found =
          l.parent < 0 ? w.pivot.factor(articulated.M) : w.pivot.eliminate(articulated.M, w.A);
      if (!found) {
        singular_joint_ = static_cast<int>(k);
        return k;
      }
      if (l.parent < 0) {
        w.pivot.take(e);
        continue;
      }
      w.Df = Vec3<S>{{articulated.Dfx, articulated.Dfy, articulated.Dfz}} + w.pivot.remainder(e);
    }
    const SphericalPlace& place = tree_->sphericals[record];
    w.R = spherical_axes<S>(place, q, l.q);
    carry_spherical(place.origin, w.R, w.A, w.Df, w.p, articulated);
    if constexpr (Gravity) {
      const Vec3<S> G = w.R * w.G;
      articulated.Gx = G[0];
      articulated.Gy = G[1];
      articulated.Gz = G[2];
    }
    if (!l.first) leave<Gravity>(l, slot_of_parent(l), articulated);
  } while (k > 0 && links[k - 1].kind == LinkKind::spherical);
  if (k > 0) in_pairs<Gravity>(from, articulated, copy);
  return k;
}

/// Spherical joints from k up, while each is its parent's first child; returns the last.
template <class S>
template <bool Gravity, class In, class Out>
std::size_t MomentumSweeps<Spatial, S>::sphericals_outward(std::size_t k, const In& q, Out u,
                                                           Out pdot, OutwardMotion<S>& from) {
  const Link* links = tree_->links.data();
  OutwardMotion<S> c = from;
  for (;; ++k) {
    const Link& l = links[k];
    const auto record = static_cast<std::size_t>(l.record);
    const SphericalRecord<S>& w = sphericals_[record];
    Vec3<S> v{}, o{}, g{}, omega, net;
    if (l.parent < 0) {
      turn_on_ground<Gravity>(w.pivot, w.p, w.G, tree_->weight[k], q, l.q, omega, g, net);
    } else {
      const auto& r = tree_->sphericals[record].origin;
      v = transpose_times(
          w.R, Vec3<S>{{c.vx + c.oy * r[2] - c.oz * r[1], c.vy + c.oz * r[0] - c.ox * r[2],
                        c.vz + c.ox * r[1] - c.oy * r[0]}});
      o = transpose_times(w.R, Vec3<S>{{c.ox, c.oy, c.oz}});
      omega = w.pivot.omega(v);
      const Vec3<S> Pf = w.A * v + w.Df;
      net = -(cross(v, Pf) + cross(omega, w.p));
      if constexpr (Gravity) {
        g = transpose_times(w.R, Vec3<S>{{c.gx, c.gy, c.gz}});
        net += cross(w.G, g);
      }
    }
    for (int i = 0; i < 3; ++i) {
      u[l.u + i] = omega[i] - o[i];
      pdot[l.u + i] = net[i];
    }
    c = {v[0], v[1], v[2], omega[0], omega[1], omega[2], g[0], g[1], g[2]};
    if (k + 1 == angles_.size() || links[k + 1].kind != LinkKind::spherical || !links[k + 1].first)
      break;
    if (l.slot >= 0) outward_slots_[static_cast<std::size_t>(l.slot)] = c;
  }
  from = c;
  return k;
}

}  // namespace momenta
