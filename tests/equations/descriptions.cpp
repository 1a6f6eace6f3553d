#include "equations/descriptions.h"
#include "equations/parts.h"

#include <momenta/core/kernel/plan.h>

#include <algorithm>
#include <set>

namespace momenta::equations {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// A frame in the axes of another: x = at + turn x'.
struct Frame {
  Quaterniond turn = Quaterniond::Identity();
  Vector3d at = Vector3d::Zero();

  Vector3d point(const Vector3d& x) const { return turn.conjugate() * (x - at); }
  Vector3d direction(const Vector3d& v) const { return turn.conjugate() * v; }
};

/// An inertia in the axes of the frame.
Eigen::Matrix3d turned(const Eigen::Matrix3d& inertia, const Frame& f) {
  const Eigen::Matrix3d turn = f.turn.toRotationMatrix(), i = turn.transpose() * inertia * turn;
  return 0.5 * (i + i.transpose());
}

template <class T>
void shuffle(RandomTree& random, std::vector<T>& list) {
  for (std::size_t i = list.size(); i > 1; --i)
    std::swap(list[i - 1], list[static_cast<std::size_t>(random.below(static_cast<int>(i)))]);
}

/// Written out where it is the default.
template <class Joint>
void write_out(Joint& j) {
  using Kind = decltype(j.kind);
  if (j.kind == Kind::universal && j.axis2.isZero()) j.axis2 = perpendicular_to(j.axis);
  if (j.kind == Kind::planar && j.direction.isZero()) j.direction = perpendicular_to(j.axis);
}

/// The end of a joint or loop in its parent, which has another frame now.
template <class Joint>
void move_parent(Joint& j, const Frame& f) {
  j.origin_parent = f.point(j.origin_parent);
  j.rotation = (f.turn.conjugate() * j.rotation).normalized();
}

/// In its child. The joint frame is parallel to the child's axes: it turns with them.
template <class Joint>
void move_child(Joint& j, const Frame& f) {
  write_out(j);
  j.origin_child = f.point(j.origin_child);
  j.rotation = (j.rotation * f.turn).normalized();
  for (Vector3d* v : {&j.axis, &j.axis2, &j.direction}) *v = f.direction(*v).normalized();
}

void move_three(std::vector<double>& numbers, std::size_t from, const Frame& f) {
  if (numbers.empty()) return;
  const Vector3d v = f.direction({numbers[from], numbers[from + 1], numbers[from + 2]});
  std::copy(v.begin(), v.end(), numbers.begin() + static_cast<std::ptrdiff_t>(from));
}

/// Of spherical and free joints also q and u, which are in these axes.
void move_carried(JointSpec& j, const Frame& f) {
  move_child(j, f);
  if (j.kind == JointKind::free) {
    move_three(j.position, 0, f);
    move_three(j.velocity, 0, f);
    move_three(j.position, 4, f);
    move_three(j.velocity, 3, f);
  } else if (j.kind == JointKind::spherical) {
    move_three(j.position, 1, f);  // of a quaternion's vector
    move_three(j.velocity, 0, f);
  }
}

void move_wrench(ForceSpec& w, const Frame& f) {
  w.point = f.point(w.point);
  if (!w.in_body_axes) return;
  w.force = f.direction(w.force);
  w.torque = f.direction(w.torque);
}

/// Bodies whose axes a drive counts in: of roll, pitch and yaw, or of a loop's point.
std::set<std::string> axes_that_count(const Scene& scene) {
  std::set<std::string> bodies;
  for (const DriveSpec& d : scene.drives) {
    for (const JointSpec& j : scene.joints)
      if (j.name == d.joint && coordinates_of(j.kind) != rates_of(j.kind)) bodies.insert(j.child);
    for (const LoopSpec& l : scene.loops)
      if (l.name == d.loop) bodies.insert({l.parent, l.child});
  }
  return bodies;
}

bool driven(const Scene& scene, const LoopSpec& loop) {
  return std::any_of(scene.drives.begin(), scene.drives.end(),
                     [&](const DriveSpec& d) { return d.loop == loop.name; });
}

/// The law −f.
void negate(DriveSpec& d) {
  for (double& c : d.coefficients) c = -c;
  for (double& v : d.values) v = -v;
  d.offset = -d.offset;
  d.amplitude = -d.amplitude;
  d.from = -d.from;
  d.to = -d.to;
}

/// Coordinate k of a joint counted the other way, in all that is said of it.
void count_down(Scene& scene, JointSpec& j, int k) {
  const auto at = static_cast<std::size_t>(k);
  if (!j.position.empty()) j.position[at] = -j.position[at];
  if (!j.velocity.empty()) j.velocity[at] = -j.velocity[at];
  if (has_one_coordinate(j.kind)) j.rest = -j.rest;
  for (DriveSpec& d : scene.drives)
    if (d.joint == j.name && d.coordinate == k) negate(d);
  for (ForceSpec& f : scene.forces)
    if (f.kind == "torque" && f.joint == j.name) f.value = -f.value;
  for (LoopSpec& l : scene.loops)
    for (std::size_t i = 0; i < l.joints.size(); ++i)
      if (l.joints[i] == j.name && (l.coordinates.empty() ? 0 : l.coordinates[i]) == k)
        l.ratios[i] = -l.ratios[i];
}

/// Frames of bodies that a random scene may have.
Frame frame(RandomTree& random) {
  return {random.turn(), random.vector(0.5)};
}

/// What hangs on body `from` at random to `to`, which has frame `f` there.
void hand_on(RandomTree& random, Scene& scene, const std::string& from, const std::string& to,
             const Frame& f) {
  for (JointSpec& j : scene.joints)
    if (j.parent == from && random.chance(0.5)) {
      j.parent = to;
      move_parent(j, f);
    }
  for (LoopSpec& l : scene.loops) {
    if (driven(scene, l)) continue;
    if (l.parent == from && random.chance(0.5)) {
      l.parent = to;
      move_parent(l, f);
    } else if (l.child == from && random.chance(0.5)) {
      l.child = to;
      move_child(l, f);
    }
  }
  for (ForceSpec& s : scene.forces) {
    if (s.kind == "wrench" && s.body == from && random.chance(0.5)) {
      s.body = to;
      move_wrench(s, f);
    }
    if (s.kind != "spring-damper") continue;
    if (s.parent == from && random.chance(0.5)) {
      s.parent = to;
      s.origin_parent = f.point(s.origin_parent);
    } else if (s.child == from && random.chance(0.5)) {
      s.child = to;
      s.origin_child = f.point(s.origin_child);
    }
  }
  for (MarkerSpec& m : scene.markers)
    if (m.body == from && random.chance(0.5)) {
      m.body = to;
      m.point = f.point(m.point);
    }
}

JointSpec weld(const std::string& name, const std::string& parent, const std::string& child,
               const Frame& f) {
  JointSpec w = make_joint(JointKind::weld, name, parent, child, f.at);
  w.rotation = f.turn;
  return w;
}

Frame inverse(const Frame& f) {
  return {f.turn.conjugate(), f.turn.conjugate() * -f.at};
}

}  // namespace

