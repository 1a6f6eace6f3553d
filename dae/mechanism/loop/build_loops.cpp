#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/mechanism/loop/left_by_files.h>
#include <momenta/dae/mechanism/loop/loop_choice.h>
#include <momenta/dae/mechanism/loop/loop_model.h>
#include <momenta/dae/mechanism/loop/pair_of_loop.h>
#include <momenta/dae/mechanism/loop/row_name.h>
#include <momenta/dae/mechanism/loop/take_equation.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace momenta {
namespace {

constexpr double in_one_plane = 1e-9;

Eigen::Matrix3d zero_rotation(const Tree& tree, const std::vector<Eigen::Isometry3d>& poses,
                              int body) {
  if (body < 0) return Eigen::Matrix3d::Identity();
  const auto k = static_cast<std::size_t>(body);
  return (poses[k] * tree.bodies[k].scene_axes).linear();
}

template <class Loop>
void take_rows(const LoopChoice& choice, Loop& l) {
  l.n_points = static_cast<int>(choice.points.size());
  std::copy(choice.points.begin(), choice.points.end(), l.points.begin());
  l.n_axes = static_cast<int>(choice.axes.size());
  std::copy(choice.axes.begin(), choice.axes.end(), l.axes.begin());
  l.rows = static_cast<int>(choice.names.size());
}

/// Whether a and b meet at the ground alone.
bool meet_at_ground(const Tree& tree, int a, int b) {
  while (a != b) {
    int& later = a > b ? a : b;
    later = tree.bodies[static_cast<std::size_t>(later)].parent;
  }
  return a < 0;
}

/// Casts Σ rᵢ qᵢ = c; driven coordinates go to the other side.
template <class Space>
void couple(const LoopSpec& spec, const Tree& tree, LoopModel<Space>& all,
            typename LoopModel<Space>::Loop& l, typename LoopModel<Space>::Motion& motion) {
  l.given = spec.offset;
  for (std::size_t i = 0; i < spec.joints.size(); ++i) {
    const int k = tree.part_of(spec.joints[i], spec.coordinates.empty() ? 0 : spec.coordinates[i]);
    const Tree::Body& b = tree.bodies[static_cast<std::size_t>(k)];
    if (b.drive >= 0)
      motion.numbers.emplace_back(-spec.ratios[i], tree.drives[static_cast<std::size_t>(b.drive)]);
    else
      l.joints.push_back({k, b.q, b.u, spec.ratios[i], {}, -1});
  }
  if (!has_powers(spec)) return;
  typename LoopModel<Space>::Coupled& last = l.joints.back();
  std::copy(spec.powers.begin(), spec.powers.end(), last.powers.begin());
  last.curve = all.curves++;
}

/// Prescribed motion of a loop whose points, axes and numbers are in place. `along` and `about`
/// take a vector of the joint frame to the axes of B and to an axis of turning in A or B.
template <class Space, class Translation, class About>
void prescribe(const LoopSpec& spec, const Tree& tree, const Model<Space>& model,
               const LoopDrives& drives, const LoopChoice& choice, Translation&& along,
               About&& about, typename LoopModel<Space>::Motion&& motion, LoopModel<Space>& all,
               typename LoopModel<Space>::Loop& l) {
  motion.given = l.given;
  motion.axis_a = l.axis_a;
  motion.axis_b = l.axis_b;
  Eigen::Vector3d start = spec.origin_parent;
  for (int i = 0; i < 3; ++i)
    if (const DriveSpec* drive = drives.origin[static_cast<std::size_t>(i)]) {
      start[i] = 0;
      motion.translations.push_back(
          {MotionLaw(*drive), model.direction(l.b, tree.direction(l.b, Eigen::Vector3d::Unit(i)))});
    }
  motion.at_b = model.point(l.b, tree.point(l.b, start));
  for (const auto& translation : choice.translations)
    motion.translations.push_back({MotionLaw(*translation.drive), along(translation.axis)});
  for (const auto& turn : choice.turns_a)
    motion.turns_a.push_back({MotionLaw(*turn.drive), about(l.a, turn.axis)});
  for (const auto& turn : choice.turns_b)
    motion.turns_b.push_back({MotionLaw(*turn.drive), about(l.b, turn.axis)});
  if ((l.is_distance() || l.is_coupler()) && drives.coordinate[0]) {
    motion.given = 0;
    motion.numbers.emplace_back(1.0, MotionLaw(*drives.coordinate[0]));
  }
  if (motion.translations.empty() && motion.turns_a.empty() && motion.turns_b.empty() &&
      motion.numbers.empty())
    return;
  l.motion = static_cast<int>(all.motions.size());
  all.motions.push_back(std::move(motion));
}

/// l at the start, the scale of the distance's equation.
double length_at_start(const LoopSpec& spec, const LoopDrives& drives) {
  if (!drives.coordinate[0]) return spec.length;
  double length, rate, second;
  MotionLaw(*drives.coordinate[0]).evaluate(0.0, length, rate, second);
  return length;
}

template <class Space>
void add_pair(const LoopSpec& spec, LoopModel<Space>& all, typename LoopModel<Space>::Loop& l) {
  l.pair = static_cast<int>(all.pairs.size());
  all.pairs.push_back(std::make_shared<const HigherPair>(pair_of(spec)));
}

template <class Space>
void append(typename LoopModel<Space>::Loop&& l, LoopModel<Space>& all) {
  l.row = all.rows;
  all.rows += l.rows;
  all.loops.push_back(std::move(l));
}

}  // namespace

