#pragma once
// Writes scenes as TOML, table by table on standard output, so that scenes of any size need no
// memory. Numbers have the fewest digits that read back as the same double.

#include <array>
#include <cstdint>
#include <random>
#include <string>

namespace momenta::program {

using Triple = std::array<double, 3>;

/// Plane of a planar mechanism: its x and y in the scene, gravity along its −y.
struct Plane {
  Triple rpy{};  ///< axes of the plane in the scene's: Rz(y) Ry(p) Rx(r)
  Triple from_plane(const Triple& v) const;
};

/// Comment on top, name, gravity and [run].
void print_head(const std::string& comment, const std::string& name, const Triple& gravity,
                double end);
/// The same for loops that pass singular poses: positions are corrected after every step.
void print_corrected_head(const std::string& comment, const std::string& name,
                          const Triple& gravity, double end);

/// A cylinder from the body origin along `axis` ("x", "-z", …).
void print_cylinder(const std::string& name, double mass, double length, double radius,
                    const std::string& axis);
/// A box of these edges about `com`, body axes.
void print_box(const std::string& name, double mass, const Triple& size, const Triple& com);
void print_held(const std::string& joint);

/// A body of moment of inertia `planar` about z through `com`.
void print_plate(const std::string& name, double mass, const Triple& com, double planar);
/// A slender rod from the body origin along x.
void print_rod(const std::string& name, double mass, double length);
/// Solid, about `com`.
void print_ball(const std::string& name, double mass, double radius, const Triple& com);

struct JointText {
  std::string name, kind = "revolute", parent = "ground", child;
  Triple origin_parent{}, rpy{};
  std::string axis;                ///< as in a file: "z", "-x" or "[…]"; empty: none
  std::string position, velocity;  ///< likewise; empty: none
  double stiffness = 0, damping = 0;
};
void print_joint(const JointText& joint);

struct LoopText {
  std::string name, kind = "revolute", parent = "ground", child;
  Triple origin_parent{}, origin_child{}, rpy{};
  std::string axis;
};
void print_loop(const LoopText& loop);

void print_marker(const std::string& name, const std::string& body, const Triple& point);

std::string number_text(double value);
std::string triple_text(const Triple& v);

/// "word" and a number.
std::string numbered(const char* word, int number);

/// Random numbers, the same on every machine.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : bits_(seed) {}
  /// A number in [low, high).
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits_() >> 11) / 9007199254740992.0);
  }
  /// A vector of length one.
  Triple direction();

 private:
  std::mt19937_64 bits_;
};

// Joints of planar mechanisms, as text.

/// A hinge about the plane's normal; `at` in axes of the parent, on the ground of the plane.
JointText hinge(const std::string& name, const std::string& parent, const std::string& child,
                const Triple& at, double angle, double rate, const Plane& plane);

/// Prints a hinge that closes a loop between two bodies.
void print_closing(const std::string& name, const std::string& parent, const std::string& child,
                   const Triple& at_parent, const Triple& at_child);

}  // namespace momenta::program
