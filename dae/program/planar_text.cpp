#include "planar_text.h"

#include <cmath>

namespace momenta::program {

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