void permute(RandomTree& random, Scene& scene) {
  shuffle(random, scene.bodies);
  shuffle(random, scene.joints);
  shuffle(random, scene.loops);
  shuffle(random, scene.drives);
  shuffle(random, scene.forces);
}

void move_frames(RandomTree& random, Scene& scene) {
  const std::set<std::string> fixed = axes_that_count(scene);
  for (BodySpec& b : scene.bodies) {
    if (fixed.contains(b.name)) continue;
    const Frame f = frame(random);
    b.com = f.point(b.com);
    b.inertia = turned(b.inertia, f);
    b.shape = {};
    for (JointSpec& j : scene.joints) {
      if (j.parent == b.name) move_parent(j, f);
      if (j.child == b.name) move_carried(j, f);
    }
    for (LoopSpec& l : scene.loops) {
      if (l.parent == b.name) move_parent(l, f);
      if (l.child == b.name) move_child(l, f);
    }
    for (ForceSpec& s : scene.forces) {
      if (s.kind == "wrench" && s.body == b.name) move_wrench(s, f);
      if (s.kind != "spring-damper") continue;
      if (s.parent == b.name) s.origin_parent = f.point(s.origin_parent);
      if (s.child == b.name) s.origin_child = f.point(s.origin_child);
    }
    for (MarkerSpec& m : scene.markers)
      if (m.body == b.name) m.point = f.point(m.point);
  }
}

