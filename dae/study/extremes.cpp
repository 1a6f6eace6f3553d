#include <momenta/core/scene/formula.h>
#include <momenta/dae/study/extremes.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

/// Whether coordinate i of q, or of drives, is a length; the same for u, as quaternions come last.
bool is_length(JointKind kind, int i) {
  switch (kind) {
    case JointKind::prismatic:
      return true;
    case JointKind::cylindrical:
      return i == 0;
    case JointKind::planar:
      return i < 2;
    case JointKind::free:
      return i < 3;
    default:
      return false;
  }
}
bool is_length(LoopKind kind, int i) {
  switch (kind) {
    case LoopKind::prismatic:
    case LoopKind::distance:
    case LoopKind::slot:
      return true;
    case LoopKind::cylindrical:
      return i == 0;
    case LoopKind::planar:
      return i < 2;
    default:  // couplers too: their ratios take the unit
      return false;
  }
}

const JointSpec* joint_named(const Scene& scene, const std::string& name) {
  for (const JointSpec& j : scene.joints)
    if (j.name == name) return &j;
  return nullptr;
}

bool turns_or_slides(const JointSpec& j) {
  return j.kind == JointKind::revolute || j.kind == JointKind::helical ||
         j.kind == JointKind::prismatic;
}

/// f'(t) = value · f(t / time)
void stretch(DriveSpec& drive, double value, double time) {
  double power = 1;
  for (double& c : drive.coefficients) {
    c *= value * power;
    power /= time;
  }
  drive.offset *= value;
  drive.amplitude *= value;
  drive.frequency /= time;
  drive.from *= value;
  drive.to *= value;
  drive.start *= time;
  drive.duration *= time;
  for (double& t : drive.times) t *= time;
  for (double& v : drive.values) v *= value;
}

bool drives_a_length(const Scene& scene, const DriveSpec& drive) {
  if (!drive.origin.empty()) return true;
  if (const JointSpec* j = joint_named(scene, drive.joint))
    return is_length(j->kind, drive.coordinate);
  for (const LoopSpec& l : scene.loops)
    if (l.name == drive.loop) return is_length(l.kind, drive.coordinate);
  return false;
}

bool has_formulas(const Scene& scene) {
  return std::any_of(scene.forces.begin(), scene.forces.end(), has_formula) ||
         std::any_of(scene.drives.begin(), scene.drives.end(),
                     [](const DriveSpec& d) { return d.kind == "formula"; }) ||
         std::any_of(scene.loops.begin(), scene.loops.end(), has_equation);
}

bool at_rest(const Scene& scene) {
  return std::all_of(scene.joints.begin(), scene.joints.end(), [](const JointSpec& j) {
    return std::all_of(j.velocity.begin(), j.velocity.end(), [](double u) { return u == 0; });
  });
}

double total_mass(const Scene& scene) {
  double sum = 0;
  for (const BodySpec& b : scene.bodies) sum += b.mass;
  return sum;
}

void stiffen(Scene& scene, double factor) {
  for (JointSpec& j : scene.joints) j.stiffness *= factor;
  for (ForceSpec& f : scene.forces) {
    f.stiffness *= factor;
    f.rotational_stiffness *= factor;
  }
}

void damp(Scene& scene, double factor) {
  bool any = false;
  for (JointSpec& j : scene.joints) any = (j.damping *= factor) > 0 || any;
  for (ForceSpec& f : scene.forces) {
    any = (f.damping *= factor) > 0 || any;
    any = (f.rotational_damping *= factor) > 0 || any;
  }
  if (any) return;
  const double length = length_of(scene), mass = total_mass(scene);  // over one second
  for (JointSpec& j : scene.joints)
    if (turns_or_slides(j))
      j.damping = factor * mass * (j.kind == JointKind::prismatic ? 1 : length * length);
}

}  // namespace