LoopModel<Spatial> build_loops(const Scene& scene, const Tree& tree, const Model<Spatial>& model) {
  LoopModel<Spatial> all;
  DrivesOfLoops drives = drives_of_loops(scene);
  for (const LoopSpec& spec : scene.loops) {
    const LoopDrives& own = drives[spec.name];
    const LoopChoice choice = choose_rows(spec, own, false);
    LoopModel<Spatial>::Loop l;
    LoopModel<Spatial>::Motion motion;
    take_rows(choice, l);
    if (has_equation(spec)) {
      take_equation(scene, spec, tree, model, all, l);
    } else if (spec.kind == LoopKind::coupler) {
      couple(spec, tree, all, l, motion);
    } else {
      l.a = tree.body(spec.child);
      l.b = tree.body(spec.parent);
      l.at_a = model.point(l.a, tree.point(l.a, spec.origin_child));
      l.at_b = model.point(l.b, tree.point(l.b, spec.origin_parent));
    }
    const Eigen::Matrix3d turn = spec.rotation.toRotationMatrix();
    const auto in_a = [&](const Eigen::Vector3d& v) {
      return model.direction(l.a, tree.direction(l.a, v));
    };
    const auto in_b = [&](const Eigen::Vector3d& v) {
      return model.direction(l.b, tree.direction(l.b, turn * v));
    };
    for (int i = 0; i < 3; ++i) {
      const auto at = static_cast<std::size_t>(i);
      l.axis_a[at] = in_a(choice.frame.col(i));
      l.axis_b[at] = in_b(choice.frame.col(i));
    }
    if (spec.kind == LoopKind::distance) {
      l.given = length_at_start(spec, own);
      l.per_length = 1 / l.given;
    }
    if (spec.kind == LoopKind::rolling) {
      l.axis_a[2] = in_a(spec.axis.normalized());
      l.wheel = static_cast<int>(all.wheels.size());
      all.wheels.push_back({spec.radius - spec.crown_radius, spec.crown_radius});
    }
    if (has_curves(spec)) add_pair(spec, all, l);
    if (spec.kind == LoopKind::universal && !own.drives_coordinates()) {
      const Eigen::Vector3d axis = spec.axis.normalized();
      const Eigen::Vector3d second =
          spec.axis2.isZero() ? perpendicular_to(axis) : spec.axis2.normalized();
      l.axis_a[0] = in_a(second);
      l.gamma = axis.dot(second);
    }
    prescribe(
        spec, tree, model, own, choice, in_b,
        [&](int body, const Eigen::Vector3d& v) { return body == l.a ? in_a(v) : in_b(v); },
        std::move(motion), all, l);
    append(std::move(l), all);
  }
  return all;
}

