#pragma once
// Inverse dynamics (recursive Newton-Euler) in space, (q, u, u̇, t) → τ, in the frames of the other
// recursions: the forces of a motion, and the bias of composite_sweeps.h.
//
//   outward   ω, α of every body, a: acceleration of O. A point r of the body has a + K r,
//               K = α~ + ω~ ω~
//             so O of the child at r has R (a_L + K_L r). Own wrench about O, with c = ∫ r dm and
//             Σ = ∫ r rᵀ dm:
//               f = K c (and m a),  n = ∫ r × (a + K r) dm = c × a + axial(K Σ)
//             Σ = ½ tr(J) 1 − J stands for J: axial(K Σ) = J α + ω × J ω in one product.
//   inward    F_L += 𝒯ᶠ F,  τ = Eᵀ F
//
// Accelerations of points, not derivatives in body axes: linear velocities drop out. Gravity is an
// acceleration −g of the ground. Masses are regrouped first: mass_moments.h.

#include <momenta/core/kernel/acceleration_field.h>
#include <momenta/core/kernel/place_links.h>

#include <vector>

namespace momenta {

template <class Space, class S>
class InverseDynamicsSweeps;

template <class S>
class InverseDynamicsSweeps<Spatial, S> {
 public:
  using Space = Spatial;
  explicit InverseDynamicsSweeps(const LinkTree& tree)
      : tree_(&tree),
        angles_(tree.links.size()),
        moments_(regrouped<S>(tree)),
        wrenches_(tree.links.size()),
        axes_(tree.sphericals.size()),
        joints_(static_cast<std::size_t>(tree.records)),
        users_(static_cast<std::size_t>(tree.users)),
        origins_(joints_.size()),
        slots_(static_cast<std::size_t>(tree.slots)),
        outward_slots_(slots_.size()) {}

  /// τ (nv) = M u̇ + bias − weights from (q, u, u̇, t): all generalised forces but weights. In and
  /// Out index like pointers to S. O(bodies).
  template <class In, class InRate, class Out>
  void operator()(const S& t, const In& q, const In& u, const InRate& udot, Out tau) {
    place(t, q);
    outward<true>(u, udot);
    inward(tau);
    for (const auto& [u_at, rotor] : tree_->rotors) tau[u_at] = S(tau[u_at]) + rotor * udot[u_at];
  }

  /// Sines, cosines and edges at (q, t): for `bias` and for other users.
  template <class In>
  void place(const S& t, const In& q) {
    place_links(
        *tree_, t, q, angles_, joints_,
        users_, [&](std::size_t record) -> auto& { return axes_[record]; });
  }
  /// τ with u̇ = 0. @pre placed.
  template <class In, class Out>
  void bias(const In& u, Out tau) {
    outward<false>(u, u);
    inward(tau);
  }

  const Angles<S>& angles() const { return angles_; }
  const MassMoments<S>& moments(std::size_t k) const { return moments_[k]; }
  /// Axes of a spherical joint: child components to the parent's.
  const Mat3<S>& spherical_axes(const Link& l) const {
    return axes_[static_cast<std::size_t>(l.record)];
  }
  /// The edge of body k at this configuration; not for spherical joints.
  Spatial::Edge<S> edge(std::size_t k) const {
    const Link& l = tree_->links[k];
    if (l.kind == LinkKind::general) return joints_[static_cast<std::size_t>(l.record)].edge;
    Spatial::Edge<S> e;
    e.cos_theta = angles_.cosine(k);
    e.sin_theta = angles_.sine(k);
    e.d = S(l.d);
    return e;
  }

 private:
  template <bool moving, class In, class InRate>
  void outward(const In& u, const InRate& udot);
  template <class Out>
  void inward(Out tau);
  template <bool moving, class In, class InRate>
  __attribute__((noinline)) void any_outward(std::size_t k, const In& u, const InRate& udot,
                                             Spin<S>& spin);
  template <class Out>
  __attribute__((noinline)) void any_inward(std::size_t k, Out tau, PlainWrench<S>& w);
  std::size_t slot_of_parent(const Link& l) const {
    return static_cast<std::size_t>(tree_->links[static_cast<std::size_t>(l.parent)].slot);
  }

