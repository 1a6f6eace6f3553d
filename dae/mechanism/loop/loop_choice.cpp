// With C the child's axes in the joint frame, a joint of the same kind has, for its coordinates,
//
//   revolute, cylindrical, planar   C = R(axis, θ)
//   universal                       C = R(axis, q0) R(axis2, q1)
//   spherical                       C = Rz(yaw) Ry(pitch) Rx(roll)
//
// Prescribed angles at the child's end of the product are taken out of C by turning the axes of A
// back: C R(axis2, −q1) = R(axis, q0) leaves the hinge about `axis`, C R(axis2, −q1) R(axis, −q0)
// = 1 nothing. With q0 alone, R(axis, −q0) C = R(axis2, q1) is a hinge about `axis2` on axes of B
// turned along.

#include <momenta/core/scene/kinds.h>
#include <momenta/dae/mechanism/loop/loop_choice.h>

namespace momenta {
namespace {

/// Columns e1, e2, e3 with `axis` third: turned the shortest way, about v = e_z × axis,
/// R = 1 + ṽ + ṽ² / (1 + c), c = e_z · axis; of two opposite axes about x.
Eigen::Matrix3d frame_about(const Eigen::Vector3d& axis) {
  const Eigen::Vector3d a = axis.normalized();
  const double c = a.z(), s2 = a.x() * a.x() + a.y() * a.y();
  if (c < 0 && s2 == 0) return Eigen::Vector3d(1, -1, -1).asDiagonal();
  Eigen::Matrix3d v;
  v << 0, 0, a.x(), 0, 0, a.y(), -a.x(), -a.y(), 0;
  return Eigen::Matrix3d::Identity() + v + v * v * (c < 0 ? (1 - c) / s2 : 1 / (1 + c));
}

class Choosing {
 public:
  Choosing(const LoopSpec& loop, const LoopDrives& drives) : loop_(loop), drives_(drives) {}

  LoopChoice in_space() {
    const auto& driven = drives_.coordinate;
    if (reading::has_axis(loop_.kind)) c_.frame = frame_about(loop_.axis);
    if (has_curves(loop_)) displacements_as_axes();
    switch (loop_.kind) {
      case LoopKind::point:
        points({0, 1, 2});
        break;
      case LoopKind::weld:
        points({0, 1, 2});
        all_axes("");
        break;
      case LoopKind::spherical:
        points({0, 1, 2});
        if (!drives_.drives_coordinates()) break;
        all_axes(", driven");
        for (int i = 0; i < 3; ++i) turn_back(driven[at(i)], Eigen::Vector3d::Unit(i));
        break;
      case LoopKind::revolute:
        points({0, 1, 2});
        hinge("");
        angle(driven[0]);
        break;
      case LoopKind::prismatic:
        points({0, 1});
        translation(driven[0], 2);
        all_axes("");
        break;
      case LoopKind::cylindrical:
        points({0, 1});
        translation(driven[0], 2);
        hinge("");
        angle(driven[1]);
        break;
      case LoopKind::planar:
        points({2});
        if (drives_.drives_coordinates()) displacements_as_axes();
        translation(driven[0], 0);
        translation(driven[1], 1);
        hinge("");
        angle(driven[2]);
        break;
      case LoopKind::universal:
        points({0, 1, 2});
        universal();
        break;
      case LoopKind::slot:
        if (has_curves(loop_)) {
          points({2});
          higher("point on the " + loop_.curve.kind);
        } else {
          points({0, 1});
          translation(driven[0], 2);
        }
        break;
      case LoopKind::cam:
        higher("contact");
        break;
      case LoopKind::rack:
        higher("rolling");
        break;
      case LoopKind::rolling:
        c_.frame = frame_about(loop_.normal);
        c_.names = {"contact", "slip along axis 1", "slip along axis 2"};
        break;
      case LoopKind::distance:
      case LoopKind::coupler:
      case LoopKind::equation:
      case LoopKind::velocity_equation:
        break;
    }
    return c_;
  }

