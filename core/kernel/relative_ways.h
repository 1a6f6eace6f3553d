#pragma once
// Which bodies are on the ways between bodies of a tree. What depends on the motion of two bodies
// relative to each other alone is the same seen from their lowest common ancestor C, and what two
// opposite wrenches on them do ends there:
//
//   F at x on A, −F at x on B:   E_jᵀ (wrench on what joint j carries) = 0 for j at C and above
//
// So the bodies below C are enough, with C taken for at rest in its own axes.

#include <vector>

namespace momenta {

enum class OnWay : char {
  no,
  at_rest,  ///< ways end here and none goes on: its own axes serve
  moved     ///< a way goes on to its parent
};

class RelativeWays {
 public:
  /// `parents` in depth-first order, −1 for roots.
  explicit RelativeWays(std::vector<int> parents);

  /// The way from a body up to one of its ancestors, or −1, the ground. From the ground: none.
  void up(int from, int ancestor);
  /// The ways of two bodies up to their lowest common ancestor. O(their length).
  void between(int a, int b);

  /// Per body. O(bodies).
  std::vector<OnWay> found() const;

 private:
  std::vector<int> parents_;
  std::vector<int> ends_;  ///< per body, of the ways from it, the end nearest to the ground
  std::vector<OnWay> found_;
};

}  // namespace momenta