LoopModel<Planar> build_loops(const Scene& scene, const Tree& tree, const Model<Planar>& model) {
  LoopModel<Planar> all;
  DrivesOfLoops drives = drives_of_loops(scene);
  const auto poses = tree.zero_poses();
  const Eigen::Vector3d normal = model.basis.col(2);
  for (const LoopSpec& spec : scene.loops) {
    const LoopDrives& own = drives[spec.name];
    const LoopChoice choice = choose_rows(spec, own, true);
    LoopModel<Planar>::Loop l;
    LoopModel<Planar>::Motion motion;
    take_rows(choice, l);
    if (has_equation(spec)) {
      take_equation(scene, spec, tree, model, all, l);
      append(std::move(l), all);
      continue;
    }
    if (spec.kind == LoopKind::coupler) {
      couple(spec, tree, all, l, motion);
      const auto none = [](const auto&...) { return Vec2<double>{}; };
      const auto no_axis = [](const auto&...) { return 0.0; };
      prescribe(spec, tree, model, own, choice, none, no_axis, std::move(motion), all, l);
      append(std::move(l), all);
      continue;
    }
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
      l.given = length_at_start(spec, own);
      l.per_length = 1 / l.given;
      l.across2 = across * across;
      if (std::abs(across) > l.given)
        throw SceneError(scene.where(spec.at) + "loop '" + spec.name +
                         "' cannot close: its points lie " + reading::digits(std::abs(across)) +
                         " m apart across the plane, expected at most its length, " +
                         reading::digits(l.given) + " m");
    } else {
      if (std::abs(across) > in_one_plane * (1 + point_a.norm() + point_b.norm()))
        throw SceneError(
            scene.where(spec.at) + "loop '" + spec.name + "' cannot close: its two sides lie " +
            reading::digits(std::abs(across)) +
            " m apart across the plane in which the scene moves; expected the same height");
      const bool translations =
          spec.kind == LoopKind::prismatic || (spec.kind == LoopKind::slot && !has_curves(spec));
      // Axes in the plane: for a slide, 1 along it and 2 across; else the plane's own.
      const Eigen::Matrix3d in_joint =
          zero_rotation(tree, poses, l.b) * spec.rotation.toRotationMatrix();
      Eigen::Vector3d first = translations ? Eigen::Vector3d(in_joint * spec.axis)
                                           : Eigen::Vector3d(model.basis.col(0));
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
      if (has_curves(spec)) {
        const auto of = [&](int i) { return Eigen::Vector3d(in_joint * choice.frame.col(i)); };
        l.axis_b = {in_plane(of(0)), in_plane(of(1)), {}};
        l.axis_a = {in_plane(child_from_joint * of(0)), in_plane(child_from_joint * of(1)), {}};
        if (spec.kind == LoopKind::slot && spec.curve.kind == "circle") {  // carried by the sweeps
          l.given = spec.curve.radius;
          l.per_length = 1 / l.given;
        } else {
          add_pair(spec, all, l);
        }
      }
    }
    // The axis of a hinge is along the normal or against it.
    prescribe(
        spec, tree, model, own, choice,
        [&](const Eigen::Vector3d& v) {
          return model.direction(l.b, tree.direction(l.b, spec.rotation * v));
        },
        [&](int, const Eigen::Vector3d& v) {
          const Eigen::Vector3d axis = zero_rotation(tree, poses, l.a) * v;
          return normal.dot(axis) > 0 ? 1.0 : -1.0;
        },
        std::move(motion), all, l);
    if (l.n_points == 2 && l.n_axes == 0 && l.motion < 0 && meet_at_ground(tree, l.a, l.b)) {
      l.is_tie = true;
      l.axis_b = {Vec2<double>{{1, 0}}, Vec2<double>{{0, 1}}, {}};
    }
    append(std::move(l), all);
  }
  return all;
}