void flip_axes(RandomTree& random, Scene& scene) {
  for (JointSpec& j : scene.joints) {
    if (coordinates_of(j.kind) != rates_of(j.kind) || rates_of(j.kind) == 0) continue;
    write_out(j);
    if (random.chance(0.6)) {
      j.axis = -j.axis;
      // planar: along axis × direction and about the axis; the others: all but about `axis2`
      const int first = j.kind == JointKind::planar ? 1 : 0,
                last = j.kind == JointKind::universal ? 0 : rates_of(j.kind) - 1;
      for (int k = first; k <= last; ++k) count_down(scene, j, k);
    }
    if (!random.chance(0.6)) continue;
    if (j.kind == JointKind::universal) {
      j.axis2 = -j.axis2;
      count_down(scene, j, 1);
    } else if (j.kind == JointKind::planar) {
      j.direction = -j.direction;
      count_down(scene, j, 0);
      count_down(scene, j, 1);
    }
  }
  for (LoopSpec& l : scene.loops) {
    if (driven(scene, l)) continue;
    write_out(l);
    if (random.chance(0.6)) l.axis = -l.axis;
    if (l.kind == LoopKind::universal && random.chance(0.6)) l.axis2 = -l.axis2;
    if (l.kind == LoopKind::planar && random.chance(0.6)) l.direction = -l.direction;
  }
}

void turn_loops_round(RandomTree& random, Scene& scene) {
  for (LoopSpec& l : scene.loops) {
    if (l.kind == LoopKind::coupler || l.kind == LoopKind::slot || l.parent == "ground" ||
        driven(scene, l))
      continue;
    if (!random.chance(0.7)) continue;
    write_out(l);
    std::swap(l.parent, l.child);
    std::swap(l.origin_parent, l.origin_child);
    l.axis = l.rotation * l.axis;
    l.axis2 = l.rotation * l.axis2;
    l.direction = l.rotation * l.direction;
    if (l.kind == LoopKind::universal) std::swap(l.axis, l.axis2);
    l.rotation = l.rotation.conjugate();
  }
}

void split_bodies(RandomTree& random, Scene& scene) {
  const std::set<std::string> fixed = axes_that_count(scene);
  const std::size_t count = scene.bodies.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (fixed.contains(scene.bodies[i].name) || !random.chance(0.4)) continue;
    const Frame f = frame(random);
    BodySpec& whole = scene.bodies[i];
    BodySpec part = whole;
    part.name = "part " + std::to_string(scene.bodies.size()) + " of " + whole.name;
    const int shared = random.below(3);
    const double share = shared == 2 ? random.uniform(0.2, 0.8) : shared;
    part.mass = share * whole.mass;
    part.com = f.point(whole.com);
    part.inertia = share * turned(whole.inertia, f);
    whole.mass *= 1 - share;
    whole.inertia *= 1 - share;
    whole.shape = part.shape = {};
    const std::string name = whole.name;
    hand_on(random, scene, name, part.name, f);
    const std::string weld_name = "weld of " + part.name;
    JointSpec& above = *std::find_if(scene.joints.begin(), scene.joints.end(),
                                     [&](const JointSpec& j) { return j.child == name; });
    if (random.chance(0.5)) {  // the joint carries the part, and this the rest
      move_carried(above, f);
      above.child = part.name;
      scene.joints.push_back(weld(weld_name, part.name, name, inverse(f)));
    } else {
      scene.joints.push_back(weld(weld_name, name, part.name, f));
    }
    scene.bodies.push_back(part);
  }
}

