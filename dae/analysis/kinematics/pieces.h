#pragma once
// The pieces of a mechanism with some coordinates held: bodies and ground without motion between
// them (welded, held or driven) are one piece, whatever their joints. Between pieces stand ties,
// told by their motion in the own pose, not by their kind in the file:
//
//   ball      turns about a centre            joints and loops spherical, loops point
//   hinge     turns about a line              joints and loops revolute
//   slide     shifts along a way              joints and loops prismatic
//   distance  two points keep their distance  loops
//
// A joint of several coordinates is a chain of such ties, one for each part that moves: a universal
// joint is two hinges, with one angle held a hinge. Loops of kind universal (two hinges) and
// cylindrical (a hinge and a slide on it) have a piece of their own in between, which is no body.

#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace momenta {

/// Motion between two pieces, or of one to itself.
struct Tie {
  enum class Kind { ball, hinge, slide, distance, other };
  Kind kind = Kind::other;
  int first = -1, second = -1;  ///< pieces; the second moves on the first
  Eigen::Vector3d centre;       ///< ball: centre, hinge: point, distance: first end [m]; own pose
  Eigen::Vector3d way;          ///< hinge, slide: of length one; distance: to its second end
  const JointSpec* joint = nullptr;
  const LoopSpec* loop = nullptr;  ///< joint or loop is null
  bool in_part = false;            ///< some coordinates of the loop are driven
  /// For messages: "joint 'U' of kind universal".
  std::string in_words() const;
  Location at() const { return joint ? joint->at : loop->at; }
};

/// @throws SceneError: why a mechanism in space has no polynomials
[[noreturn]] void refuse_in_space(const Mechanism& mechanism, Location at, const std::string& why);

class Pieces {
 public:
  /// Pieces at time t [s], in the pose `poses` of the bodies (poses_of_polynomials) that closes the
  /// loops. @param held by rate (nv). O(joints + loops)
  Pieces(const Mechanism& mechanism, double t, const std::vector<Eigen::Isometry3d>& poses,
         const std::vector<bool>& held);
  /// −1: ground.
  int of(int body) const { return number_[static_cast<std::size_t>(body + 1)]; }
  int base() const { return of(-1); }
  /// Bound of the pieces' numbers, not all in use.
  int count() const { return static_cast<int>(number_.size()); }
  const std::vector<Tie>& ties() const { return ties_; }
  /// First body of a piece, for messages: "body 'platform'".
  std::string in_words(int piece) const;
  /// Coordinates (nq) with pieces displaced from the own pose, whose coordinates are q. @param
  /// displaced by piece (count)
  Eigen::VectorXd coordinates(const std::vector<Eigen::Isometry3d>& displaced,
                              Eigen::VectorXd q) const;

 private:
  int root(int number) const;
  void join(int a, int b);
  void add_joints(const std::vector<bool>& held);
  void add_loops(double t);
  void add_loop(Tie tie, double t);

  const Mechanism& mechanism_;
  const std::vector<Eigen::Isometry3d>& poses_;
  std::vector<int> number_;  ///< piece of each body, the ground's first; then those between
  std::vector<Tie> ties_;
};

/// A chain through pieces with two ties, between the base or pieces with another number of ties.
struct TieChain {
  int from = -1, to = -1;        ///< end pieces
  std::vector<const Tie*> ties;  ///< from `from` to `to`
  std::vector<int> pieces;
};

/// Chains of all ties. A chain with an end at the base starts there, others at the piece with more
/// ties.
std::vector<TieChain> tie_chains(const Pieces& pieces);

}  // namespace momenta
