// Elements of URDF and URDF+, and tags that files of robots have beside them.

#include <momenta/core/format/xml/known_elements.h>

#include <array>

namespace momenta::reading {
namespace {

constexpr std::array elements{
    KnownElement{"robot", "name version link joint transmission loop coupling material gazebo", "",
                 ""},
    KnownElement{"link", "name inertial visual collision", "type", ""},
    KnownElement{"inertial", "origin mass inertia", "", ""},
    KnownElement{"origin", "xyz rpy quat_xyzw", "", ""},
    KnownElement{"mass", "value", "", ""},
    KnownElement{"inertia", "ixx iyy izz ixy ixz iyz", "", ""},
    KnownElement{"visual", "name origin geometry material", "", ""},
    KnownElement{"geometry", "box sphere cylinder capsule mesh", "", ""},
    KnownElement{"box", "size", "", ""},
    KnownElement{"sphere", "radius", "", ""},
    KnownElement{"cylinder", "length radius", "", ""},
    KnownElement{"capsule", "length radius", "", ""},
    KnownElement{"mesh", "filename scale", "", ""},
    KnownElement{"material", "name color", "texture", ""},
    KnownElement{"color", "rgba", "", ""},
    KnownElement{"joint", "name type parent child origin axis dynamics mimic limit",
                 "calibration independent", "safety_controller"},
    KnownElement{"parent", "link", "", ""},
    KnownElement{"child", "link", "", ""},
    KnownElement{"axis", "xyz", "", ""},
    KnownElement{"dynamics", "damping friction", "", ""},
    KnownElement{"limit", "lower upper", "effort velocity acceleration deceleration jerk", ""},
    KnownElement{"mimic", "joint multiplier offset", "", ""},
    KnownElement{"loop", "name type predecessor successor axis", "", ""},
    KnownElement{"predecessor", "link origin", "", ""},
    KnownElement{"successor", "link origin", "", ""},
    KnownElement{"coupling", "name predecessor successor ratio", "type", ""},
    KnownElement{"ratio", "value", "", ""},
};

}  // namespace

std::span<const KnownElement> urdf_elements() {
  return elements;
}

}  // namespace momenta::reading
