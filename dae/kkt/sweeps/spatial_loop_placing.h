#pragma once
// Before the sweeps in space: places of joints, bodies and loops and, in acceleration form, their
// motion. Part of spatial_loop_sweeps.h.

#include <momenta/dae/kkt/sweeps/spatial_loop_sweeps.h>

namespace momenta {

template <class S, int Rows, bool Momentum, class Tree>
template <class In>
bool SpatialLoopSweeps<S, Rows, Momentum, Tree>::place(const S& t, const In& q, const In& x,
                                                       const RightSide<S>& right) {
  place_links(
      *tree_, t, q, angles_, joints_,
      users_, [&](std::size_t record) -> auto& { return sphericals_[record].R; }, swept_);
  singular_joint_ = tree_->singular_joint;
  weak_looped_branch_ = false;
  even_ = true;
  compliance_ = right.compliance;
  if (singular_joint_ >= 0) return false;
  for (std::size_t k = 0; k < std::min(swept_, looped_branches_.size()); ++k)
    if (plan_->takes_branches[k]) looped_branches_[k] = {};
  pose_bodies();
  move_bodies(x, right);
  loops_ = &in_time_.at(value_of(t));
  place_loops(q, x, right);
  return true;
}

/// Points, axes and rows of all loops, d of couplers.
template <class S, int Rows, bool Momentum, class Tree>
template <class In>
void SpatialLoopSweeps<S, Rows, Momentum, Tree>::place_loops(const In& q, const In& x,
                                                             const RightSide<S>& right) {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (loop_elsewhere(i)) continue;
    const Loop& l = loops_->loops[i];
    if constexpr (!of_looped_branches)
      if (l.is_coupler()) {
        coupled_[i] = coupler_bias<Momentum>(*loops_, l, q, x, right);
        if constexpr (has_directions<S>)
          if (besides_) coupled_[i] = coupled_[i] + besides_[l.row];
        continue;
      }
    const LoopBody<S>*A = loop_body(l.a), *B = loop_body(l.b);
    places_[i].place(l, A, B);
    if constexpr (!of_looped_branches)
      if (l.motion >= 0) {
        const auto at = static_cast<std::size_t>(l.motion);
        moving_[at].place(l, loops_->motions[at], A, B);
      }
  }
}

/// The pose of a body on a joint about or along one axis, by the screws of its edge `k` and then
/// its own (c, s, d). Each screw mixes two of three columns, so that each row goes by itself, in
/// registers.
template <class Constants, class S>
MOMENTA_INLINE void pose_on_axis(const Constants& k, const S& c, const S& s, const S& d,
                                 const Spatial::Pose<S>& from, LoopBody<S>& to) {
  for (int i = 0; i < 3; ++i) {
    S x = from.axes(i, 0), y = from.axes(i, 1), z = from.axes(i, 2), step(0.0);
    const auto turn = [](S& first, S& second, const auto& cosine, const auto& sine)
                          MOMENTA_INLINED {
                            const S turned = cosine * first + sine * second;
                            second = cosine * second - sine * first;
                            first = turned;
                          };
    if (k.about_z) {
      step = step + k.delta * z;
      turn(x, y, k.cos_gamma, k.sin_gamma);
    }
    if (k.about_x) {
      step = step + k.a * x;
      turn(y, z, k.cos_alpha, k.sin_alpha);
    }
    if (k.about_y) turn(z, x, k.cos_beta, k.sin_beta);
    step = step + d * z;
    turn(x, y, c, s);
    to.pose.axes(i, 0) = x;
    to.pose.axes(i, 1) = y;
    to.pose.axes(i, 2) = z;
    to.step[i] = step;
    to.pose.origin[i] = from.origin[i] + step;
  }
}

/// Poses of the bodies on the ways of loops, in the axes of the bodies that close them.
template <class S, int Rows, bool Momentum, class Tree>
void SpatialLoopSweeps<S, Rows, Momentum, Tree>::pose_bodies() {
  Spatial::Pose<S> ground;
  ground.axes = identity3<S>();
  for (std::size_t k = 0; k < swept_; ++k) {
    if (plan_->posed[k] != OnWay::moved || elsewhere(k)) continue;
    const auto& l = tree_->links[k];
    const auto& from = l.parent < 0 ? ground : bodies_[static_cast<std::size_t>(l.parent)].pose;
    LoopBody<S>& to = bodies_[k];
    if (l.kind == LinkKind::revolute) {
      pose_on_axis(body(k).edge, angles_.cosine(k), angles_.sine(k), S(l.d), from, to);
    } else if (of_looped_branches || l.one_axis) {
      const auto& e = joints_[static_cast<std::size_t>(l.record)].edge;
      pose_on_axis(body(k).edge, e.cos_theta, e.sin_theta, e.d, from, to);
    } else {
      Spatial::Pose<S> at{from.axes, Vec3<S>{{S(0.0), S(0.0), S(0.0)}}};  // from the parent's O
      if (l.kind == LinkKind::spherical) {
        const auto record = static_cast<std::size_t>(l.record);
        const auto& r = tree_->sphericals[record].origin;
        at = {from.axes * sphericals_[record].R, from.axes * Vec3<S>{{S(r[0]), S(r[1]), S(r[2])}}};
      } else {
        at = Spatial::pose_outward(body(k).edge, body(k).kind,
                                   joints_[static_cast<std::size_t>(l.record)].edge, at);
      }
      to.step = at.origin;
      to.pose.axes = at.axes;
      to.pose.origin = from.origin + at.origin;
    }
  }
}

