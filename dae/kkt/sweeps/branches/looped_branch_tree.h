#pragma once
// Branches of one shape as one mechanism whose constants are packs, a branch in each lane of S, in
// place of LinkTree and LoopModel in spatial_loop_sweeps.h. Body 0 is the one the branches fold
// into, which is swept elsewhere.

#include <momenta/core/kernel/branches/branch_link.h>
#include <momenta/core/kernel/general_joint.h>
#include <momenta/dae/kkt/sweeps/branches/looped_branches.h>
#include <momenta/dae/mechanism/loop/loops_in_time.h>

#include <array>

namespace momenta {

template <class S>
struct LoopedBranchTree {
  struct Link : BranchLink<S> {
    LinkKind kind = LinkKind::revolute;
    int parent = -1, record = -1, q = 0, u = 0;
    bool one_axis = false;
  };
  struct Body {
    typename BranchLink<S>::Edge edge;
    JointKind kind = JointKind::revolute;
    int nv = 1, q = 0, u = 0;
    static constexpr int drive = -1;
    static constexpr double pitch = 0;
    S subtree_mass, theta0, d0, stiffness, rest, damping, torque, friction, friction_rate, rotor;
    bool with_rotor = false, is_curved = false;
    bool has_rotor() const { return with_rotor; }
  };
  struct Model {
    std::vector<Body> bodies;
    Vec3<double> gravity;
    bool has_gravity = false;
  };

  LoopedBranchTree(const LinkTree& tree, const LoopedBranchGroup& group);
  LoopedBranchTree(const LoopedBranchTree&) = delete;
  LoopedBranchTree& operator=(const LoopedBranchTree&) = delete;

  Model own;
  const Model* model = &own;
  std::vector<Link> links;
  std::vector<S> theta0;
  std::vector<Vec3<S>> weight;
  std::vector<SphericalPlace> sphericals;  ///< none
  int slots = 0, records = 0, users = 0, singular_joint = -1;
};

template <class S>
LoopedBranchTree<S>::LoopedBranchTree(const LinkTree& tree, const LoopedBranchGroup& group)
    : links(static_cast<std::size_t>(group.bodies) + 1),
      theta0(links.size()),
      weight(links.size()) {
  own.bodies.resize(links.size());
  own.gravity = tree.model->gravity;
  own.has_gravity = tree.model->has_gravity;
  for (int k = 1; k <= group.bodies; ++k) {
    const auto at = static_cast<std::size_t>(k);
    Link& l = links[at];
    Body& b = own.bodies[at];
    l.slot = l.parent_slot = -1;
    l.root = k == 1;
    l.first = !l.root;
    l.leaf = k == group.bodies;
    l.opens = l.screwed = l.has_force = l.is_curved = l.has_rotor = false;
    l.parent = l.root ? -1 : k - 1;
    l.q = l.u = b.q = b.u = k - 1;
    for (int lane = 0; lane < group.lanes; ++lane) {
      const auto link =
          static_cast<std::size_t>(group.roots[static_cast<std::size_t>(lane)]) + at - 1;
      const momenta::Link& from = tree.links[link];
      const auto& body = tree.model->bodies[link];
      if (lane == 0) {
        l.turn = from.turn;
        l.kind = from.kind;
        l.one_axis = from.one_axis;
        b.kind = body.kind;
      }
      l.turn = common_turn(l.turn, from.turn);
      l.screwed |= from.screwed;
      l.has_force |= from.has_force;
      l.is_curved |= body.is_curved;
      l.has_rotor |= from.has_rotor;
      l.take(from, body, tree.theta0[link], lane);
      b.subtree_mass.set_lane(lane, body.subtree_mass);
      b.theta0.set_lane(lane, body.theta0);
      b.d0.set_lane(lane, body.d0);
      for (int i = 0; i < 3; ++i) weight[at][i].set_lane(lane, tree.weight[link][i]);
    }
    if (l.kind != LinkKind::revolute) l.record = records++;
    l.edge.about_z = l.screwed;
    l.edge.about_x = true;
    l.edge.about_y = l.turn == Turn::tilted;
    theta0[at] = l.theta0;
    b.edge = l.edge;
    b.stiffness = l.stiffness;
    b.rest = l.rest;
    b.damping = l.damping;
    b.torque = l.torque;
    b.friction = l.friction;
    b.friction_rate = l.friction_rate;
    b.is_curved = l.is_curved;
    b.rotor = l.rotor;
    b.with_rotor = l.has_rotor;
  }
}

/// place_links of core/kernel/place_links.h for revolute joints and prismatic joints without
/// drives.
template <class S, class In, class Axes>
void place_links(const LoopedBranchTree<S>& tree, const S&, const In& q, Angles<S>& angles,
                 std::vector<JointRecord<Spatial, S>>& joints, std::vector<UserRecord<S>>&, Axes&&,
                 std::size_t) {
  angles.set(0, S(0.0));
  for (std::size_t k = 1; k < tree.links.size(); ++k) {
    const auto& l = tree.links[k];
    const auto& b = tree.model->bodies[k];
    if (l.kind == LinkKind::revolute) {
      angles.set(k, q[l.q] + tree.theta0[k]);
    } else {
      joints[static_cast<std::size_t>(l.record)].edge.d = q[l.q] + b.d0;
      angles.set(k, b.theta0);
    }
  }
  angles.turn();
  for (std::size_t k = 1; k < tree.links.size(); ++k) {
    if (tree.links[k].kind == LinkKind::revolute) continue;
    auto& edge = joints[static_cast<std::size_t>(tree.links[k].record)].edge;
    edge.cos_theta = angles.cosine(k);
    edge.sin_theta = angles.sine(k);
  }
}

/// Loops between the branches and body 0. Names as in LoopModel.
template <class S>
struct LoopedBranchLoops {
  struct Loop {
    int a = -1, b = -1, row = 0, rows = 0;
    Vec3<S> at_a, at_b;
    std::array<Vec3<S>, 3> axis_a, axis_b;
    std::array<int, 3> points{};
    int n_points = 0;
    std::array<std::pair<int, int>, 3> axes{};
    int n_axes = 0;
    S gamma, per_length, given, least_scale;
    bool distance = false;
    static constexpr int motion = -1;

