#pragma once
// The pieces of a mechanism with some coordinates held: bodies and ground between which nothing
// moves (welded, held or driven) are one, whatever their joints are. Between pieces stand ties,
// told by what they are in the own pose and not by how they are written:
//
//   ball      turns about a centre            joints and loops spherical, loops point
//   hinge     turns about a line              joints and loops revolute
//   slide     shifts along a way              joints and loops prismatic
//   distance  two points keep their distance  loops
//
// A joint of several coordinates is a chain of such ties, those of its parts that move: a universal
// joint two hinges, one with an angle held a hinge. Loops of kind universal (two hinges) and
// cylindrical (a hinge and a slide on it) have a piece of their own in between, which is no body.

#include <momenta/dae/mechanism.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace momenta {

/// What moves between two pieces, or from one to itself.
struct Tie {
  enum class Kind { ball, hinge, slide, distance, other };
  Kind kind = Kind::other;
  int first = -1, second = -1;  ///< pieces, the second moves as said on the first
  Eigen::Vector3d centre;       ///< of a ball, on a hinge, on the first end [m], own pose
  Eigen::Vector3d way;  ///< a hinge's or a slide's, of length one; to a distance's second end
  const JointSpec* joint = nullptr;
  const LoopSpec* loop = nullptr;  ///< the other is null
  bool in_part = false;            ///< a loop some of whose coordinates are driven
  /// "joint 'U' of kind universal", for messages.
  std::string in_words() const;
  /// Its line of the file, for messages.
  Location at() const { return joint ? joint->at : loop->at; }
};

/// @throws SceneError: a mechanism in space that is not written as polynomials, and why
[[noreturn]] void refuse_in_space(const Mechanism& mechanism, Location at, const std::string& why);

class Pieces {
 public:
  /// At time t [s], in the pose `poses` of the bodies (poses_of_polynomials) that closes the loops.
  /// @param held of each rate (nv). O(joints + loops)
  Pieces(const Mechanism& mechanism, double t, const std::vector<Eigen::Isometry3d>& poses,
         const std::vector<bool>& held);
  /// The piece of a body of the tree; −1: of the ground.
  int of(int body) const { return number_[static_cast<std::size_t>(body + 1)]; }
  int base() const { return of(-1); }
  /// Pieces have numbers from 0 to this, not all of them.
  int count() const { return static_cast<int>(number_.size()); }
  const std::vector<Tie>& ties() const { return ties_; }
  /// "body 'platform'", the first of a piece, for messages.
  std::string in_words(int piece) const;
  /// The coordinates (nq) with every piece displaced from the own pose so, q there.
  /// @param displaced of each piece (count)
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
  std::vector<int>
      number_;  ///< of the piece of each body, the ground's first; then of those between
  std::vector<Tie> ties_;
};

/// Pieces with two ties, one after the other, between two that have another number of them or
/// stand.
struct TieChain {
  int from = -1, to = -1;        ///< the pieces at its ends
  std::vector<const Tie*> ties;  ///< in order from there to there
  std::vector<int> pieces;       ///< between them, one less
};

/// Every tie is in one of them. The ends of a chain of ties to the base: from there, else from the
/// piece with more ties.
std::vector<TieChain> tie_chains(const Pieces& pieces);

}  // namespace momenta
