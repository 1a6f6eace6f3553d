#include <momenta/core/scene/kinds.h>
#include <momenta/dae/loop/loop_model.h>

#include <cmath>

namespace momenta {
namespace {

/// The loop's frame with `axis` third, in the joint frame of the scene: columns e1, e2, e3.
Eigen::Matrix3d axes_of(const LoopSpec& loop) {
  if (!reading::has_axis(loop.kind)) return Eigen::Matrix3d::Identity();
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), loop.axis).toRotationMatrix();
}

/// The rows of a kind in space.
template <class Loop>
void choose_rows(LoopKind kind, Loop& l) {
  const bool slides = kind == LoopKind::prismatic || kind == LoopKind::cylindrical;
  const bool floats = kind == LoopKind::planar;
  l.n_points = floats ? 1 : slides ? 2 : 3;
  l.points = {floats ? 2 : 0, 1, 2};
  if (kind == LoopKind::revolute || kind == LoopKind::cylindrical || floats) {
    l.n_axes = 2;
    l.axes = {{{2, 0}, {2, 1}, {0, 0}}};
  } else if (kind == LoopKind::weld || kind == LoopKind::prismatic) {
    l.n_axes = 3;
    l.axes = {{{0, 1}, {1, 2}, {2, 0}}};
  } else if (kind == LoopKind::universal) {
    l.n_axes = 1;
    l.axes = {{{0, 2}, {0, 0}, {0, 0}}};
  }
  l.rows = l.n_points + l.n_axes;
}

Eigen::Matrix3d zero_rotation(const Tree& tree, const std::vector<Eigen::Isometry3d>& poses,
                              int body) {
  if (body < 0) return Eigen::Matrix3d::Identity();
  const auto k = static_cast<std::size_t>(body);
  return (poses[k] * tree.bodies[k].scene_axes).linear();
}

}  // namespace

LoopModel<Spatial> build_loops(const Scene& scene, const Tree& tree, const Model<Spatial>& model) {
  LoopModel<Spatial> all;
  for (const LoopSpec& spec : scene.loops) {
    LoopModel<Spatial>::Loop l;
    l.a = tree.body(spec.child);
    l.b = tree.body(spec.parent);
    l.at_a = model.point(l.a, tree.point(l.a, spec.origin_child));
    l.at_b = model.point(l.b, tree.point(l.b, spec.origin_parent));
    const Eigen::Matrix3d e = axes_of(spec), in_parent = spec.rotation.toRotationMatrix() * e;
    for (int i = 0; i < 3; ++i) {
      const auto at = static_cast<std::size_t>(i);
      l.axis_a[at] = model.direction(l.a, tree.direction(l.a, e.col(i)));
      l.axis_b[at] = model.direction(l.b, tree.direction(l.b, in_parent.col(i)));
    }
    if (spec.kind == LoopKind::distance) {
      l.length = spec.length;
      l.rows = 1;
    } else {
      choose_rows(spec.kind, l);
    }
    if (spec.kind == LoopKind::universal) {
      const Eigen::Vector3d axis = spec.axis.normalized();
      const Eigen::Vector3d second =
          spec.axis2.isZero() ? perpendicular_to(axis) : spec.axis2.normalized();
      l.axis_a[0] = model.direction(l.a, tree.direction(l.a, second));
      l.gamma = axis.dot(second);
    }
    l.row = all.rows;
    all.rows += l.rows;
    all.loops.push_back(l);
  }
  return all;
}

LoopModel<Planar> build_loops(const Scene& scene, const Tree& tree, const Model<Planar>& model) {
  LoopModel<Planar> all;
  const auto poses = tree.zero_poses();
  const Eigen::Vector3d normal = model.basis.col(2);
  for (const LoopSpec& spec : scene.loops) {
    LoopModel<Planar>::Loop l;
    l.a = tree.body(spec.child);
    l.b = tree.body(spec.parent);
    const Eigen::Vector3d point_a = tree.point(l.a, spec.origin_child),
                          point_b = tree.point(l.b, spec.origin_parent);
    l.at_a = model.point(l.a, point_a);
    l.at_b = model.point(l.b, point_b);
    const auto height = [&](int body, const Eigen::Vector3d& p) {
      return body < 0 ? normal.dot(p) : (model.frames[static_cast<std::size_t>(body)] * p).z();
    };
    const double across = height(l.a, point_a) - height(l.b, point_b);
    if (spec.kind == LoopKind::distance) {
      l.length = spec.length;
      l.across2 = across * across;
      l.rows = 1;
      if (std::abs(across) > spec.length)
        throw SceneError(scene.where(spec.at) + "loop '" + spec.name +
                         "' cannot close: its points lie " + std::to_string(std::abs(across)) +
                         " m apart across the plane, more than its length " +
                         std::to_string(spec.length) + " m");
    } else {
      const double size = 1 + point_a.norm() + point_b.norm();
      if (std::abs(across) > 1e-9 * size)
        throw SceneError(
            scene.where(spec.at) + "loop '" + spec.name + "' cannot close: its two sides lie " +
            std::to_string(std::abs(across)) +
            " m apart across the plane in which the scene moves; expected the same height");
      const bool slides = spec.kind == LoopKind::prismatic;
      const bool turns_locked = slides || spec.kind == LoopKind::weld;
      // Axes in the plane: for a slide, 1 along it and 2 across; else the plane's own.
      const Eigen::Matrix3d in_joint =
          zero_rotation(tree, poses, l.b) * spec.rotation.toRotationMatrix();
      Eigen::Vector3d first =
          slides ? Eigen::Vector3d(in_joint * spec.axis) : Eigen::Vector3d(model.basis.col(0));
      first.normalize();
      const Eigen::Vector3d second = normal.cross(first);
      const Eigen::Matrix3d child_from_joint =
          zero_rotation(tree, poses, l.a) * in_joint.transpose();
      const auto in_plane = [&](const Eigen::Vector3d& v) {
        const Eigen::Vector3d w = model.basis.transpose() * v;
        return Vec2<double>{{w.x(), w.y()}};
      };
      l.axis_b = {in_plane(first), in_plane(second), {}};
      l.axis_a = {in_plane(child_from_joint * first), in_plane(child_from_joint * second), {}};
      l.n_points = slides ? 1 : 2;
      l.points = slides ? std::array<int, 3>{1, 0, 0} : std::array<int, 3>{0, 1, 0};
      l.n_axes = turns_locked ? 1 : 0;
      l.axes = {{{0, 1}, {0, 0}, {0, 0}}};
      l.rows = l.n_points + l.n_axes;
    }
    l.row = all.rows;
    all.rows += l.rows;
    all.loops.push_back(l);
  }
  return all;
}