  LoopChoice in_plane() {
    const DriveSpec* driven = drives_.coordinate[0];
    const bool slot = loop_.kind == LoopKind::slot && !has_curves(loop_);
    if (loop_.kind == LoopKind::prismatic || slot) {
      const std::string what = slot ? "the slot" : "the slide";
      point(1, "point across " + what);
      if (driven) {
        point(0, "point along " + what + ", driven");
        c_.translations.push_back({driven, loop_.axis.normalized()});
      }
      if (!slot) axes(0, 1, "angle");
      return c_;
    }
    if (has_curves(loop_)) {
      displacements_as_axes();
      higher(loop_.kind == LoopKind::slot  ? "point on the " + loop_.curve.kind
             : loop_.kind == LoopKind::cam ? "contact"
                                           : "rolling");
      return c_;
    }
    points({0, 1});
    if (loop_.kind == LoopKind::weld) axes(0, 1, "angle");
    if (loop_.kind == LoopKind::revolute && driven) {
      axes(0, 1, "angle, driven");
      turn_back(driven, loop_.axis);
    }
    return c_;
  }

  LoopChoice of_number() {
    const std::string what = loop_.kind == LoopKind::distance   ? "distance"
                             : loop_.kind == LoopKind::coupler  ? "coupling"
                             : loop_.kind == LoopKind::equation ? "equation"
                                                                : "velocity equation";
    c_.names.push_back(drives_.coordinate[0] ? what + ", driven" : what);
    return c_;
  }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  static std::string number(int i) { return std::to_string(i + 1); }

  void point(int j, const std::string& name) {
    c_.points.push_back(j);
    c_.names.push_back(name);
  }
  void points(std::initializer_list<int> along) {
    for (const int j : along) point(j, "point along axis " + number(j));
  }
  void axes(int i, int j, const std::string& name) {
    c_.axes.emplace_back(i, j);
    c_.names.push_back(name);
  }
  /// Appended to the rows of points; a higher pair has none of axes.
  void higher(const std::string& name) { c_.names.push_back(name); }
  void across(int i, int j, const std::string& note) {
    axes(i, j, "axis " + number(i) + " against axis " + number(j) + note);
  }
  void all_axes(const std::string& note) {
    across(0, 1, note);
    across(1, 2, note);
    across(2, 0, note);
  }
  void hinge(const std::string& note) {
    across(2, 0, note);
    across(2, 1, note);
  }
  /// Appends a row of points: call it before hinge() and all_axes().
  void translation(const DriveSpec* drive, int j) {
    if (!drive) return;
    point(j, "point along axis " + number(j) + ", driven");
    c_.translations.push_back({drive, c_.frame.col(j)});
  }
  void angle(const DriveSpec* drive) {
    if (!drive) return;
    across(0, 1, ", driven");
    turn_back(drive, loop_.axis);
  }
  void turn_back(const DriveSpec* drive, const Eigen::Vector3d& axis) {
    c_.turns_a.push_back({drive, -axis.normalized()});
  }
  void displacements_as_axes() { c_.frame = frame_across(loop_); }
  void universal() {
    const DriveSpec *outer = drives_.coordinate[0], *inner = drives_.coordinate[1];
    const Eigen::Vector3d second =
        loop_.axis2.isZero() ? perpendicular_to(loop_.axis) : loop_.axis2.normalized();
    if (!outer && !inner) return axes(0, 2, "second axis against axis 3");
    if (inner) turn_back(inner, second);
    if (!inner) {
      c_.frame = frame_about(second);
      c_.turns_b.push_back({outer, loop_.axis.normalized()});
    }
    hinge(", driven");
    if (outer && inner) angle(outer);
  }

  const LoopSpec& loop_;
  const LoopDrives& drives_;
  LoopChoice c_;
};

}  // namespace

Eigen::Matrix3d frame_across(const LoopSpec& loop) {
  const Eigen::Vector3d third = loop.axis.normalized(), given = loop.direction;
  const Eigen::Vector3d first =
      given.isZero() ? perpendicular_to(third)
                     : Eigen::Vector3d((given - given.dot(third) * third).normalized());
  Eigen::Matrix3d frame;
  frame << first, third.cross(first), third;
  return frame;
}

DrivesOfLoops drives_of_loops(const Scene& scene) {
  DrivesOfLoops all;
  for (const DriveSpec& drive : scene.drives) {
    if (drive.loop.empty()) continue;
    LoopDrives& own = all[drive.loop];
    if (drive.origin.empty())
      own.coordinate[static_cast<std::size_t>(drive.coordinate)] = &drive;
    else
      own.origin[static_cast<std::size_t>(drive.origin[0] - 'x')] = &drive;
  }
  return all;
}

LoopChoice choose_rows(const LoopSpec& loop, const LoopDrives& drives, bool planar) {
  Choosing choosing(loop, drives);
  if (loop.kind == LoopKind::distance || !ties_bodies(loop)) return choosing.of_number();
  return planar ? choosing.in_plane() : choosing.in_space();
}

}  // namespace momenta