std::string loops_leave_plane(const Scene& scene, const Tree& tree, const Eigen::Matrix3d& basis) {
  const auto poses = tree.zero_poses();
  const Eigen::Vector3d normal = basis.col(2);
  constexpr double angle_tolerance = 1e-10;
  DrivesOfLoops drives = drives_of_loops(scene);
  for (const LoopSpec& spec : scene.loops) {
    if (!ties_bodies(spec)) continue;
    const LoopDrives& own = drives[spec.name];
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d along = zero_rotation(tree, poses, tree.body(spec.parent)).col(i);
      if (own.origin[static_cast<std::size_t>(i)] && std::abs(along.dot(normal)) > angle_tolerance)
        return "the origin of loop '" + spec.name + "' is driven out of the plane of the joints";
    }
    if (spec.kind == LoopKind::spherical && own.drives_coordinates())
      return "loop '" + spec.name + "' is of a kind that only space has";
    // Sides a little apart across the plane close there in the least-squares sense, in space alone.
    const auto height = [&](const std::string& body, const Eigen::Vector3d& origin) {
      const int k = tree.body(body);
      const Eigen::Vector3d p = tree.point(k, origin);
      return normal.dot(k < 0 ? p : poses[static_cast<std::size_t>(k)] * p);
    };
    const double across =
        std::abs(height(spec.child, spec.origin_child) - height(spec.parent, spec.origin_parent));
    if (spec.kind != LoopKind::distance &&
        across > in_one_plane * (1 + spec.origin_child.norm() + spec.origin_parent.norm()) &&
        across <= left_by_files * length_of(scene)) {
      char apart[32];
      std::snprintf(apart, sizeof apart, "%.2g", across);
      return "the sides of loop '" + spec.name + "' lie " + apart +
             " m apart across the plane of the joints";
    }
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
    if (spec.kind == LoopKind::slot && !has_curves(spec) && off_plane(axis_b))
      return "the slot of loop '" + spec.name + "' leaves the plane of the joints";
    if (has_curves(spec) &&
        (off_normal(axis_b) ||
         (spec.kind != LoopKind::slot && (off_normal(axis_a) || axis_a.dot(axis_b) < 0))))
      return "the axis of loop '" + spec.name + "' is not normal to the plane of the joints";
    if (spec.kind == LoopKind::universal || spec.kind == LoopKind::cylindrical ||
        spec.kind == LoopKind::planar || spec.kind == LoopKind::rolling)
      return "loop '" + spec.name + "' is of a kind that only space has";
  }
  return "";
}

template <class Space>
std::vector<bool> LoopModel<Space>::nonholonomic() const {
  std::vector<bool> rows_of_velocity;
  for (const Loop& l : loops)
    for (int i = 0; i < l.rows; ++i)
      rows_of_velocity.push_back(
          (l.is_wheel() && i > 0) ||
          (l.is_equation() && equations[static_cast<std::size_t>(l.equation)]->of_rates));
  return rows_of_velocity;
}
template struct LoopModel<Planar>;
template struct LoopModel<Spatial>;

std::vector<RowName> row_names(const Scene& scene, bool planar) {
  std::vector<RowName> names;
  DrivesOfLoops drives = drives_of_loops(scene);
  for (const LoopSpec& spec : scene.loops)
    for (const std::string& what : choose_rows(spec, drives[spec.name], planar).names)
      names.push_back({spec.name, what});
  return names;
}

}  // namespace momenta
