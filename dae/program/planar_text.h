#pragma once
// Joints of planar mechanisms, as text.

#include <string>

#include "families.h"

namespace momenta::program {

/// A hinge about the plane's normal; `at` in axes of the parent, on the ground of the plane.
JointText hinge(const std::string& name, const std::string& parent, const std::string& child,
                const Triple& at, double angle, double rate, const Plane& plane);

/// Prints a hinge that closes a loop between two bodies.
void print_closing(const std::string& name, const std::string& parent, const std::string& child,
                   const Triple& at_parent, const Triple& at_child);

}  // namespace momenta::program