/// Acceleration form: velocities in ground axes, velocity products and bias wrenches of all bodies.
/// Momentum form: Ω_t of the driven joints.
template <class S, int Rows, bool Momentum, class Tree>
template <class In>
void SpatialLoopSweeps<S, Rows, Momentum, Tree>::move_bodies(const In& x,
                                                             const RightSide<S>& right) {
  if constexpr (Momentum) {
    if (joints_.empty()) return;
    if constexpr (!of_looped_branches)
      for (std::size_t k = 0; k < swept_; ++k) {
        const auto& l = tree_->links[k];
        if (l.kind != LinkKind::general || elsewhere(k)) continue;
        const auto record = static_cast<std::size_t>(l.record);
        any_[record].given = {};
        if (body(k).drive >= 0 && right.drives)
          Joint<Spatial>::add_motion(body(k), joints_[record].edge, &joints_[record].drive_rate,
                                     any_[record].given);
        if (body(k).law && right.drives) any_[record].given += joints_[record].user->motion.drift;
      }
  } else {
    // Ω in body axes, kept where the bodies' wrenches will be.
    const auto velocity = [&](std::size_t k) -> Force& { return wrenches_[k]; };
    for (std::size_t k = 0; k < swept_; ++k) {
      if (elsewhere(k)) continue;
      const auto& l = tree_->links[k];
      const auto& b = body(k);
      Motion V{}, own{}, product{};
      Vec3<S> step_product{};
      if (l.parent >= 0) {
        const Force& from = velocity(static_cast<std::size_t>(l.parent));
        V = {from.f, from.n};
      }
      // ω × (ω × r) of the parent's rotation, in the body's axes: cross(ω, velocity it gives O).
      Motion turning{{}, V.w};
      if (l.kind == LinkKind::revolute) {
        constants_outward(l, b.edge, V.v[0], V.v[1], V.v[2], V.w[0], V.w[1], V.w[2]);
        constants_outward(l, b.edge, turning.v[0], turning.v[1], turning.v[2], turning.w[0],
                          turning.w[1], turning.w[2]);
        // The revolute joint's screw without its turn: the product is wanted before it.
        V.v[0] = V.v[0] + l.d * V.w[1];
        V.v[1] = V.v[1] - l.d * V.w[0];
        turning.v[0] = turning.v[0] + l.d * turning.w[1];
        turning.v[1] = turning.v[1] - l.d * turning.w[0];
        const S rate = x[l.u];
        step_product = cross(V.w, turning.v);
        revolutes_[k].c = {step_product, {{V.w[1] * rate, -(V.w[0] * rate), S(0.0)}}};
        revolutes_[k].c.v[0] += l.d * (V.w[0] * rate);
        revolutes_[k].c.v[1] += l.d * (V.w[1] * rate);
        const S c = angles_.cosine(k), s = angles_.sine(k);
        momenta::turn_back<2>(V.v, c, s);
        momenta::turn_back<2>(V.w, c, s);
        V.w[2] += rate;
      } else if (!of_looped_branches && l.kind == LinkKind::spherical) {
        auto& w = sphericals_[static_cast<std::size_t>(l.record)];
        const auto& r = tree_->sphericals[static_cast<std::size_t>(l.record)].origin;
        const Vec3<S> step{{S(r[0]), S(r[1]), S(r[2])}};
        const Vec3<S> rate{{x[l.u], x[l.u + 1], x[l.u + 2]}};
        const Vec3<S> way = cross(V.w, step);
        w.c.v = transpose_times(w.R, cross(V.w, way));
        V = {transpose_times(w.R, V.v + way), transpose_times(w.R, V.w)};
        w.c.w = cross(V.w, rate);
        V.w += rate;
      } else {
        auto& j = joints_[static_cast<std::size_t>(l.record)];
        V = Spatial::to_child(b.edge, b.kind, j.edge, V);
        turning = Spatial::to_child(b.edge, b.kind, j.edge, turning);
        [[maybe_unused]] S rates[6]{};
        if constexpr (of_looped_branches) {
          own.v[2] = x[b.u];
        } else {
          for (int i = 0; i < b.nv; ++i) rates[i] = x[b.u + i];
          Joint<Spatial>::add_motion(b, j.edge, b.drive >= 0 ? &j.drive_rate : rates, own);
          if (b.law) {
            own += j.user->motion.drift;
            Joint<Spatial>::move(b, j.edge, static_cast<const S*>(rates));
          }
        }
        product = {cross(V.w, turning.v) + cross(S(2.0) * V.w + own.w, own.v), cross(V.w, own.w)};
        if constexpr (!of_looped_branches) {
          if (b.drive >= 0) Joint<Spatial>::add_motion(b, j.edge, &j.drive_acceleration, product);
          if (b.law)
            Joint<Spatial>::add_motion_rate(b, j.edge, static_cast<const S*>(rates), product);
        }
        any_[static_cast<std::size_t>(l.record)].given = product;
        V += own;
      }
      velocity(k) = {V.v, V.w};
      set_velocity(k, V);
    }
  }
}

}  // namespace momenta
