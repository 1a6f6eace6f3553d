#pragma once
// The rows of M of composite_sweeps.h: axes outward, then moments of subtrees and entries inward.

#include <momenta/core/kernel/composite_sweeps.h>

namespace momenta {

template <class S>
void CompositeSweeps<Spatial, S>::axes_outward() {
  const Link* links = tree_->links.data();
  const auto& angles = dynamics_.angles();
  const S zero(0.0), one(1.0);
  S Xx = one, Xy = zero, Xz = zero, Yx = zero, Yy = one, Yz = zero, Zx = zero, Zy = zero, Zz = one;
  for (std::size_t k = 0; k < stations_.size(); ++k) {
    const Link& l = links[k];
    Station& w = stations_[k];
    if (l.parent < 0) {
      Xx = Yy = Zz = one;
      Xy = Xz = Yx = Yz = Zx = Zy = zero;
    } else if (!is_plain_revolute(l)) {
      any_axes(k);
      const Station& here = stations_[k];
      Xx = here.X[0], Xy = here.X[1], Xz = here.X[2];
      Yx = here.Y[0], Yy = here.Y[1], Yz = here.Y[2];
      Zx = here.Z[0], Zy = here.Z[1], Zz = here.Z[2];
      continue;
    } else {
      if (!l.first) {
        const Station& from = stations_[static_cast<std::size_t>(l.parent)];
        Xx = from.X[0], Xy = from.X[1], Xz = from.X[2];
        Yx = from.Y[0], Yy = from.Y[1], Yz = from.Y[2];
        Zx = from.Z[0], Zy = from.Z[1], Zz = from.Z[2];
      }
      const S c = angles.cosine(k), s = angles.sine(k);
      S sx = l.a * Xx, sy = l.a * Xy, sz = l.a * Xz;
      turn_outward_x(l, Yx, Zx);
      turn_outward_x(l, Yy, Zy);
      turn_outward_x(l, Yz, Zz);
      sx = sx + l.d * Zx;
      sy = sy + l.d * Zy;
      sz = sz + l.d * Zz;
      turn_outward_z(c, s, Xx, Yx);
      turn_outward_z(c, s, Xy, Yy);
      turn_outward_z(c, s, Xz, Yz);
      w.step = {{sx, sy, sz}};
    }
    w.X = {{Xx, Xy, Xz}};
    w.Y = {{Yx, Yy, Yz}};
    w.Z = {{Zx, Zy, Zz}};
  }
}

template <class S>
void CompositeSweeps<Spatial, S>::any_axes(std::size_t k) {
  const Link& l = tree_->links[k];
  const auto& b = body(k);
  const Station& from = stations_[static_cast<std::size_t>(l.parent)];
  Spatial::Pose<S> at;
  at.axes.set_column(0, from.X);
  at.axes.set_column(1, from.Y);
  at.axes.set_column(2, from.Z);
  if (l.kind == LinkKind::spherical) {
    const auto& r = tree_->sphericals[static_cast<std::size_t>(l.record)].origin;
    at.origin = at.axes * Vec3<S>{{S(r[0]), S(r[1]), S(r[2])}};
    at.axes = at.axes * dynamics_.spherical_axes(l);
  } else {
    at = Spatial::pose_outward(b.edge, b.kind, dynamics_.edge(k), at);
  }
  stations_[k] = {at.origin, at.axes.column(2), at.axes.column(0), at.axes.column(1)};
}

/// Entries of one column of M at the ancestors of body k, F about its O; `row` points past them.
template <class S>
MOMENTA_INLINE void CompositeSweeps<Spatial, S>::inward_from(std::size_t k, Column F,
                                                             S* row) const {
  const Place* places = places_.data();
  for (int parent = places[k].parent; parent >= 0; parent = places[k].parent) {
    const Vec3<S>& r = stations_[k].step;
    k = static_cast<std::size_t>(parent);
    const Place& at = places[k];
    F.nz = F.nz + (r[0] * F.fy - r[1] * F.fx);
    if (at.parent < 0 && at.kind == LinkKind::revolute) {  // Z = (0, 0, 1)
      *--row = F.nz;
      return;
    }
    F.nx = F.nx + (r[1] * F.fz - r[2] * F.fy);
    F.ny = F.ny + (r[2] * F.fx - r[0] * F.fz);
    const Station& w = stations_[k];
    const auto force = [&](const Vec3<S>& axis) {
      return axis[0] * F.fx + axis[1] * F.fy + axis[2] * F.fz;
    };
    const auto moment = [&](const Vec3<S>& axis) {
      return axis[0] * F.nx + axis[1] * F.ny + axis[2] * F.nz;
    };
    if (at.kind == LinkKind::revolute) {
      *--row = moment(w.Z);
      continue;
    }
    if (at.nv == 1) {
      const auto& b = body(k);
      *--row = b.kind == JointKind::prismatic ? force(w.Z) : b.pitch * force(w.Z) + moment(w.Z);
    } else if (at.nv >= 3) {
      *--row = moment(w.Z);
      *--row = moment(w.Y);
      *--row = moment(w.X);
      if (at.nv == 6) {
        *--row = force(w.Z);
        *--row = force(w.Y);
        *--row = force(w.X);
      }
    }
  }
}

template <class S>
void CompositeSweeps<Spatial, S>::rows_inward() {
  const Link* links = tree_->links.data();
  const auto& angles = dynamics_.angles();
  CompositeMoments<S> m{};
  for (std::size_t k = stations_.size(); k-- > 0;) {
    const Link& l = links[k];
    const MassMoments<S>& own = dynamics_.moments(k);
    if (l.leaf)
      set_body(m, own);
    else if (l.kind == LinkKind::revolute)
      add_body<true>(m, own);
    else
      add_body<false>(m, own);
    if (l.slot >= 0) add(m, slots_[static_cast<std::size_t>(l.slot)]);
    if (l.kind != LinkKind::revolute) {
      const CompositeMoments<S> here = m;
      any_rows(k, here);
    } else {
      const auto dof = static_cast<std::size_t>(l.u);
      const auto depth = static_cast<std::size_t>(dofs_[dof].depth);
      S* row = rows_.data() + start(dof) + depth;
      const S turning = m.xx + m.yy;
      *row = pivot_of(l, turning);
      scale_[dof] = turning;
      if (l.parent < 0) continue;
      const Vec3<S>&X = stations_[k].X, &Y = stations_[k].Y, &Z = stations_[k].Z;
      inward_from(
          k,
          {m.x * Y[0] - m.y * X[0], m.x * Y[1] - m.y * X[1], m.x * Y[2] - m.y * X[2],
           turning * Z[0] - m.xz * X[0] - m.yz * Y[0], turning * Z[1] - m.xz * X[1] - m.yz * Y[1],
           turning * Z[2] - m.xz * X[2] - m.yz * Y[2]},
          row);
    }
    if (l.parent < 0) continue;
    if (is_plain_revolute(l)) {
      screw_z(m, angles.cosine(k), angles.sine(k), l.d);
      screw_x(m, l);
    } else {
      CompositeMoments<S> here = m;
      any_inward(k, here);
      m = here;
    }
    if (l.first) continue;
    auto& slot = slots_[static_cast<std::size_t>(links[static_cast<std::size_t>(l.parent)].slot)];
    if (l.opens)
      slot = m;
    else
      add(slot, m);
  }
}

/// Rows of a joint of any kind: M E column by column, f = m v + ω × c, n = c × v + J ω.
template <class S>
void CompositeSweeps<Spatial, S>::any_rows(std::size_t k, const CompositeMoments<S>& m) {
  const auto& b = body(k);
  const S mass(b.subtree_mass), Jx = m.yy + m.zz, Jy = m.xx + m.zz, Jz = m.xx + m.yy;
  const Vec3<S> c{{m.x, m.y, m.z}};
  const Sym3<S> J{{Jx, -m.xy, -m.xz, Jy, -m.yz, Jz}};
  const Station& w = stations_[k];
  for (int column = 0; column < b.nv; ++column) {
    const auto dof = static_cast<std::size_t>(b.u + column);
    S unit[6]{}, own[6]{};
    unit[column] = S(1.0);
    Spatial::Motion<S> motion{};
    Joint<Spatial>::add_motion(b, Spatial::Edge<S>{}, unit, motion);
    const Spatial::Force<S> F{mass * motion.v + cross(motion.w, c),
                              cross(c, motion.v) + J * motion.w};
    Joint<Spatial>::project(b, Spatial::Edge<S>{}, F, own);
    const auto above = static_cast<std::size_t>(dofs_[dof].depth - column);
    S* row = rows_.data() + start(dof) + above;
    if (b.has_rotor()) own[column] += b.rotor;
    for (int i = 0; i <= column; ++i) row[i] = own[i];
    // Rounding of an entry is relative to the largest entry of its joint.
    scale_[dof] = b.nv == 1 ? own[0] : b.nv == 6 && column < 3 ? mass : Jx + Jy + Jz + b.rotor;
    if (b.parent < 0) continue;
    const auto turned = [&](const Vec3<S>& v) { return v[0] * w.X + v[1] * w.Y + v[2] * w.Z; };
    const Vec3<S> f = turned(F.f), n = turned(F.n);
    inward_from(k, {f[0], f[1], f[2], n[0], n[1], n[2]}, row);
  }
}

template <class S>
void CompositeSweeps<Spatial, S>::any_inward(std::size_t k, CompositeMoments<S>& m) const {
  const Link& l = tree_->links[k];
  const auto& b = body(k);
  const S mass(l.kind == LinkKind::general ? b.subtree_mass : 0.0);
  Vec3<S> c{{m.x, m.y, m.z}};
  Sym3<S> s{{m.xx, m.xy, m.xz, m.yy, m.yz, m.zz}};
  // Σ += r cᵀ + c rᵀ + m r rᵀ, c += m r
  const auto shift = [&](const Vec3<S>& r) {
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) s(i, j) += r[i] * c[j] + c[i] * r[j] + mass * r[i] * r[j];
    c += mass * r;
  };
  const auto turn_by = [&](const Mat3<S>& R) {
    Mat3<S> half;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        half(i, j) = R(i, 0) * s(0, j) + R(i, 1) * s(1, j) + R(i, 2) * s(2, j);
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j)
        s(i, j) = half(i, 0) * R(j, 0) + half(i, 1) * R(j, 1) + half(i, 2) * R(j, 2);
    c = R * c;
  };
  const auto screw = [&](auto axis, const auto& cosine, const auto& sine, const S& step) {
    constexpr int X = decltype(axis)::value, Y = (X + 1) % 3, Z = (X + 2) % 3;
    turn<X>(s, cosine, sine);
    turn<X>(c, cosine, sine);
    s(X, X) += step * (c[X] + c[X] + mass * step);
    s(X, Y) += step * c[Y];
    s(X, Z) += step * c[Z];
    c[X] += mass * step;
  };
  using std::integral_constant;
  if (l.kind == LinkKind::spherical) {
    const auto& r = tree_->sphericals[static_cast<std::size_t>(l.record)].origin;
    turn_by(dynamics_.spherical_axes(l));
    shift({{S(r[0]), S(r[1]), S(r[2])}});
  } else {
    const auto e = dynamics_.edge(k);
    if (Spatial::moves_freely(b.kind)) {
      turn_by(e.rotation);
      shift(e.position);
    } else {
      screw(integral_constant<int, 2>(), e.cos_theta, e.sin_theta, e.d);
    }
    const auto& way = b.edge;
    if (way.about_y) screw(integral_constant<int, 1>(), way.cos_beta, way.sin_beta, S(0.0));
    if (way.about_x) screw(integral_constant<int, 0>(), way.cos_alpha, way.sin_alpha, S(way.a));
    if (way.about_z) screw(integral_constant<int, 2>(), way.cos_gamma, way.sin_gamma, S(way.delta));
  }
  m = {c[0], c[1], c[2], s.x[0], s.x[1], s.x[2], s.x[3], s.x[4], s.x[5]};
}

}  // namespace momenta
