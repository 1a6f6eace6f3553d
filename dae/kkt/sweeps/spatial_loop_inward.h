#pragma once
// The inward sweep in space: fronts gathered and loops closed; spatial_loop_joints.h eliminates the
// joints. Part of spatial_loop_sweeps.h.

#include <momenta/dae/kkt/sweeps/spatial_loop_sweeps.h>

namespace momenta {

/// Enters ends of loops on body k.
template <class S, int Rows, bool Momentum, class Tree>
void SpatialLoopSweeps<S, Rows, Momentum, Tree>::enter(std::size_t k, const LoopPlan::Range& range,
                                                       const RightSide<S>& right, Carried& a) {
  for (int i = range.first; i < range.last; ++i)
    enter(k, plan_->ends[static_cast<std::size_t>(i)], right, a);
}

template <class S, int Rows, bool Momentum, class Tree>
void SpatialLoopSweeps<S, Rows, Momentum, Tree>::enter(std::size_t k, const LoopPlan::End& end,
                                                       const RightSide<S>& right, Carried& a) {
  const auto loop = static_cast<std::size_t>(end.loop);
  const Loop& l = loops_->loops[loop];
  const SpatialLoopPlace<S>& s = places_[loop];
  const auto& axes = bodies_[k].pose.axes;
  const int slot = plan_->slot[loop];
  const S sign(end.on_a ? 1.0 : -1.0);
  const Vec3<S> arm = transpose_times(axes, end.on_a ? s.ra : s.rb);
  Vec3<S> centre_force{}, centre_couple{};
  for (int row = 0; row < l.first_rows(); ++row) {
    // The b_j are constant in B.
    const Vec3<S> f =
        end.on_a || l.is_distance()
            ? transpose_times(axes, sign * s.F[row])
            : sign *
                  in_ground<S>(
                      nullptr,
                      l.axis_b[static_cast<std::size_t>(l.points[static_cast<std::size_t>(row)])]);
    const Vec3<S> n = cross(arm, f);
    for (int j = 0; j < 3; ++j) {
      a.blocks.C[j].add(slot + row, f[j]);
      a.blocks.C[3 + j].add(slot + row, n[j]);
    }
    if (right.centre) {
      centre_force += right.centre[l.row + row] * f;
      centre_couple += right.centre[l.row + row] * n;
    }
  }
  for (int row = l.first_rows(); row < l.rows; ++row) {
    const Vec3<S> n = transpose_times(axes, sign * s.c[row]);
    for (int j = 0; j < 3; ++j) a.blocks.C[3 + j].add(slot + row, n[j]);
    if (right.centre) centre_couple += right.centre[l.row + row] * n;
  }
  if (right.centre) add_remainder(a.articulated, Force{centre_force, centre_couple});
  if (end.first) enter_right_side(loop, right, a.blocks.d);
}

/// d of a loop's rows: positions, prescribed motion, velocity products.
template <class S, int Rows, bool Momentum, class Tree>
void SpatialLoopSweeps<S, Rows, Momentum, Tree>::enter_right_side(std::size_t loop,
                                                                  const RightSide<S>& right,
                                                                  Column& d) {
  const Loop& l = loops_->loops[loop];
  const SpatialLoopPlace<S>& s = places_[loop];
  const int slot = plan_->slot[loop];
  if constexpr (has_directions<S>)
    if (besides_)
      for (int row = 0; row < l.rows; ++row) d.add(slot + row, besides_[l.row + row]);
  if (right.positions != 0)
    for (int row = 0; row < l.rows; ++row) d.add(slot + row, right.positions * s.position(l, row));
  if constexpr (Momentum) {
    if (l.motion < 0 || !right.drives) return;
    for (int row = 0; row < l.rows; ++row) d.add(slot + row, s.moving_rate(l, prescribed(l), row));
  } else {
    const auto rates = rates_of(l, s);
    const LoopBody<S>*A = loop_body(l.a), *B = loop_body(l.b);
    const Vec3<S> apart = s.apart_bias(rates);
    const auto& g = tree_->model->gravity;
    for (int row = 0; row < l.rows; ++row) {
      S bias = l.motion < 0 ? s.bias(l, rates, apart, row)
                            : s.moving_bias(l, A, B, prescribed(l), rates, row);
      if (right.alpha != 0 || right.beta != 0)
        bias += (2 * right.alpha) * s.velocity(l, rates, row) +
                (right.beta * right.beta) * s.position(l, row);
      // The ground falls upward too: its end of the row accelerates with −g.
      if (row < l.first_rows() && (l.a < 0 || l.b < 0)) {
        const S along = s.F[row][0] * g[0] + s.F[row][1] * g[1] + s.F[row][2] * g[2];
        if (l.b < 0) bias += along;
        if (l.a < 0) bias -= along;
      }
      d.add(slot + row, bias);
    }
  }
}

/// Closes the loops of a branch that has been eliminated down to the ground into the body they tie
/// it to: r = JᵀΩ_L − W σ + d with the branch's W and d.
template <class S, int Rows, bool Momentum, class Tree>
void SpatialLoopSweeps<S, Rows, Momentum, Tree>::fold(std::size_t root, const RightSide<S>& right,
                                                      Carried& looped_branch) {
  const auto onto = static_cast<std::size_t>(plan_->folded_onto[root]);
  const LoopPlan::Range range = plan_->gathered_closings_of[root];
  looped_branch.articulated = {};
  for (Column& c : looped_branch.blocks.C) c = {};
  for (int i = range.first; i < range.last; ++i) {
    const int loop = plan_->closings[static_cast<std::size_t>(i)];
    const bool on_a = loops_->loops[static_cast<std::size_t>(loop)].a == static_cast<int>(onto);
    enter(onto, {loop, on_a, false}, right, looped_branch);
  }
  for (int i = range.first; i < range.last; ++i) {
    const int loop = plan_->closings[static_cast<std::size_t>(i)];
    close(loop, looped_branch, right.fade, open_slots_.fronts[root].open);
    const Loop& l = loops_->loops[static_cast<std::size_t>(loop)];
    for (int row = 0; row < l.rows; ++row) {
      const Row& closed = rows_[static_cast<std::size_t>(l.row + row)];
      weak_looped_branch_ |= !all_positive(closed.w - S(10.0) * closed.tau);
    }
  }
  add<Momentum>(looped_branches_[onto], looped_branch.articulated);
}

template <class S, int Rows, bool Momentum, class Tree>
void SpatialLoopSweeps<S, Rows, Momentum, Tree>::close(int loop, Carried& a, double fade,
                                                       SlotGroups all) {
  const Loop& l = loops_->loops[static_cast<std::size_t>(loop)];
  const int points = l.first_rows();
  a.blocks.begin(false, ~all);
  if (compliance_)
    soften(a.blocks, plan_->slot[static_cast<std::size_t>(loop)], l.rows, compliance_ + l.row);
  const int slot = plan_->slot[static_cast<std::size_t>(loop)];
  Row* const records = &rows_[static_cast<std::size_t>(l.row)];
  const SpatialWeight<S, Articulated<S>> weight{a.articulated};
  const auto closed_beside = [&]<Beside beside>() {
    return close_loop<beside>(a.blocks, slot, points, l.rows - points, S(l.least_scale), fade,
                              records, weight);
  };
  const bool alone = open_slots_.beside[static_cast<std::size_t>(loop)] == 0;
  if (alone && &a == &ground_)
    even_ &= closed_beside.template operator()<Beside::none_at_ground>();
  else if (alone && Column::apart)
    even_ &= closed_beside.template operator()<Beside::none>();
  else  // one state's rows go in all lanes at once: nothing is saved
    even_ &= closed_beside.template operator()<Beside::others>();
}

template <class S, int Rows, bool Momentum, class Tree>
template <class In>
bool SpatialLoopSweeps<S, Rows, Momentum, Tree>::inward(const In& r, const RightSide<S>& right) {
  const auto* links = tree_->links.data();
  // A pack's front is thousands of bytes, and is not cleared: what leaves do not begin anew is not
  // read. At the ground C must stay zero.
  Carried &a = front_, &ground = ground_;
  if constexpr (!of_looped_branches) {
    ground.articulated = {};
    if constexpr (Column::apart)
      for (Column& c : ground.blocks.C) c = {};
    else
      ground.blocks = {};
  }
  for (std::size_t k = swept_; k-- > 0;) {
    if (elsewhere(k)) continue;
    const auto& l = links[k];
    const OpenSlots::Front& front = open_slots_.fronts[k];
    a.blocks.begin(l.leaf, front.fresh);
    if (l.leaf) {
      Articulated<S>& m = a.articulated;
      set_body(m.M, l);
      m.Dfx = m.Dfy = m.Dfz = m.Dnx = m.Dny = m.Dnz = m.Gx = m.Gy = m.Gz = S(0.0);
    } else {
      add_body(a.articulated.M, l);
    }
    if constexpr (Momentum) {
      a.articulated.Gx = a.articulated.Gx + l.moment[0];
      a.articulated.Gy = a.articulated.Gy + l.moment[1];
      a.articulated.Gz = a.articulated.Gz + l.moment[2];
    } else {
      const Vec3<S>& w = wrenches_[k].n;  // ω × (ω × m c), ω × J ω
      const Vec3<S> mc{{S(l.c[0]), S(l.c[1]), S(l.c[2])}};
      const Vec3<S> Jw{{l.J[0] * w[0] + l.J[1] * w[1] + l.J[2] * w[2],
                        l.J[1] * w[0] + l.J[3] * w[1] + l.J[4] * w[2],
                        l.J[2] * w[0] + l.J[4] * w[1] + l.J[5] * w[2]}};
      const Vec3<S> f = cross(w, cross(w, mc)), n = cross(w, Jw);
      add_remainder(a.articulated, Force{f, n});
    }
    if (l.slot >= 0) {
      const Carried& slot = slots_[static_cast<std::size_t>(l.slot)];
      add<Momentum>(a.articulated, slot.articulated);
      if (front.slot) a.blocks.add(slot.blocks, front.slot);
    }
    if (plan_->takes_branches[k]) add<Momentum>(a.articulated, looped_branches_[k]);
    enter(k, plan_->own_ends_of[k], right, a);
    const LoopPlan::Range closing = plan_->closings_of[k];
    for (int i = closing.first; i < closing.last; ++i)
      close(plan_->closings[static_cast<std::size_t>(i)], a, right.fade, front.all);
    bool moves = true;
    if (l.kind == LinkKind::revolute)
      moves = revolute_inward(k, r, right, a);
    else if (of_looped_branches || l.one_axis)
      moves = axis_inward(k, r, right, a);
    else if constexpr (!of_looped_branches)
      moves = l.kind == LinkKind::spherical ? spherical_inward(k, r, a)
              : body(k).law                 ? user_inward(k, r, a)
                                            : free_inward(k, r, a);
    if (!moves) {
      singular_joint_ = static_cast<int>(k);
      return false;
    }
    if (l.parent < 0 && plan_->folded_onto[k] >= 0) {
      fold(k, right, a);
    } else if (l.parent < 0) {
      if (Column::apart || front.open)
        ground.blocks.add_at_ground(a.blocks, front.open, front.gathered_fresh, front.gathered);
      const LoopPlan::Range last = plan_->gathered_closings_of[k];
      for (int i = last.first; i < last.last; ++i)
        close(plan_->closings[static_cast<std::size_t>(i)], ground, right.fade, front.gathered);
    } else if (!l.first) {
      const auto parent = static_cast<std::size_t>(l.parent);
      Carried& slot = slots_[static_cast<std::size_t>(links[parent].slot)];
      leave<Momentum>(l, slot.articulated, a.articulated);
      slot.blocks.begin(l.opens && open_slots_.fronts[parent].brought, front.gathered_fresh);
      if (front.open) slot.blocks.add(a.blocks, front.open);
      const LoopPlan::Range last = plan_->gathered_closings_of[k];
      if (last.first == last.last) continue;
      enter(parent, plan_->gathered_ends_of[k], right, slot);
      for (int i = last.first; i < last.last; ++i)
        close(plan_->closings[static_cast<std::size_t>(i)], slot, right.fade, front.gathered);
    }
  }
  return true;
}

}  // namespace momenta
