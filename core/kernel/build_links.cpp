#include <momenta/core/kernel/child_order.h>
#include <momenta/core/kernel/link.h>

namespace momenta {
namespace {

Turn turn_of(const Spatial::EdgeConstants& e) {
  if (e.about_y) return Turn::tilted;
  if (e.sin_alpha == 0) return Turn::parallel;
  // A right angle to the left is one to the right seen along the common normal reversed; the model
  // builder chooses that direction.
  if (e.cos_alpha == 0 && e.sin_alpha > 0) return Turn::right;
  return Turn::general;
}

/// Origin of the child in the parent's frame; constant for joints that only turn.
Vec3<double> place_of(const Model<Spatial>::Body& b) {
  Spatial::Edge<double> e;
  e.d = b.d0;
  e.position = {{0, 0, b.d0}};
  return Spatial::moment_to_parent(b.edge, JointKind::weld, e, Vec3<double>{}, 1.0);
}

SphericalPlace spherical_of(const Model<Spatial>::Body& b) {
  Spatial::Edge<double> e;
  e.cos_theta = std::cos(b.theta0);
  e.sin_theta = std::sin(b.theta0);
  e.d = b.d0;
  Spatial::Pose<double> ground;
  ground.axes = identity3<double>();
  const auto at = Spatial::pose_outward(b.edge, JointKind::weld, e, ground);
  Eigen::Matrix3d axes;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) axes(i, j) = at.axes(i, j);
  const Eigen::Quaterniond turn(axes);
  return {{turn.w(), turn.x(), turn.y(), turn.z()}, turn.vec().norm() > 0, at.origin};
}

Leaf leaf_of(const Link& l) {
  Full<double> m;
  set_body(m, l);
  Leaf t;
  t.inverse = 1 / (m.Izz + l.rotor);
  RevoluteColumn<double> h;
  eliminate_revolute(m, t.inverse, h, t.M);
  t.h[0] = h.fx;
  t.h[1] = h.fy;
  t.h[2] = h.fz;
  t.h[3] = h.nx;
  t.h[4] = h.ny;
  return t;
}

}  // namespace

LinkTree build_links(const Model<Spatial>& model) {
  LinkTree tree;
  tree.model = &model;
  const std::size_t n = model.bodies.size();
  tree.links.resize(n);
  tree.theta0.resize(n);
  tree.weight.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    const auto& b = model.bodies[k];
    Link& l = tree.links[k];
    l.kind = b.kind == JointKind::revolute && b.drive < 0       ? LinkKind::revolute
             : b.kind == JointKind::spherical && !b.has_rotor() ? LinkKind::spherical
                                                                : LinkKind::general;
    l.turn = turn_of(b.edge);
    l.ca = b.edge.cos_alpha;
    l.sa = b.edge.sin_alpha;
    l.cc = l.ca * l.ca;
    l.cs = l.ca * l.sa;
    l.ss = l.sa * l.sa;
    l.cs2 = 2 * l.cs;
    l.ss2 = 2 * l.ss;
    l.a = b.edge.a;
    l.d = b.d0;
    l.screwed = b.edge.about_z;
    l.m = b.inertia.m;
    l.rotor = b.rotor;
    l.has_rotor = b.has_rotor();
    for (int i = 0; l.has_rotor && i < b.nv; ++i) tree.rotors.emplace_back(b.u + i, b.rotor);
    for (int i = 0; i < 3; ++i) l.c[i] = b.inertia.mc[i];
    for (int i = 0; i < 3; ++i) l.moment[i] += b.inertia.mc[i];
    for (int i = 0; i < 6; ++i) l.J[i] = b.inertia.J.x[i];
    l.q = b.q;
    l.u = b.u;
    l.parent = b.parent;
    l.first = b.parent >= 0 && b.parent + 1 == static_cast<int>(k);
    l.leaf = k + 1 == n || model.bodies[k + 1].parent != static_cast<int>(k);
    l.has_force = b.has_force();
    tree.theta0[k] = b.theta0;
    tree.has_angles |= l.kind != LinkKind::spherical;
    if (l.kind == LinkKind::general) l.record = tree.records++;
    l.one_axis = l.kind == LinkKind::general && b.nv <= 1 && !b.law;
    tree.users += b.law != nullptr;
    if (l.kind == LinkKind::spherical) {
      l.record = static_cast<int>(tree.sphericals.size());
      tree.sphericals.push_back(spherical_of(b));
    }
    if (b.parent >= 0) {
      Link& parent = tree.links[static_cast<std::size_t>(b.parent)];
      if (!l.first && parent.slot < 0) parent.slot = tree.slots++;
      if (l.kind != LinkKind::general) {
        const Vec3<double> r = place_of(b);
        for (int i = 0; i < 3; ++i) parent.moment[i] += b.subtree_mass * r[i];
      }
    } else {
      Spatial::Edge<double> at_zero;
      if (l.kind == LinkKind::spherical) {
        at_zero.cos_theta = std::cos(b.theta0);
        at_zero.sin_theta = std::sin(b.theta0);
      }
      tree.weight[k] = Spatial::direction_to_child(b.edge, JointKind::weld, at_zero, model.gravity);
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    Link& l = tree.links[k];
    if (!l.leaf || l.kind != LinkKind::revolute) continue;
    l.record = static_cast<int>(tree.leaves.size());
    tree.leaves.push_back(leaf_of(l));
    if (!(l.J[5] + l.rotor > 0) && tree.singular_joint < 0)
      tree.singular_joint = static_cast<int>(k);
  }
  set_paths(tree.links);
  mark_openers(tree.links);
  return tree;
}

void set_paths(std::vector<Link>& links) {
  for (std::size_t k = 0; k < links.size(); ++k) {
    Link& l = links[k];
    l.path = Path::any;
    if (l.kind != LinkKind::revolute || l.slot >= 0 || l.has_rotor) continue;
    if (l.parent < 0 && !l.leaf) l.path = Path::root;
    if (!l.first || l.screwed || l.turn == Turn::tilted) continue;
    const Path turn = static_cast<Path>(l.turn), before = links[k - 1].path;
    if (!l.leaf || before == turn || before == Path::root) l.path = turn;
  }
}

std::string links_in_words(const LinkTree& tree) {
  int right = 0, parallel = 0, general = 0, tilted = 0, sphericals = 0, others = 0;
  for (const Link& l : tree.links) {
    if (l.kind == LinkKind::spherical) ++sphericals;
    if (l.kind == LinkKind::general) ++others;
    if (l.kind != LinkKind::revolute) continue;
    right += l.turn == Turn::right;
    parallel += l.turn == Turn::parallel;
    general += l.turn == Turn::general;
    tilted += l.turn == Turn::tilted;
  }
  std::string words;
  const auto add = [&](int count, const char* what) {
    if (count > 0) words += (words.empty() ? "" : ", ") + std::to_string(count) + " " + what;
  };
  add(right, "revolute joints at right angles");
  add(parallel, "revolute joints parallel");
  add(general, "revolute joints at other angles");
  add(tilted, "revolute joints nearly parallel");
  add(sphericals, "spherical joints");
  add(others, "of other kinds");
  return words;
}

}  // namespace momenta
