#pragma once
// A body of the tree for the fused sweeps: constants of its edge, inertia and places in arrays in
// one flat record, bodies in depth-first order.
//
// Nearly all trees are made of revolute joints without drives: these have the fast path and compact
// records. Joints on one axis that slide, screw, are driven or welded are eliminated in one piece
// (axis_joint.h); free and user joints take the general path.
//
// Two things are constant while the tree moves and are computed once:
//   - The first moment of a subtree about O: children on revolute joints stay where their joint is,
//     so their masses act there; `moment` holds the body's own m c and those masses.
//   - A revolute joint at the leaf of the tree: its M*, its reduced mass matrix (47) and M*E M_j⁻¹
//   are constants (`Leaf`).

#include <momenta/core/kernel/model.h>
#include <momenta/core/kernel/reduced_inertia.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

enum class LinkKind : std::uint8_t { revolute, spherical, general };

/// The turn and shift about x between the z axes of the parent and of the revolute joint, by the
/// work they need. `tilted`: nearly parallel axes, a turn about y besides.
enum class Turn : std::uint8_t { general, right, parallel, tilted };

/// Path of a link in the inward sweep. Most lie inside a chain: a revolute joint with one child,
/// its parent's first, without screw about the parent's z and without rotor. Neighbours with one
/// kind of turn run through a branchless loop, at most from a leaf to the ground; others go one by
/// one.
enum class Path : std::uint8_t { chain_general, chain_right, chain_parallel, root, any };

struct Link {
  double ca = 1, sa = 0, a = 0;  ///< cosine and sine of α, shift along x [m]
  double cc = 1, cs = 0, ss = 0, cs2 = 0,
         ss2 = 0;      ///< cos²α, cos α sin α, sin²α; the last two twice
  double d = 0;        ///< revolute joints: shift along the axis [m]
  double m = 0;        ///< [kg]
  double moment[3]{};  ///< constant part of the subtree's first moment about O [kg m]
  double c[3]{};       ///< the body's own first moment m OG [kg m]
  double J[6]{};       ///< about O: xx xy xz yy yz zz [kg m²]
  double rotor = 0;    ///< inertia on the joint's rate: rotor.h [kg m² or kg]
  int q = 0, u = 0;
  int parent = -1;
  int slot = -1;  ///< place of what children beside the first pass on; −1: none do
  int record =
      -1;  ///< general links: index of their record; spherical joints, leaves: of their constants
  LinkKind kind = LinkKind::revolute;
  Turn turn = Turn::general;
  bool first = false;  ///< the body before is its parent
  bool leaf = false;   ///< carries nothing
  bool carries_branches_alone =
      false;               ///< in a remaining tree (branches/branches.h): all arrives in its slot
  bool opens = false;      ///< last child of its parent, first in the inward sweep
  bool screwed = false;    ///< a screw about the parent's z comes first
  bool one_axis = false;   ///< general links: a screw about z, driven or not, or a weld
  bool has_force = false;  ///< spring, damper or torque on the joint
  bool has_rotor = false;
  Path path = Path::any;
};

/// Whether the inward sweep takes the link by itself.
inline bool alone(const Link& l) {
  return l.path == Path::root || l.path == Path::any;
}

/// Constants of a revolute joint that carries nothing.
struct Leaf {
  double inverse = 0;  ///< M_j⁻¹
  double h[5]{};       ///< M*E M_j⁻¹ without its last entry, 1
  Reduced<double> M;   ///< (47)
};

/// The constant way to a spherical joint: one rotation and one step.
struct SphericalPlace {
  double turn[4]{1, 0, 0, 0};  ///< joint frame in the parent's axes, quaternion w x y z
  bool turned = false;         ///< it is not the unit quaternion
  Vec3<double> origin;         ///< the joint in the parent's frame [m]
};

/// The tree as such records.
struct LinkTree {
  const Model<Spatial>* model = nullptr;
  std::vector<Link> links;
  std::vector<Leaf> leaves;
  std::vector<SphericalPlace> sphericals;
  std::vector<double> theta0;  ///< by link, revolute joints: angle of the frame at q = 0 [rad]
  std::vector<Vec3<double>> weight;  ///< by link: for revolute and spherical joints on the ground,
                                     ///< gravity in their frame before the turn [m/s²]
  std::vector<std::pair<int, double>> rotors;  ///< place in u and inertia: rotor.h
  int slots = 0, records = 0, users = 0;
  bool has_angles = false;  ///< some joint is not spherical: there are sines and cosines
  /// Joint whose inertia is constant and not positive: a leaf without inertia about its revolute
  /// joint; −1: none.
  int singular_joint = -1;
};

/// @pre the model outlives the tree at one address.
LinkTree build_links(const Model<Spatial>& model);

void set_paths(std::vector<Link>& links);

/// Number of links by kind of turn: "12 revolute joints at right angles, 3 parallel, 1 of another
/// kind".
std::string links_in_words(const LinkTree& tree);

}  // namespace momenta
