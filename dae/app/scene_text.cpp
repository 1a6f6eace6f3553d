#include <momenta/core/text/quoting.h>

#include <cmath>
#include <cstdio>
#include "scene_text.h"

namespace momenta::program {
namespace {

void put(const std::string& text) {
  std::fputs(text.c_str(), stdout);
}

bool zero(const Triple& v) {
  return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

/// Common keys of joints and loops: names and ends, rotation and axis.
template <class Text>
void open_frames(const char* table, const Text& t) {
  put("\n[[" + std::string(table) + "]]\nname = \"" + t.name + "\"\nkind = \"" + t.kind +
      "\"\nparent = \"" + t.parent + "\"\nchild = \"" + t.child + "\"\n");
}
template <class Text>
void turn_frames(const Text& t) {
  if (!zero(t.rpy)) put("rotation = { rpy = " + triple_text(t.rpy) + " }\n");
  if (!t.axis.empty())
    put("axis = " + (t.axis.front() == '[' ? t.axis : "\"" + t.axis + "\"") + "\n");
}

void open_body(const std::string& name, double mass) {
  put("\n[[body]]\nname = \"" + name + "\"\nmass = " + number_text(mass) + "\n");
}

}  // namespace

std::string number_text(double value) {
  return reading::digits(value);
}

std::string triple_text(const Triple& v) {
  return "[" + number_text(v[0]) + ", " + number_text(v[1]) + ", " + number_text(v[2]) + "]";
}

std::string numbered(const char* word, int number) {
  return word + std::to_string(number);
}

void print_head(const std::string& comment, const std::string& name, const Triple& gravity,
                double end) {
  put("# " + comment + "\nname = \"" + name + "\"\ngravity = " + triple_text(gravity) +
      "\n\n[run]\nend = " + number_text(end) + "\nsamples = 500\n");
}

void print_corrected_head(const std::string& comment, const std::string& name,
                          const Triple& gravity, double end) {
  print_head(comment, name, gravity, end);
  put("leak = 3.0\nproject = true   # passes singular poses\n");
}

void print_held(const std::string& joint) {
  put("\n[assembly]\nhold = [\"" + joint + "\"]\n");
}

void print_plate(const std::string& name, double mass, const Triple& com, double planar) {
  open_body(name, mass);
  put("com = " + triple_text(com) + "\ninertia = " + number_text(planar) + "\n");
}

void print_rod(const std::string& name, double mass, double length) {
  open_body(name, mass);
  put("shape = { kind = \"rod\", length = " + number_text(length) + ", axis = \"x\" }\n");
}

void print_cylinder(const std::string& name, double mass, double length, double radius,
                    const std::string& axis) {
  const auto along = static_cast<std::size_t>(axis.back() - 'x');
  Triple com{};
  com[along] = (axis.front() == '-' ? -0.5 : 0.5) * length;
  open_body(name, mass);
  put("com = " + triple_text(com) + "\nshape = { kind = \"cylinder\", length = " +
      number_text(length) + ", radius = " + number_text(radius) + ", axis = \"" + axis + "\" }\n");
}

void print_box(const std::string& name, double mass, const Triple& size, const Triple& com) {
  open_body(name, mass);
  put("com = " + triple_text(com) + "\nshape = { kind = \"box\", size = " + triple_text(size) +
      " }\n");
}

void print_ball(const std::string& name, double mass, double radius, const Triple& com) {
  open_body(name, mass);
  if (!zero(com)) put("com = " + triple_text(com) + "\n");
  put("shape = { kind = \"sphere\", radius = " + number_text(radius) + " }\n");
}

void print_joint(const JointText& joint) {
  open_frames("joint", joint);
  if (!zero(joint.origin_parent))
    put("origin = { parent = " + triple_text(joint.origin_parent) + " }\n");
  turn_frames(joint);
  if (!joint.position.empty()) put("position = " + joint.position + "\n");
  if (!joint.velocity.empty()) put("velocity = " + joint.velocity + "\n");
  if (joint.stiffness != 0) put("stiffness = " + number_text(joint.stiffness) + "\n");
  if (joint.damping != 0) put("damping = " + number_text(joint.damping) + "\n");
}

void print_loop(const LoopText& loop) {
  open_frames("loop", loop);
  put("origin = { parent = " + triple_text(loop.origin_parent) +
      ", child = " + triple_text(loop.origin_child) + " }\n");
  turn_frames(loop);
}

void print_marker(const std::string& name, const std::string& body, const Triple& point) {
  put("\n[[marker]]\nname = \"" + name + "\"\nbody = \"" + body +
      "\"\npoint = " + triple_text(point) + "\n");
}

Triple Draw::direction() {
  for (;;) {
    const double x = between(-1, 1), y = between(-1, 1), z = between(-1, 1);
    const double length = std::sqrt(x * x + y * y + z * z);
    if (length > 0.1 && length < 1) return {x / length, y / length, z / length};
  }
}

Triple Plane::from_plane(const Triple& v) const {
  const double cr = std::cos(rpy[0]), sr = std::sin(rpy[0]), cp = std::cos(rpy[1]),
               sp = std::sin(rpy[1]), cy = std::cos(rpy[2]), sy = std::sin(rpy[2]);
  const Triple a{v[0], cr * v[1] - sr * v[2], sr * v[1] + cr * v[2]};
  const Triple b{cp * a[0] + sp * a[2], a[1], cp * a[2] - sp * a[0]};
  return {cy * b[0] - sy * b[1], sy * b[0] + cy * b[1], b[2]};
}

JointText hinge(const std::string& name, const std::string& parent, const std::string& child,
                const Triple& at, double angle, double rate, const Plane& plane) {
  JointText j;
  j.name = name;
  j.parent = parent;
  j.child = child;
  const bool on_ground = parent == "ground";
  j.origin_parent = on_ground ? plane.from_plane(at) : at;
  if (on_ground) j.rpy = plane.rpy;
  j.axis = "z";
  j.position = number_text(angle);
  if (rate != 0) j.velocity = number_text(rate);
  return j;
}

void print_closing(const std::string& name, const std::string& parent, const std::string& child,
                   const Triple& at_parent, const Triple& at_child) {
  LoopText l;
  l.name = name;
  l.parent = parent;
  l.child = child;
  l.origin_parent = at_parent;
  l.origin_child = at_child;
  l.axis = "z";
  print_loop(l);
}

}  // namespace momenta::program
