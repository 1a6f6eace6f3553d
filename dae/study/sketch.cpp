#include <momenta/dae/study/sketch.h>

#include <algorithm>

namespace momenta {
namespace {

/// Rows take ground points to the page. In a plane: its basis. In space: x to the right, z up, y
/// going back at an angle.
Eigen::Matrix<double, 2, 3> view(const Mechanism& mechanism) {
  Eigen::Matrix<double, 2, 3> v;
  if (mechanism.plan().planar)
    v << mechanism.plan().basis.col(0).transpose(), mechanism.plan().basis.col(1).transpose();
  else
    v << 1, 0.45, 0, 0, 0.35, 1;
  return v;
}

}  // namespace

Sketch sketch(const Mechanism& mechanism, double t, const Eigen::VectorXd& q) {
  Scene open = mechanism.scene();
  open.loops.clear();
  std::erase_if(open.drives, [](const DriveSpec& drive) { return !drive.loop.empty(); });
  OpenChain chain(open);
  const auto poses = chain.poses(t, q);
  const auto page = view(mechanism);
  const Scene& scene = mechanism.scene();
  const auto place = [&](const std::string& body,
                         const Eigen::Vector3d& at) -> std::array<double, 2> {
    const int k = mechanism.tree().body(body);
    const Eigen::Vector3d x = k < 0 ? at : Eigen::Vector3d(poses[static_cast<std::size_t>(k)] * at);
    const Eigen::Vector2d p = page * x;
    return {p.x(), p.y()};
  };

  Sketch s;
  for (const BodySpec& body : scene.bodies) {
    std::vector<Eigen::Vector3d> corners;
    const auto add = [&](const Eigen::Vector3d& p) {
      for (const auto& c : corners)
        if ((c - p).norm() < 1e-9) return;
      corners.push_back(p);
    };
    const auto touch = [&](const auto& joint) {
      if (joint.child == body.name) add(joint.origin_child);
      if (joint.parent == body.name) add(joint.origin_parent);
    };
    for (const auto& joint : scene.joints) touch(joint);
    for (const auto& loop : scene.loops) touch(loop);  // a coupler touches no body
    if (body.shape.kind == "rod") add(body.shape.size.x() * body.shape.axis);
    if (corners.size() < 2) add(body.com);
    Sketch::Line line{body.name, {}};
    for (const auto& c : corners) line.points.push_back(place(body.name, c));
    if (line.points.size() > 2) line.points.push_back(line.points.front());
    s.lines.push_back(std::move(line));
  }
  for (const auto& joint : scene.joints)
    s.points.push_back({joint.name, joint.parent == "ground" ? "ground" : "joint",
                        place(joint.parent, joint.origin_parent)});
  for (const auto& loop : scene.loops)
    if (loop.kind != LoopKind::coupler)
      s.points.push_back({loop.name, "loop", place(loop.child, loop.origin_child)});
  for (const auto& marker : scene.markers)
    s.points.push_back({marker.name, "marker", place(marker.body, marker.point)});
  return s;
}

}  // namespace momenta