  struct Origins {
    Vec3<S> own, parent;  ///< accelerations of O and of the parent's O, each in its own axes
  };
  const LinkTree* tree_;
  Angles<S> angles_;
  std::vector<MassMoments<S>> moments_;
  std::vector<PlainWrench<S>> wrenches_;  ///< wrenches of the bodies alone
  std::vector<Mat3<S>> axes_;
  std::vector<JointRecord<Spatial, S>> joints_;
  std::vector<UserRecord<S>> users_;
  std::vector<Origins> origins_;
  std::vector<PlainWrench<S>> slots_;
  std::vector<Spin<S>> outward_slots_;
};

template <class S>
template <bool moving, class In, class InRate>
void InverseDynamicsSweeps<Spatial, S>::outward(const In& u, const InRate& udot) {
  const Link* links = tree_->links.data();
  const S zero(0.0);
  Spin<S> at{zero, zero, zero, zero, zero, zero, zero, zero, zero, zero, zero, zero};
  for (std::size_t k = 0; k < angles_.size(); ++k) {
    const Link& l = links[k];
    if (l.parent >= 0 && !l.first) at = outward_slots_[slot_of_parent(l)];
    if (!is_plain_revolute(l)) {
      Spin<S> here = at;
      any_outward<moving>(k, u, udot, here);
      at = here;
    } else {
      PlainWrench<S>& w = wrenches_[k];
      const S c = angles_.cosine(k), s = angles_.sine(k), own = u[l.u];
      if (l.parent < 0) {  // ω and α along the joint: only its moment remains
        const Vec3<double>& weight = tree_->weight[k];
        const MassMoments<S>& b = moments_[k];
        at = {zero,
              zero,
              own,
              -(c * weight[0] + s * weight[1]),
              s * weight[0] - c * weight[1],
              S(-weight[2]),
              zero,
              zero,
              zero,
              -(own * own),
              zero,
              zero};
        w.nz = b.c[0] * at.ay - b.c[1] * at.ax;
        if constexpr (moving) {
          at.ez = at.ky = udot[l.u];
          w.nz = w.nz + (b.s[0] + b.s[3]) * at.ez;
        }
      } else {
        at.ax = at.ax + l.a * at.kx;
        at.ay = at.ay + l.a * at.ky;
        at.az = at.az + l.a * at.kz;
        turn_outward_x(l, at.ay, at.az);
        turn_outward_x(l, at.oy, at.oz);
        turn_outward_x(l, at.ey, at.ez);
        // α = Rᵀ (α_L + ω_L × z u) + z u̇
        at.ex = at.ex + at.oy * own;
        at.ey = at.ey - at.ox * own;
        turn_outward_z(c, s, at.ax, at.ay);
        turn_outward_z(c, s, at.ox, at.oy);
        turn_outward_z(c, s, at.ex, at.ey);
        at.oz = at.oz + own;
        if constexpr (moving) at.ez = at.ez + udot[l.u];
        // A point on the axis is the child's as well.
        const auto K = acceleration_field(at.ox, at.oy, at.oz, at.ex, at.ey, at.ez);
        at.ax = at.ax + l.d * K.xz;
        at.ay = at.ay + l.d * K.yz;
        at.az = at.az + l.d * K.zz;
        own_wrench<true>(moments_[k], K, at.ax, at.ay, at.az, w);
        at.kx = K.xx;
        at.ky = K.yx;
        at.kz = K.zx;
      }
    }
    if (l.slot >= 0) outward_slots_[static_cast<std::size_t>(l.slot)] = at;
  }
}

// With W = (ω_L × r, ω_L) and A = (a_L + α_L × r, α_L) seen from the child, E u = (v, ω_j):
//   ω = ω_L + ω_j,  α = α_L + ω_L × ω_j + E u̇,  a = A_v + ω_L × W_v + (ω_L + ω) × v + E u̇
template <class S>
template <bool moving, class In, class InRate>
void InverseDynamicsSweeps<Spatial, S>::any_outward(std::size_t k, const In& u, const InRate& udot,
                                                    Spin<S>& spin) {
  const Link& l = tree_->links[k];
  const auto& b = tree_->model->bodies[k];
  const auto& g = tree_->model->gravity;
  Spatial::Motion<S> W{{}, {{spin.ox, spin.oy, spin.oz}}};
  Spatial::Motion<S> A{{{spin.ax, spin.ay, spin.az}}, {{spin.ex, spin.ey, spin.ez}}};
  if (l.parent < 0) {
    W = {};
    A = {{{S(-g[0]), S(-g[1]), S(-g[2])}}, {}};
  }
  const Vec3<S> parent = A.v;
  Spatial::Motion<S> own{}, rate{};
  if (l.kind == LinkKind::spherical) {
    const auto& r = tree_->sphericals[static_cast<std::size_t>(l.record)].origin;
    const Vec3<S> step{{S(r[0]), S(r[1]), S(r[2])}};
    const Mat3<S>& R = spherical_axes(l);
    W = {transpose_times(R, cross(W.w, step)), transpose_times(R, W.w)};
    A = {transpose_times(R, A.v + cross(A.w, step)), transpose_times(R, A.w)};
  } else {
    const auto e = edge(k);
    W = Spatial::to_child(b.edge, b.kind, e, W);
    A = Spatial::to_child(b.edge, b.kind, e, A);
  }
  if (b.drive >= 0) {
    const auto& x = joints_[static_cast<std::size_t>(l.record)];
    Joint<Spatial>::add_motion(b, x.edge, &x.drive_rate, own);
    Joint<Spatial>::add_motion(b, x.edge, &x.drive_acceleration, rate);
  } else {
    S rates[6]{};
    for (int i = 0; i < b.nv; ++i) rates[i] = u[b.u + i];
    const auto way = b.law ? edge(k) : Spatial::Edge<S>{};
    Joint<Spatial>::add_motion(b, way, rates, own);
    if (b.law) {
      own += way.own->drift;
      Joint<Spatial>::move(b, way, static_cast<const S*>(rates));
      Joint<Spatial>::add_motion_rate(b, way, static_cast<const S*>(rates), rate);
    }
    if constexpr (moving) {
      for (int i = 0; i < b.nv; ++i) rates[i] = udot[b.u + i];
      Joint<Spatial>::add_motion(b, way, rates, rate);
    }
  }
  const Vec3<S> omega = W.w + own.w;
  A += {cross(W.w, W.v) + cross(W.w + omega, own.v), cross(W.w, own.w)};
  A += rate;
  const auto K = acceleration_field(omega[0], omega[1], omega[2], A.w[0], A.w[1], A.w[2]);
  own_wrench<false>(moments_[k], K, A.v[0], A.v[1], A.v[2], wrenches_[k]);
  if (l.kind == LinkKind::general) origins_[static_cast<std::size_t>(l.record)] = {A.v, parent};
  spin = {omega[0], omega[1], omega[2], A.v[0], A.v[1], A.v[2],
          A.w[0],   A.w[1],   A.w[2],   K.xx,   K.yx,   K.zx};
}

template <class S>
template <class Out>
void InverseDynamicsSweeps<Spatial, S>::inward(Out tau) {
  const Link* links = tree_->links.data();
  PlainWrench<S> F{};
  for (std::size_t k = angles_.size(); k-- > 0;) {
    const Link& l = links[k];
    const PlainWrench<S>& own = wrenches_[k];
    const bool plain = is_plain_revolute(l);
    if (plain && l.parent < 0) {
      S moment = l.leaf ? own.nz : own.nz + F.nz;
      if (l.slot >= 0) moment = moment + slots_[static_cast<std::size_t>(l.slot)].nz;
      tau[l.u] = moment;
      continue;
    }
    if (l.leaf)
      F = own;
    else
      add(F, own);
    if (l.slot >= 0) add(F, slots_[static_cast<std::size_t>(l.slot)]);
    if (!plain) {
      PlainWrench<S> here = F;
      any_inward(k, tau, here);
      F = here;
      if (l.parent < 0) continue;
    } else {
      tau[l.u] = F.nz;
      const S c = angles_.cosine(k), s = angles_.sine(k);
      turn_inward_z(c, s, F.fx, F.fy);
      turn_inward_z(c, s, F.nx, F.ny);
      F.nx = F.nx - l.d * F.fy;
      F.ny = F.ny + l.d * F.fx;
      turn_inward_x(l, F.fy, F.fz);
      turn_inward_x(l, F.ny, F.nz);
      F.ny = F.ny - l.a * F.fz;
      F.nz = F.nz + l.a * F.fy;
    }
    if (l.first) continue;
    auto& slot = slots_[slot_of_parent(l)];
    if (l.opens)
      slot = F;
    else
      add(slot, F);
  }
}

// Mass on other joints stays theirs: its force m a is passed on with the rest, less the share m a_L
// that the parent itself will pass on.
template <class S>
template <class Out>
void InverseDynamicsSweeps<Spatial, S>::any_inward(std::size_t k, Out tau, PlainWrench<S>& w) {
  const Link& l = tree_->links[k];
  const auto& b = tree_->model->bodies[k];
  Spatial::Force<S> F{{{w.fx, w.fy, w.fz}}, {{w.nx, w.ny, w.nz}}};
  const S mass(b.subtree_mass);
  const bool general = l.kind == LinkKind::general;
  if (general) F.f += mass * origins_[static_cast<std::size_t>(l.record)].own;
  if (b.nv > 0) {
    S along[6];
    Joint<Spatial>::project(b, b.law ? edge(k) : Spatial::Edge<S>{}, F, along);
    for (int i = 0; i < b.nv; ++i) tau[b.u + i] = along[i];
  }
  if (l.parent < 0) return;
  if (l.kind == LinkKind::spherical) {
    const auto& r = tree_->sphericals[static_cast<std::size_t>(l.record)].origin;
    F = {spherical_axes(l) * F.f, spherical_axes(l) * F.n};
    F.n += cross(Vec3<S>{{S(r[0]), S(r[1]), S(r[2])}}, F.f);
  } else {
    F = Spatial::to_parent(b.edge, b.kind, edge(k), F);
  }
  if (general) F.f -= mass * origins_[static_cast<std::size_t>(l.record)].parent;
  w = {F.f[0], F.f[1], F.f[2], F.n[0], F.n[1], F.n[2]};
}

}  // namespace momenta
