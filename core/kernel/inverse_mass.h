#pragma once
// M⁻¹ x by two sweeps without the cost of M*: with h, M_j⁻¹ and the frames of an evaluation,
//
//   inward    e = x − Eᵀ D,  D' = D + h e,  D_L += 𝒯ᶠ D'          (48), (44) without Ω_t
//   outward   u = M_j⁻¹ e − hᵀ W,  Ω = W + E u                    (45)
//
// After an evaluation on directions, whose values are equal in all lanes, packs of right-hand sides
// give that many columns of M⁻¹ at once.

#include <momenta/core/kernel/momentum_sweeps.h>
#include <momenta/core/kernel/planar_momentum_sweeps.h>

#include <type_traits>

namespace momenta {

/// Factor of right-hand sides: the value of a number of the evaluation.
template <class X>
MOMENTA_INLINE const X& value_in(const X& s) {
  return s;
}
template <class X>
MOMENTA_INLINE const X& value_in(const Dual<X, 1>& s) {
  return s.a;
}

template <class S>
template <class In, class Out>
void MomentumSweeps<Spatial, S>::inverse_mass_times(const In& x, Out result) {
  inverse_mass_times<S>(solution_, x, result);
}
template <class S>
template <class In, class Out>
void MomentumSweeps<Planar, S>::inverse_mass_times(const In& x, Out result) {
  inverse_mass_times<S>(solution_, x, result);
}

template <class S>
template <class X, class In, class Out>
void MomentumSweeps<Spatial, S>::inverse_mass_times(MassSolution<Spatial, X>& solution, const In& x,
                                                    Out result) {
  constexpr bool any_joint = std::is_same_v<X, S>;
  const auto in = [](const S& s) -> const X& { return value_in<X>(s); };
  const Link* links = tree_->links.data();
  const auto slot_of = [](const Link& l) { return static_cast<std::size_t>(l.slot); };
  const auto parent_slot = [&](const Link& l) {
    return slot_of(links[static_cast<std::size_t>(l.parent)]);
  };
  Spatial::Force<X> D;
  for (std::size_t k = angles_.size(); k-- > 0;) {
    const Link& l = links[k];
    const auto& b = body(k);
    if (l.leaf) D = {};
    if (l.slot >= 0) D += solution.inward[slot_of(l)];
    if (l.kind == LinkKind::revolute) {
      const RevoluteRecord<S>& w = revolutes_[k];
      const X e = x[l.u] - D.n[2];
      solution.y0[k] = e * in(w.inverse);
      if (l.parent < 0) continue;
      D.f += Vec3<X>{{in(w.h.fx) * e, in(w.h.fy) * e, in(w.h.fz) * e}};
      D.n += Vec3<X>{{in(w.h.nx) * e, in(w.h.ny) * e, e}};
      if (l.has_rotor) D.n[2] -= l.rotor * solution.y0[k];
      const S c = angles_.cosine(k), s = angles_.sine(k);
      Spatial::force_inward<2>(D, in(c), in(s), X(l.d));
      Spatial::constants_inward(b.edge, D);
    } else if constexpr (any_joint) {
      if (l.kind == LinkKind::spherical) {
        SphericalRecord<S>& w = sphericals_[static_cast<std::size_t>(l.record)];
        const Vec3<S> n{{x[l.u], x[l.u + 1], x[l.u + 2]}}, e = n - D.n;
        if (l.parent < 0) {
          w.pivot.take(e);
          continue;
        }
        const Vec3<S> force = D.f + w.pivot.remainder(e);
        const auto& r = tree_->sphericals[static_cast<std::size_t>(l.record)].origin;
        D = {w.R * force, w.R * n};
        D.n += cross(Vec3<S>{{S(r[0]), S(r[1]), S(r[2])}}, D.f);
      } else {
        auto& joint = joints_[static_cast<std::size_t>(l.record)];
        joint.D = D;
        S r[6]{};
        for (int i = 0; i < b.nv; ++i) r[i] = x[b.u + i];
        D = remainder<Spatial>(b, joint, r);
        if (l.parent < 0) continue;
        D = Spatial::to_parent(b.edge, b.kind, joint.edge, D);
      }
    }
    if (l.first) continue;
    auto& slot = solution.inward[parent_slot(l)];
    if (l.opens)
      slot = D;
    else
      slot += D;
  }
  Spatial::Motion<X> V;
  for (std::size_t k = 0; k < angles_.size(); ++k) {
    const Link& l = links[k];
    const auto& b = body(k);
    if (l.parent < 0)
      V = {};
    else if (!l.first)
      V = solution.outward[parent_slot(l)];
    if (l.kind == LinkKind::revolute) {
      const RevoluteRecord<S>& w = revolutes_[k];
      X turning = solution.y0[k];
      if (l.parent >= 0) {
        constants_outward(l, b.edge, V.v[0], V.v[1], V.v[2], V.w[0], V.w[1], V.w[2]);
        const S c = angles_.cosine(k), s = angles_.sine(k);
        Spatial::motion_outward<2>(V, in(c), in(s), X(l.d));
        turning -= in(w.h.fx) * V.v[0] + in(w.h.fy) * V.v[1] + in(w.h.fz) * V.v[2] +
                   in(w.h.nx) * V.w[0] + in(w.h.ny) * V.w[1];
        if (l.has_rotor) turning += l.rotor * in(w.inverse) * V.w[2];
        result[l.u] = turning - V.w[2];
      } else {
        result[l.u] = turning;
      }
      V.w[2] = turning;
    } else if constexpr (any_joint) {
      if (l.kind == LinkKind::spherical) {
        const SphericalRecord<S>& w = sphericals_[static_cast<std::size_t>(l.record)];
        const auto& r = tree_->sphericals[static_cast<std::size_t>(l.record)].origin;
        Vec3<S> omega;
        if (l.parent < 0) {
          omega = w.pivot.omega();
        } else {
          V.v += cross(V.w, Vec3<S>{{S(r[0]), S(r[1]), S(r[2])}});
          V = {transpose_times(w.R, V.v), transpose_times(w.R, V.w)};
          omega = w.pivot.omega(V.v);
        }
        for (int i = 0; i < 3; ++i) result[l.u + i] = omega[i] - V.w[i];
        V.w = omega;
      } else {
        const auto& joint = joints_[static_cast<std::size_t>(l.record)];
        if (l.parent >= 0) V = Spatial::to_child(b.edge, b.kind, joint.edge, V);
        S own[6];
        solve_joint<Spatial>(b, joint, V, own);
        for (int i = 0; i < b.nv; ++i) result[b.u + i] = own[i];
      }
    }
    if (l.slot >= 0) solution.outward[slot_of(l)] = V;
  }
}

template <class S>
template <class X, class In, class Out>
void MomentumSweeps<Planar, S>::inverse_mass_times(MassSolution<Planar, X>& solution, const In& x,
                                                   Out result) {
  constexpr bool any_joint = std::is_same_v<X, S>;
  const auto in = [](const S& s) -> const X& { return value_in<X>(s); };
  const PlanarLink* links = tree_->links.data();
  const auto slot_of = [](const PlanarLink& l) { return static_cast<std::size_t>(l.slot); };
  const auto parent_slot = [&](const PlanarLink& l) {
    return slot_of(links[static_cast<std::size_t>(l.parent)]);
  };
  Planar::Force<X> D;
  for (std::size_t k = revolutes_.size(); k-- > 0;) {
    const PlanarLink& l = links[k];
    if (l.leaf) D = {};
    if (l.slot >= 0) D += solution.inward[slot_of(l)];
    if (l.revolute) {
      const PlanarRevolute<S>& w = revolutes_[k];
      const X n = l.sign < 0 ? -x[l.u] : X(x[l.u]), e = n - D.n;
      solution.y0[k] = e * in(w.inverse);
      if (l.parent < 0) continue;
      D.f += Vec2<X>{{in(w.hx) * e, in(w.hy) * e}};
      D.n = n + (in(w.rx) * D.f[1] - in(w.ry) * D.f[0]);
      if (l.has_rotor) D.n -= l.rotor * solution.y0[k];
    } else if constexpr (any_joint) {
      const auto& b = Base::body(k);
      auto& joint = joints_[static_cast<std::size_t>(l.record)];
      joint.D = D;
      const S r = b.nv == 1 ? S(x[b.u]) : S(0.0);
      D = remainder<Planar>(b, joint, &r);
      if (l.parent < 0) continue;
      D = Planar::to_parent({}, b.kind, joint.edge, D);
    }
    if (l.first) continue;
    auto& slot = solution.inward[parent_slot(l)];
    if (l.opens)
      slot = D;
    else
      slot += D;
  }
  Planar::Motion<X> V;
  for (std::size_t k = 0; k < revolutes_.size(); ++k) {
    const PlanarLink& l = links[k];
    if (l.parent < 0)
      V = {};
    else if (!l.first)
      V = solution.outward[parent_slot(l)];
    if (l.revolute) {
      const PlanarRevolute<S>& w = revolutes_[k];
      X own = solution.y0[k], turning = own;
      if (l.parent >= 0) {
        V.v += cross(V.w, Vec2<X>{{in(w.rx), in(w.ry)}});
        turning -= in(w.hx) * V.v[0] + in(w.hy) * V.v[1];
        if (l.has_rotor) turning += l.rotor * in(w.inverse) * V.w;
        own = turning - V.w;
      }
      V.w = turning;
      result[l.u] = l.sign < 0 ? -own : own;
    } else if constexpr (any_joint) {
      const auto& b = Base::body(k);
      const auto& joint = joints_[static_cast<std::size_t>(l.record)];
      if (l.parent >= 0) V = Planar::to_child({}, b.kind, joint.edge, V);
      if (b.nv == 1) {
        S own;
        solve_joint<Planar>(b, joint, V, &own);
        result[b.u] = own;
      }
    }
    if (l.slot >= 0) solution.outward[slot_of(l)] = V;
  }
}

}  // namespace momenta
