#include <momenta/core/kernel/child_order.h>
#include <momenta/core/kernel/planar_joint.h>

#include <cmath>

namespace momenta {
namespace {

void turn_by(double c, double s, double& x, double& y) {
  const double turned = c * x - s * y;
  y = s * x + c * y;
  x = turned;
}

}  // namespace

PlanarTree build_links(const Model<Planar>& model) {
  PlanarTree tree;
  tree.model = &model;
  const std::size_t n = model.bodies.size();
  tree.links.resize(n);
  tree.theta0.resize(n);
  std::vector<double>& phi = tree.frame_turn;
  phi.assign(n, 0.0);
  for (std::size_t k = 0; k + 1 < n; ++k) {
    const auto& child = model.bodies[k + 1];
    if (child.parent == static_cast<int>(k) && std::hypot(child.edge.x, child.edge.y) > 0)
      phi[k] = std::atan2(child.edge.y, child.edge.x);
  }
  const double gx = model.gravity[0], gy = model.gravity[1];
  for (std::size_t k = 0; k < n; ++k) {
    const auto& b = model.bodies[k];
    PlanarLink& l = tree.links[k];
    l.first = b.parent >= 0 && b.parent + 1 == static_cast<int>(k);
    l.leaf = k + 1 == n || model.bodies[k + 1].parent != static_cast<int>(k);
    l.revolute = b.kind == JointKind::revolute && b.drive < 0;
    l.has_force = b.has_force();
    l.sign = b.edge.sign;
    l.q = b.q;
    l.u = b.u;
    l.parent = b.parent;
    l.m = b.inertia.m;
    l.rotor = b.rotor;
    l.has_rotor = b.has_rotor();
    l.J = b.inertia.J;
    const double c = std::cos(phi[k]), s = std::sin(phi[k]);
    l.cx = b.inertia.mc[0];
    l.cy = b.inertia.mc[1];
    turn_by(c, -s, l.cx, l.cy);
    l.wx += l.cx * gy - l.cy * gx;  // (R m c) × g = wx cos + wy sin
    l.wy -= l.cy * gy + l.cx * gx;
    const double from = b.parent < 0 ? 0.0 : phi[static_cast<std::size_t>(b.parent)];
    tree.theta0[k] = phi[k] - from;
    const double cp = std::cos(from), sp = std::sin(from);
    l.x = b.edge.x;
    l.y = b.edge.y;
    turn_by(cp, -sp, l.x, l.y);
    l.prismatic_x = b.edge.prismatic_x;
    l.prismatic_y = b.edge.prismatic_y;
    turn_by(cp, -sp, l.prismatic_x, l.prismatic_y);
    if (l.first) {
      l.x = std::hypot(b.edge.x, b.edge.y);
      l.y = 0;
    }
    if (!l.revolute) l.record = tree.records++;
    if (b.parent < 0) continue;
    PlanarLink& parent = tree.links[static_cast<std::size_t>(b.parent)];
    if (!l.first && parent.slot < 0) parent.slot = tree.slots++;
    if (l.revolute) {
      parent.wx += b.subtree_mass * (l.x * gy - l.y * gx);
      parent.wy -= b.subtree_mass * (l.y * gy + l.x * gx);
    }
  }
  const auto mark = [&](int k) {
    if (k >= 0) tree.links[static_cast<std::size_t>(k)].forced = true;
  };
  for (const auto& spring : model.springs) {
    mark(spring.parent);
    mark(spring.child);
  }
  for (const auto& bushing : model.bushings) {
    mark(bushing.parent);
    mark(bushing.child);
  }
  for (const auto& wrench : model.wrenches) mark(wrench.body);
  mark_openers(tree.links);
  return tree;
}

}  // namespace momenta