Scene in_units(Scene scene, const Units& units) {
  const double s = units.length, tau = units.time, mu = units.mass;
  const double speed = s / tau, force = mu * s / (tau * tau), torque = force * s;
  scene.gravity *= speed / tau;
  for (BodySpec& b : scene.bodies) {
    b.mass *= mu;
    b.com *= s;
    b.inertia *= mu * s * s;
    b.shape.size *= s;
  }
  for (JointSpec& j : scene.joints) {
    const bool slides = j.kind == JointKind::prismatic;
    j.origin_parent *= s;
    j.origin_child *= s;
    j.pitch *= s;
    for (std::size_t i = 0; i < j.position.size(); ++i)
      if (is_length(j.kind, static_cast<int>(i))) j.position[i] *= s;
    for (std::size_t i = 0; i < j.velocity.size(); ++i)
      j.velocity[i] *= is_length(j.kind, static_cast<int>(i)) ? speed : 1 / tau;
    j.stiffness *= slides ? force / s : torque;
    j.damping *= slides ? force / speed : torque * tau;
    j.friction *= slides ? force : torque;
    j.friction_rate *= slides ? speed : 1 / tau;
    if (j.bearing) {
      j.bearing->transition_velocity *= speed;
      j.bearing->radius *= s;
      j.bearing->length *= s;
    }
    if (slides) j.rest *= s;
    j.stop_stiffness *= slides ? force / s : torque;
    j.stop_damping *= slides ? force / speed : torque * tau;
    if (slides) j.stop_width *= s;
    if (slides && j.limits)
      for (double& limit : *j.limits) limit *= s;
    for (std::size_t i = 0; i < j.rotor_inertia.size(); ++i)
      j.rotor_inertia[i] *= is_length(j.kind, static_cast<int>(i)) ? mu : mu * s * s;
  }
  for (LoopSpec& l : scene.loops) {
    l.origin_parent *= s;
    l.origin_child *= s;
    l.length *= s;
    l.radius *= s;
    l.crown_radius *= s;
    for (CurveSpec* curve : {&l.curve, &l.child_curve}) {
      curve->radius *= s;
      for (double& axis : curve->semi_axes) axis *= s;
      for (Eigen::Vector3d& point : curve->points) point *= s;
    }
    for (std::size_t i = 0; i < l.joints.size(); ++i)
      if (const JointSpec* j = joint_named(scene, l.joints[i]);
          j && is_length(j->kind, i < l.coordinates.size() ? l.coordinates[i] : 0))
        l.ratios[i] /= s;
    // the last joint's coordinate x takes the unit, and Σ powers x^k keeps that of the sum
    if (!l.powers.empty())
      if (const JointSpec* j = joint_named(scene, l.joints.back());
          j && is_length(j->kind, l.coordinates.empty() ? 0 : l.coordinates.back())) {
        double unit = s;
        for (double& power : l.powers) power /= unit *= s;
      }
  }
  for (DriveSpec& d : scene.drives) stretch(d, drives_a_length(scene, d) ? s : 1, tau);
  for (ForceSpec& f : scene.forces) {
    f.origin_parent *= s;
    f.origin_child *= s;
    f.point *= s;
    const bool of_sum = f.kind == "coordinate-spring";  // its ratios take the unit, l is an angle
    for (std::size_t i = 0; i < f.joints.size(); ++i)
      if (const JointSpec* of = joint_named(scene, f.joints[i]);
          of && is_length(of->kind, i < f.coordinates.size() ? f.coordinates[i] : 0))
        f.ratios[i] /= s;
    if (!of_sum) f.rest *= s, f.dead_band *= s, f.stop_width *= s;
    if (!of_sum && f.limits)
      for (double& limit : *f.limits) limit *= s;
    f.stop_stiffness *= of_sum ? torque : force / s;
    f.stop_damping *= of_sum ? torque * tau : force / speed;
    f.stiffness *= of_sum ? torque : force / s;
    f.damping *= of_sum ? torque * tau : force / speed;
    f.rotational_stiffness *= torque;
    f.rotational_damping *= torque * tau;
    f.force *= force;
    f.torque *= torque;
    const JointSpec* j = joint_named(scene, f.joint);
    f.value *= j && j->kind == JointKind::prismatic ? force : torque;
  }
  for (MarkerSpec& m : scene.markers) m.point *= s;
  scene.run.end_time *= tau;
  if (scene.run.step) *scene.run.step *= tau;
  if (scene.run.leak) *scene.run.leak /= tau;
  return scene;
}

