#pragma once
// Not for trees with user joints: rows are gathered along axes that rest in their bodies.
//
// Composite rigid bodies in space, (q, u, τ, t) → u̇ by M itself: the opponent of small trees, where
// it is hard to beat, and of trees that branch early.
//
//   bias      what inverse_dynamics_sweeps.h takes τ to be at u̇ = 0
//   outward   axes X, Y, Z and the step from parent to child, in axes all bodies of a tree share:
//             those of its first body
//   inward    subtrees: c and Σ about O by the screws of the frames; M E of a pin is the momentum
//             of its subtree, turned as one body:
//               f = z × c = (−c_y, c_x, 0),  n = (−Σ_xz, −Σ_yz, Σ_xx + Σ_yy)
//             in the shared axes it goes to the ancestors, and gives an entry of M at each:
//               n_L = n + step × f,  M_LK = Z_L · n_L
//             17 operations an entry; moving it by the screws of the frames takes 20
//             (right angles) to 32.
//   M = Lᵀ D L, Lᵀ y = τ − bias, L u̇ = D⁻¹ y
//
// M_ij ≠ 0 only where one dof lies on the other's way to the root, and no other entry arises when
// dofs are eliminated from the tips inward (Featherstone: branch-induced sparsity). Row k holds the
// entries of the ancestors of k, the root's first, and its own last. The row of an ancestor i is
// then as long as the part of row k up to i, entry for entry: eliminating k subtracts a piece of
// row k from row i without looking up a single index.
//
// The masses given to the parent in inverse_dynamics_sweeps.h move no less with it than with the
// body, so M is that of these moments as well; c and Σ pass pins and balls without mass.
//
// O(n d²) for n dofs of depth d, O(n d) memory.

#include <momenta/core/kernel/inverse_dynamics_sweeps.h>

#include <limits>
#include <vector>

namespace momenta {

/// c and Σ of a subtree about O, the mass apart.
template <class S>
struct CompositeMoments {
  S x, y, z, xx, xy, xz, yy, yz, zz;
};
template <class S>
MOMENTA_INLINE void add(CompositeMoments<S>& a, const CompositeMoments<S>& b) {
  a.x = a.x + b.x;
  a.y = a.y + b.y;
  a.z = a.z + b.z;
  a.xx = a.xx + b.xx;
  a.xy = a.xy + b.xy;
  a.xz = a.xz + b.xz;
  a.yy = a.yy + b.yy;
  a.yz = a.yz + b.yz;
  a.zz = a.zz + b.zz;
}
/// + those of the body itself; on a pin c_z = Σ_zz = 0.
template <bool pin, class S>
MOMENTA_INLINE void add_body(CompositeMoments<S>& a, const MassMoments<S>& b) {
  a.x = a.x + b.c[0];
  a.y = a.y + b.c[1];
  a.xx = a.xx + b.s[0];
  a.xy = a.xy + b.s[1];
  a.xz = a.xz + b.s[2];
  a.yy = a.yy + b.s[3];
  a.yz = a.yz + b.s[4];
  if constexpr (!pin) {
    a.z = a.z + b.c[2];
    a.zz = a.zz + b.s[5];
  }
}
template <class S>
MOMENTA_INLINE void set_body(CompositeMoments<S>& a, const MassMoments<S>& b) {
  a = {S(b.c[0]), S(b.c[1]), S(b.c[2]), S(b.s[0]), S(b.s[1]),
       S(b.s[2]), S(b.s[3]), S(b.s[4]), S(b.s[5])};
}

/// The pin's own screw, inward.
template <class S>
MOMENTA_INLINE void screw_z(CompositeMoments<S>& m, const S& c, const S& s, double d) {
  const S ss = s * s, cs = c * s;
  const S difference = m.xx - m.yy, twice = m.xy + m.xy;
  const S t = ss * difference + cs * twice, u = cs * difference - ss * twice;
  m.xx = m.xx - t;
  m.yy = m.yy + t;
  m.xy = m.xy + u;
  turn_inward_z(c, s, m.xz, m.yz);
  turn_inward_z(c, s, m.x, m.y);
  const S dz = d * m.z;
  m.xz = m.xz + d * m.x;
  m.yz = m.yz + d * m.y;
  m.zz = m.zz + (dz + dz);
}
/// The screw about x to the parent.
template <class S>
MOMENTA_INLINE void screw_x(CompositeMoments<S>& m, const Link& l) {
  switch (l.turn) {
    case Turn::right: {
      const S yy = m.yy;
      m.yy = m.zz;
      m.zz = yy;
      m.yz = -m.yz;
      break;
    }
    case Turn::parallel:  // by 0 or 180°
      break;
    default: {
      const S difference = m.yy - m.zz;
      const S t = l.ss * difference + l.cs2 * m.yz, u = l.cs * difference - l.ss2 * m.yz;
      m.yy = m.yy - t;
      m.zz = m.zz + t;
      m.yz = m.yz + u;
    }
  }
  turn_inward_x(l, m.xy, m.xz);
  turn_inward_x(l, m.y, m.z);
  const S ax = l.a * m.x;
  m.xx = m.xx + (ax + ax);
  m.xy = m.xy + l.a * m.y;
  m.xz = m.xz + l.a * m.z;
}

template <class Space, class S>
class CompositeSweeps;

template <class S>
class CompositeSweeps<Spatial, S> {
 public:
  using Space = Spatial;
  explicit CompositeSweeps(const LinkTree& tree);