    bool is_distance() const { return distance; }
    static constexpr bool is_coupler() { return false; }
    int first_rows() const { return distance ? 1 : n_points; }
  };
  std::vector<Loop> loops;
  std::array<int, 0> motions;
  int rows = 0;

  LoopedBranchLoops(const LoopModel<Spatial>& model, const LoopedBranchGroup& group);
};

template <class S>
LoopedBranchLoops<S>::LoopedBranchLoops(const LoopModel<Spatial>& model,
                                        const LoopedBranchGroup& group)
    : loops(static_cast<std::size_t>(group.loops)) {
  for (std::size_t i = 0; i < loops.size(); ++i) {
    Loop& l = loops[i];
    for (int lane = 0; lane < group.lanes; ++lane) {
      const auto n = static_cast<std::size_t>(lane);
      const auto& from = model.loops[static_cast<std::size_t>(
          group.loop[i * static_cast<std::size_t>(group.lanes) + n])];
      const auto here = [&](int body) {
        return body == group.onto ? 0 : body - group.roots[n] + 1;
      };
      if (lane == 0) {
        l.a = here(from.a);
        l.b = here(from.b);
        l.rows = from.rows;
        l.points = from.points;
        l.n_points = from.n_points;
        l.axes = from.axes;
        l.n_axes = from.n_axes;
        l.distance = from.is_distance();
      }
      const auto set = [lane](Vec3<S>& to, const Vec3<double>& x) {
        for (int j = 0; j < 3; ++j) to[j].set_lane(lane, x[j]);
      };
      set(l.at_a, from.at_a), set(l.at_b, from.at_b);
      for (std::size_t j = 0; j < 3; ++j)
        set(l.axis_a[j], from.axis_a[j]), set(l.axis_b[j], from.axis_b[j]);
      l.gamma.set_lane(lane, from.gamma);
      l.per_length.set_lane(lane, from.per_length);
      l.given.set_lane(lane, from.given);
      l.least_scale.set_lane(lane, from.least_scale);
    }
    l.row = rows;
    rows += l.rows;
  }
}

/// Nothing of branches depends on time.
template <class S>
class LoopedBranchLoopsInTime {
 public:
  explicit LoopedBranchLoopsInTime(const LoopedBranchLoops<S>& loops) : loops_(&loops) {}
  const LoopedBranchLoops<S>& at(double) const { return *loops_; }

 private:
  const LoopedBranchLoops<S>* loops_;
};

/// The loops that go with a tree.
template <class Tree>
struct LoopsOf {
  using Model = LoopModel<Spatial>;
  using InTime = LoopsInTime<Spatial>;
  static constexpr bool of_looped_branches = false;
};
template <class S>
struct LoopsOf<LoopedBranchTree<S>> {
  using Model = LoopedBranchLoops<S>;
  using InTime = LoopedBranchLoopsInTime<S>;
  static constexpr bool of_looped_branches = true;
};

}  // namespace momenta