Scene turned(Scene scene, const Eigen::Quaterniond& rotation) {
  scene.gravity = rotation * scene.gravity;
  const auto turn = [&](auto& joint) {
    if (joint.parent != "ground") return;
    joint.origin_parent = rotation * joint.origin_parent;
    joint.rotation = rotation * joint.rotation;
  };
  for (JointSpec& j : scene.joints) turn(j);
  for (LoopSpec& l : scene.loops) turn(l);
  for (MarkerSpec& m : scene.markers)
    if (m.body == "ground") m.point = rotation * m.point;
  for (ForceSpec& f : scene.forces) {
    if (f.parent == "ground") {
      f.origin_parent = rotation * f.origin_parent;
      f.rotation = rotation * f.rotation;
    }
    if (f.in_body_axes) continue;
    f.force = rotation * f.force;
    f.torque = rotation * f.torque;
  }
  return scene;
}

const char* name_of(Extreme extreme) {
  switch (extreme) {
    case Extreme::stiffness:
      return "stiffness";
    case Extreme::damping:
      return "damping";
    case Extreme::mass_ratio:
      return "mass ratio";
    case Extreme::size:
      return "size";
    case Extreme::speed:
      return "speed";
    case Extreme::duration:
      return "duration";
  }
  return "";
}

std::string lacks(const Scene& scene, Extreme extreme) {
  switch (extreme) {
    case Extreme::stiffness: {
      bool any = false;
      for (const JointSpec& j : scene.joints) any = any || j.stiffness > 0;
      for (const ForceSpec& f : scene.forces)
        any = any || f.stiffness > 0 || f.rotational_stiffness > 0;
      return any ? "" : "no spring in it";
    }
    case Extreme::damping:
      return std::any_of(scene.joints.begin(), scene.joints.end(), turns_or_slides)
                 ? ""
                 : "no joint of one coordinate in it";
    case Extreme::mass_ratio:
      return scene.bodies.size() > 1 ? "" : "one body only";
    case Extreme::size:
    case Extreme::speed:
      return has_formulas(scene) ? "formulas in it, whose numbers have units of their own" : "";
    default:
      return "";
  }
}

Scene driven_to(const Scene& scene, Extreme extreme, double factor) {
  Scene out = scene;
  switch (extreme) {
    case Extreme::stiffness:
      stiffen(out, factor);
      return out;
    case Extreme::damping:
      damp(out, factor);
      return out;
    case Extreme::mass_ratio:
      for (std::size_t i = 1; i < out.bodies.size(); i += 2) {
        out.bodies[i].mass *= factor;
        out.bodies[i].inertia *= factor;
      }
      return out;
    case Extreme::size:
      return in_units(std::move(out), {.length = factor, .time = std::sqrt(factor)});
    case Extreme::speed:
      if (at_rest(scene)) return in_units(std::move(out), {.time = 1 / factor});
      for (JointSpec& j : out.joints)
        for (double& u : j.velocity) u *= factor;
      for (DriveSpec& d : out.drives) stretch(d, 1, 1 / factor);
      out.run.end_time /= factor;
      if (out.run.step) *out.run.step /= factor;
      return out;
    case Extreme::duration:
      out.run.end_time *= factor;
      return out;
  }
  return out;
}

}  // namespace momenta