void add_base(RandomTree& random, Scene& scene) {
  BodySpec base;
  base.name = "base " + std::to_string(scene.bodies.size());
  if (random.chance(0.5)) {
    base.mass = random.uniform(1, 10);
    base.com = random.vector(0.5);
    base.inertia = random.inertia(base.mass);
  }
  const Frame f = frame(random);
  hand_on(random, scene, "ground", base.name, f);
  scene.joints.push_back(weld("weld of " + base.name, "ground", base.name, f));
  scene.bodies.push_back(base);
}

void turn_rotors_into_wheels(RandomTree& random, Scene& scene) {
  const Plan plan = make_plan(build_tree(scene), scene);
  const std::size_t joints = scene.joints.size();
  for (std::size_t i = 0; i < joints; ++i) {
    const JointSpec j = scene.joints[i];
    if (j.kind == JointKind::spherical) continue;
    scene.joints[i].rotor_inertia.clear();
    for (std::size_t k = 0; k < j.rotor_inertia.size(); ++k) {
      const bool prescribed =
          std::any_of(scene.drives.begin(), scene.drives.end(), [&](const DriveSpec& d) {
            return d.joint == j.name && d.coordinate == static_cast<int>(k);
          });
      if (j.rotor_inertia[k] == 0 || prescribed) continue;
      const double n = (random.chance(0.5) ? 1 : -1) * random.uniform(0.2, 4);
      BodySpec wheel;
      wheel.name = "wheel " + std::to_string(k) + " of " + j.name;
      JointSpec pin;
      pin.name = "pin of " + wheel.name;
      pin.child = wheel.name;
      pin.origin_parent = random.vector(1);
      pin.axis = plan.planar ? Vector3d(plan.basis.col(2)) : random.direction();
      // that of a disc about its axis
      const Eigen::Matrix3d along = pin.axis * pin.axis.transpose();
      wheel.inertia =
          j.rotor_inertia[k] / (n * n) * (along + 0.5 * (Eigen::Matrix3d::Identity() - along));
      if (!j.position.empty()) pin.position = {n * j.position[k]};
      if (!j.velocity.empty()) pin.velocity = {n * j.velocity[k]};
      LoopSpec gear;
      gear.name = "gear of " + wheel.name;
      gear.kind = LoopKind::coupler;
      gear.joints = {j.name, pin.name};
      gear.coordinates = {static_cast<int>(k), 0};
      gear.ratios = {n, -1};
      scene.bodies.push_back(wheel);
      scene.joints.push_back(pin);
      scene.loops.push_back(gear);
    }
  }
}

void rewrite_gears(RandomTree& random, Scene& scene) {
  for (LoopSpec& l : scene.loops) {
    if (l.kind != LoopKind::coupler || driven(scene, l)) continue;
    l.coordinates.resize(l.joints.size());
    for (std::size_t i = l.joints.size(); i > 1; --i) {
      const auto k = static_cast<std::size_t>(random.below(static_cast<int>(i)));
      std::swap(l.joints[i - 1], l.joints[k]);
      std::swap(l.coordinates[i - 1], l.coordinates[k]);
      std::swap(l.ratios[i - 1], l.ratios[k]);
    }
    const double factor = (random.chance(0.5) ? 1 : -1) / l.ratios.front();
    for (double& r : l.ratios) r *= factor;
    l.offset *= factor;
  }
}

}  // namespace momenta::equations
