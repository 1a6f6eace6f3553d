#pragma once
// The pieces of a mechanism with some coordinates held: bodies and ground between which nothing
// moves (welded, held or driven) are one, whatever their joints are. Between pieces stand ties:
// joints with a free coordinate, those of kind free apart, and loops.

#include <momenta/dae/mechanism.h>

#include <string>
#include <vector>

namespace momenta {

/// A joint or a loop between two pieces, or from one to itself.
struct Tie {
  enum class Kind {
    ball,       ///< joint spherical, loop spherical or point: it has a centre
    universal,  ///< joint or loop, both its angles free: likewise
    distance,   ///< loop
    other
  };
  Kind kind = Kind::other;
  int parent = -1, child = -1;  ///< bodies of the tree, −1: ground
  const JointSpec* joint = nullptr;
  const LoopSpec* loop = nullptr;  ///< the other is null
  bool in_part = false;            ///< some of its coordinates are held, not all
  /// "joint 'U' of kind universal", for messages.
  std::string in_words() const;
  /// Its line of the file, for messages.
  Location at() const { return joint ? joint->at : loop->at; }
};

class Pieces {
 public:
  /// @param held of each rate (nv). O(joints + loops)
  Pieces(const Mechanism& mechanism, const std::vector<bool>& held);
  /// The piece of a body of the tree, the last part of its joint; −1: of the ground. Numbers from 0
  /// up to the number of bodies.
  int of(int body) const;
  int base() const { return of(-1); }
  const std::vector<Tie>& ties() const { return ties_; }
  /// How many pieces have two ties, both balls: each can turn about the line of their centres.
  int spins() const;

 private:
  std::vector<int> joined_;  ///< a tree for each piece, by body + 1
  std::vector<Tie> ties_;
};

}  // namespace momenta