std::string loops_leave_plane(const Scene& scene, const Tree& tree, const Eigen::Matrix3d& basis) {
  const auto poses = tree.zero_poses();
  const Eigen::Vector3d normal = basis.col(2);
  constexpr double angle_tolerance = 1e-10;
  for (const LoopSpec& spec : scene.loops) {
    const Eigen::Matrix3d in_b =
        zero_rotation(tree, poses, tree.body(spec.parent)) * spec.rotation.toRotationMatrix();
    const Eigen::Matrix3d in_a = zero_rotation(tree, poses, tree.body(spec.child));
    // Normal of the plane seen from both sides of the joint: equal, or the loop would have to turn
    // out of the plane.
    const bool sides_differ =
        (in_a.transpose() * normal - in_b.transpose() * normal).norm() > angle_tolerance;
    const Eigen::Vector3d axis_a = in_a * spec.axis, axis_b = in_b * spec.axis;
    const auto off_normal = [&](const Eigen::Vector3d& v) {
      return v.cross(normal).norm() > angle_tolerance;
    };
    const auto off_plane = [&](const Eigen::Vector3d& v) {
      return std::abs(v.dot(normal)) > angle_tolerance;
    };
    if (spec.kind == LoopKind::revolute &&
        (off_normal(axis_a) || off_normal(axis_b) || axis_a.dot(axis_b) < 0))
      return "the axis of loop '" + spec.name + "' is not normal to the plane of the joints";
    if (spec.kind == LoopKind::prismatic &&
        (off_plane(axis_a) || off_plane(axis_b) || sides_differ))
      return "loop '" + spec.name + "' slides out of the plane of the joints";
    if (spec.kind == LoopKind::weld && sides_differ)
      return "loop '" + spec.name + "' is welded out of the plane";
    if (spec.kind == LoopKind::universal || spec.kind == LoopKind::cylindrical ||
        spec.kind == LoopKind::planar)
      return "loop '" + spec.name + "' is of a kind that only space has";
  }
  return "";
}

std::vector<RowName> row_names(const Scene& scene, bool planar) {
  std::vector<RowName> names;
  const std::array<const char*, 3> point{"point along axis 1", "point along axis 2",
                                         "point along axis 3"};
  for (const LoopSpec& spec : scene.loops) {
    const auto add = [&](const std::string& what) { names.push_back({spec.name, what}); };
    if (spec.kind == LoopKind::distance) {
      add("distance");
      continue;
    }
    const bool slides = spec.kind == LoopKind::prismatic;
    const bool locked = slides || spec.kind == LoopKind::weld;
    if (planar) {
      if (!slides) add("point along axis 1");
      add(slides ? "point across the slide" : "point along axis 2");
      if (locked) add("angle");
      continue;
    }
    if (spec.kind == LoopKind::planar) {
      add(point[2]);
    } else {
      for (std::size_t i = 0; i < (slides || spec.kind == LoopKind::cylindrical ? 2u : 3u); ++i)
        add(point[i]);
    }
    if (spec.kind == LoopKind::universal) {
      add("second axis against axis 3");
    } else if (spec.kind == LoopKind::revolute || spec.kind == LoopKind::cylindrical ||
               spec.kind == LoopKind::planar) {
      add("axis 3 against axis 1");
      add("axis 3 against axis 2");
    } else if (locked) {
      add("axis 1 against axis 2");
      add("axis 2 against axis 3");
      add("axis 3 against axis 1");
    }
  }
  return names;
}

}  // namespace momenta
