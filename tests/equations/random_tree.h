#pragma once
// Random scenes without loops: what shape the tree has, which joints, where they sit, what drives
// and pulls them. A recipe and a seed give the same scene on every machine.

#include <momenta/core/kernel/tree/tree.h>
#include <momenta/core/scene/scene.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace momenta::equations {

enum class Branching { serial, star, random };
/// How a joint lies in its parent: anyhow, at right angles, or with an axis 1e-3 ... 1e-12 rad from
/// parallel or antiparallel to that of the parent's own joint.
enum class Placing { general, right_angles, degenerate };

struct TreeRecipe {
  int bodies = 6;
  Branching branching = Branching::random;
  Placing placing = Placing::general;
  std::vector<JointKind> kinds = {
      JointKind::revolute,    JointKind::prismatic, JointKind::helical,
      JointKind::cylindrical, JointKind::universal, JointKind::spherical,
      JointKind::planar,      JointKind::free,      JointKind::weld};
  bool gravity = true;
  bool drives = true;        ///< every fourth coordinate or so; of balls and free joints, all
  bool joint_forces = true;  ///< springs, dampers, torques
  bool body_forces = true;   ///< spring-dampers between points, wrenches
  bool rotors = true;        ///< on every third joint that can have some
};

/// The kinds without quaternions: q̇ = u, and p is canonical.
inline const std::vector<JointKind> canonical_kinds{
    JointKind::revolute,  JointKind::prismatic, JointKind::helical, JointKind::cylindrical,
    JointKind::universal, JointKind::planar,    JointKind::weld};

struct TreeState {
  double t = 0;
  Eigen::VectorXd q, u;
};

class RandomTree {
 public:
  explicit RandomTree(unsigned seed) : bits_(seed), rotor_bits_(seed + 1) {}
  /// From bytes, one for each choice, then from a generator: what searches for scenes or makes them
  /// smaller works on bytes. Zeros mostly mean less: nothing that chance() decides on.
  explicit RandomTree(std::span<const unsigned char> bytes) : bytes_(bytes) {}

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits() >> 11) / 9007199254740992.0);
  }
  int below(int count) { return static_cast<int>(bits() % static_cast<unsigned>(count)); }
  bool chance(double p) { return uniform(0, 1) < p; }

  Eigen::Vector3d vector(double size) {
    const double x = uniform(-size, size), y = uniform(-size, size);
    return {x, y, uniform(-size, size)};
  }
  Eigen::Vector3d direction();
  Eigen::Quaterniond turn();

  /// Principal moments of a box of this mass, edges 0.2 to 1 m, anyhow turned: the triangle
  /// inequality holds with room.
  Eigen::Matrix3d inertia(double mass);

  Scene scene(const TreeRecipe& recipe);

  /// A scene that moves in one plane, any plane, axes along the normal or against it; bodies are
  /// offset across it and turned anyhow. Of the recipe's kinds, revolute, prismatic, planar and
  /// weld remain.
  Scene planar_scene(const TreeRecipe& recipe);

  /// A state whose quaternions are of unit length to rounding.
  TreeState state(const Tree& tree);

  /// A law of any kind, of order one between t = 0 and 1.
  DriveSpec drive(const std::string& joint, int coordinate);

 private:
  static std::string body_name(int k) { return k < 0 ? "ground" : "body" + std::to_string(k); }

  BodySpec body(int k);

  JointSpec joint(const TreeRecipe& recipe, int k);

  /// Any direction at least 0.3 rad or so from the line of `axis`.
  Eigen::Vector3d inclined(const Eigen::Vector3d& axis);

  /// 0, or 1e-3 to 1e-12 rad, or around the border where the frames change their form.
  double tilt();

  void effects(const TreeRecipe& recipe, Scene& s, int k);
  void rotors(JointSpec& j);

  std::uint64_t bits() {
    if (bytes_.empty()) return bits_();
    const std::uint64_t all = 0x0101010101010101 * std::uint64_t{bytes_.front()};
    bytes_ = bytes_.subspan(1);
    return ~all;
  }

  std::mt19937_64 bits_, rotor_bits_;
  std::span<const unsigned char> bytes_;
};

}  // namespace momenta::equations