  /// u̇ (nv) from (q, u, t) and all generalised forces τ (nv) but the weights'. In and Out index
  /// like pointers to S. False when M is not positive definite: stuck(). O(dofs · depth²).
  template <class In, class InTau, class Out>
  bool operator()(const S& t, const In& q, const In& u, const InTau& tau, Out udot) {
    dynamics_.place(t, q);
    stuck_ = tree_->stuck;
    if (stuck_ >= 0) return false;
    dynamics_.bias(u, right_.data());
    for (std::size_t i = 0; i < dofs_.size(); ++i) right_[i] = tau[static_cast<int>(i)] - right_[i];
    axes_outward();
    rows_inward();
    if (!eliminate()) return false;
    solve(udot);
    return true;
  }

  /// Calls entry(row, column, value) for the upper triangle of M at (q, t), once for every pair of
  /// dofs on one path to the root. O(dofs · depth).
  template <class In, class Entry>
  void mass_matrix(const S& t, const In& q, Entry&& entry) {
    dynamics_.place(t, q);
    axes_outward();
    rows_inward();
    for (std::size_t k = 0; k < dofs_.size(); ++k)
      for (int p = 0; p <= dofs_[k].depth; ++p)
        entry(way_[start(k) + static_cast<std::size_t>(p)].dof, static_cast<int>(k),
              rows_[start(k) + static_cast<std::size_t>(p)]);
  }

  int stuck() const { return stuck_; }
  /// Entries M has room for: of one triangle.
  std::size_t entries() const { return rows_.size(); }

 private:
  struct Dof {
    int body, depth;    ///< depth: number of dofs on the way to the root
    std::size_t start;  ///< of its row
  };
  struct Ancestor {
    int dof;
  };
  /// What the way inward wants of a body, in the tree's axes.
  struct Station {
    Vec3<S> step, Z, X, Y;
  };
  struct Place {
    int parent;
    LinkKind kind;
    int u, nv;
  };
  struct Column {
    S fx, fy, fz, nx, ny, nz;
  };

  void axes_outward();
  void rows_inward();
  bool eliminate();
  template <class Out>
  void solve(Out udot);
  void inward_from(std::size_t k, Column F, S* row) const;
  __attribute__((noinline)) void any_axes(std::size_t k);
  __attribute__((noinline)) void any_rows(std::size_t k, const CompositeMoments<S>& m);
  __attribute__((noinline)) void any_inward(std::size_t k, CompositeMoments<S>& m) const;
  std::size_t start(std::size_t dof) const { return dofs_[dof].start; }
  const Model<Spatial>::Body& body(std::size_t k) const { return tree_->model->bodies[k]; }

  const LinkTree* tree_;
  InverseDynamicsSweeps<Spatial, S> dynamics_;
  std::vector<Dof> dofs_;
  std::vector<Ancestor> way_;  ///< laid out as rows_: the dof of each entry
  std::vector<Place> places_;
  std::vector<Station> stations_;
  std::vector<CompositeMoments<S>> slots_;
  std::vector<S> rows_, right_, scale_;
  int stuck_ = -1;
};

template <class S>
CompositeSweeps<Spatial, S>::CompositeSweeps(const LinkTree& tree)
    : tree_(&tree),
      dynamics_(tree),
      dofs_(static_cast<std::size_t>(tree.model->nv)),
      places_(tree.links.size()),
      stations_(tree.links.size()),
      slots_(static_cast<std::size_t>(tree.slots)),
      right_(dofs_.size()),
      scale_(dofs_.size()) {
  std::vector<Ancestor> last(places_.size());  // dof nearest to the body on its way to the root
  std::size_t entries = 0;
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const auto& b = body(k);
    places_[k] = {b.parent, tree.links[k].kind, b.u, b.nv};
    int before = b.parent < 0 ? -1 : last[static_cast<std::size_t>(b.parent)].dof;
    for (int i = b.u; i < b.u + b.nv; before = i++) {
      const int depth = before < 0 ? 0 : dofs_[static_cast<std::size_t>(before)].depth + 1;
      dofs_[static_cast<std::size_t>(i)] = {static_cast<int>(k), depth, entries};
      entries += static_cast<std::size_t>(depth) + 1;
    }
    last[k].dof = before;
  }
  way_.resize(entries);
  rows_.resize(entries);
  for (std::size_t k = 0; k < dofs_.size(); ++k) {
    const auto depth = static_cast<std::size_t>(dofs_[k].depth);
    way_[start(k) + depth].dof = static_cast<int>(k);
    if (depth == 0) continue;
    // The parent's way is this one's up to itself: it is the one before in the same joint, or the
    // last of the nearest ancestor that has any.
    const auto here = static_cast<std::size_t>(dofs_[k].body);
    const bool inside = static_cast<int>(k) > body(here).u;
    const int parent =
        inside ? static_cast<int>(k) - 1 : last[static_cast<std::size_t>(body(here).parent)].dof;
    for (std::size_t p = 0; p < depth; ++p)
      way_[start(k) + p] = way_[start(static_cast<std::size_t>(parent)) + p];
  }
}

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
    } else if (!is_plain_pin(l)) {
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
  if (l.kind == LinkKind::ball) {
    const auto& r = tree_->balls[static_cast<std::size_t>(l.record)].origin;
    at.origin = at.axes * Vec3<S>{{S(r[0]), S(r[1]), S(r[2])}};
    at.axes = at.axes * dynamics_.ball_axes(l);
  } else {
    at = Spatial::pose_outward(b.edge, b.kind, dynamics_.edge(k), at);
  }
  stations_[k] = {at.origin, at.axes.column(2), at.axes.column(0), at.axes.column(1)};
}

