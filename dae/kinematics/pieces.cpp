#include <momenta/core/scene/kinds.h>
#include <momenta/dae/kinematics/pieces.h>

#include <algorithm>
#include <map>
#include <numeric>

namespace momenta {

std::string Tie::in_words() const {
  return (joint ? "joint '" + joint->name : "loop '" + loop->name) + "' of kind " +
         std::string(joint ? reading::name_of(joint->kind) : reading::name_of(loop->kind));
}

Pieces::Pieces(const Mechanism& mechanism, const std::vector<bool>& held) {
  const Tree& tree = mechanism.tree();
  const Scene& scene = mechanism.scene();
  joined_.resize(tree.bodies.size() + 1);
  std::iota(joined_.begin(), joined_.end(), 0);
  const auto join = [&](int a, int b) {
    joined_[static_cast<std::size_t>(of(std::max(a, b)))] = of(std::min(a, b));
  };
  const auto is_driven = [&](const LoopSpec& l) {
    return std::any_of(scene.drives.begin(), scene.drives.end(),
                       [&](const DriveSpec& d) { return d.loop == l.name && d.origin.empty(); });
  };
  for (const JointSpec& j : scene.joints) {
    Tie tie;
    tie.joint = &j;
    tie.parent = tree.body(j.parent);
    tie.child = tree.body(j.child);
    int all = 0, loose = 0;  // rates
    for (int k = tree.first_part(tie.child); k <= tie.child; ++k) {
      const Tree::Body& b = tree.bodies[static_cast<std::size_t>(k)];
      all += std::max(b.nv, 1);
      for (int u = b.u; u < b.u + b.nv; ++u) loose += !held[static_cast<std::size_t>(u)];
    }
    if (loose == 0 && j.kind != JointKind::user) {
      join(tie.parent, tie.child);
      continue;
    }
    tie.in_part = loose < all;
    if (!tie.in_part && j.kind == JointKind::free) continue;
    if (!tie.in_part && j.kind == JointKind::spherical) tie.kind = Tie::Kind::ball;
    if (!tie.in_part && j.kind == JointKind::universal) tie.kind = Tie::Kind::universal;
    ties_.push_back(tie);
  }
  for (const LoopSpec& l : scene.loops) {
    Tie tie;
    tie.loop = &l;
    if (ties_bodies(l)) {
      tie.parent = tree.body(l.parent);
      tie.child = tree.body(l.child);
    }
    if (l.kind == LoopKind::weld) {
      join(tie.parent, tie.child);
      continue;
    }
    if (l.kind == LoopKind::distance) tie.kind = Tie::Kind::distance;
    tie.in_part = l.kind != LoopKind::distance && is_driven(l);
    if (!tie.in_part && (l.kind == LoopKind::spherical || l.kind == LoopKind::point))
      tie.kind = Tie::Kind::ball;
    if (!tie.in_part && l.kind == LoopKind::universal) tie.kind = Tie::Kind::universal;
    ties_.push_back(tie);
  }
}

int Pieces::of(int body) const {
  int k = body + 1;
  while (joined_[static_cast<std::size_t>(k)] != k) k = joined_[static_cast<std::size_t>(k)];
  return k;
}

int Pieces::spins() const {
  std::map<int, std::pair<int, int>> counts;  // of ties, of balls
  for (const Tie& tie : ties_)
    for (const int body : {tie.parent, tie.child}) {
      ++counts[of(body)].first;
      counts[of(body)].second += tie.kind == Tie::Kind::ball;
    }
  return static_cast<int>(std::count_if(counts.begin(), counts.end(), [&](const auto& c) {
    return c.first != base() && c.second.first == 2 && c.second.second == 2;
  }));
}

}  // namespace momenta