/// Entries of one column of M at the ancestors of body k, F about its O. `row` points past them.
template <class S>
MOMENTA_INLINE void CompositeSweeps<Spatial, S>::inward_from(std::size_t k, Column F,
                                                             S* row) const {
  const Place* places = places_.data();
  for (int parent = places[k].parent; parent >= 0; parent = places[k].parent) {
    const Vec3<S>& r = stations_[k].step;
    k = static_cast<std::size_t>(parent);
    const Place& at = places[k];
    F.nz = F.nz + (r[0] * F.fy - r[1] * F.fx);
    if (at.parent < 0 && at.kind == LinkKind::pin) {  // Z = (0, 0, 1)
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
    if (at.kind == LinkKind::pin) {
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
    if (l.tip)
      set_body(m, own);
    else if (l.kind == LinkKind::pin)
      add_body<true>(m, own);
    else
      add_body<false>(m, own);
    if (l.slot >= 0) add(m, slots_[static_cast<std::size_t>(l.slot)]);
    if (l.kind != LinkKind::pin) {
      const CompositeMoments<S> here = m;
      any_rows(k, here);
    } else {
      const auto dof = static_cast<std::size_t>(l.u);
      const auto depth = static_cast<std::size_t>(dofs_[dof].depth);
      S* row = rows_.data() + start(dof) + depth;
      const S turning = m.xx + m.yy;
      *row = turning;
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
    if (is_plain_pin(l)) {
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
    for (int i = 0; i <= column; ++i) row[i] = own[i];
    // What rounding may leave of an entry is as large as the joint's largest.
    scale_[dof] = b.nv == 1 ? own[0] : b.nv == 6 && column < 3 ? mass : Jx + Jy + Jz;
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
  if (l.kind == LinkKind::ball) {
    const auto& r = tree_->balls[static_cast<std::size_t>(l.record)].origin;
    turn_by(dynamics_.ball_axes(l));
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

// Eliminating dof k, with its entries a_i = M_ki / M_kk:  M_ij −= a_i M_kj for all ancestors j ≤ i,
// right_i −= a_i right_k. What stays in its row are L and 1 / D.
template <class S>
bool CompositeSweeps<Spatial, S>::eliminate() {
  constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
  S* rows = rows_.data();
  S* right = right_.data();
  for (std::size_t k = dofs_.size(); k-- > 0;) {
    S* __restrict row = rows + start(k);
    const Ancestor* way = way_.data() + start(k);
    const auto depth = static_cast<std::size_t>(dofs_[k].depth);
    if (!all_positive(row[depth] - rounding * scale_[k])) {
      stuck_ = dofs_[k].body;
      return false;
    }
    const S inverse = S(1.0) / row[depth], own = right[k];
    row[depth] = inverse;
    for (std::size_t p = depth; p-- > 0;) {
      const auto i = static_cast<std::size_t>(way[p].dof);
      const S a = row[p] * inverse;
      S* __restrict to = rows + start(i);
      for (std::size_t j = 0; j <= p; ++j) to[j] = to[j] - a * row[j];
      row[p] = a;
      right[i] = right[i] - a * own;
    }
  }
  return true;
}

template <class S>
template <class Out>
void CompositeSweeps<Spatial, S>::solve(Out udot) {
  for (std::size_t k = 0; k < dofs_.size(); ++k) {
    const S* row = rows_.data() + start(k);
    const Ancestor* way = way_.data() + start(k);
    const auto depth = static_cast<std::size_t>(dofs_[k].depth);
    S x = right_[k] * row[depth];
    for (std::size_t p = 0; p < depth; ++p)
      x = x - row[p] * right_[static_cast<std::size_t>(way[p].dof)];
    right_[k] = x;
    udot[static_cast<int>(k)] = x;
  }
}

}  // namespace momenta
