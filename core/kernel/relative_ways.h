#pragma once
// The bodies on the ways between bodies of a tree. Relative motion of two bodies is the same seen
// from their lowest common ancestor C, and the effect of two opposite wrenches on them ends there:
//
//   F at x on A, −F at x on B:   E_jᵀ (wrench on what joint j carries) = 0 for j at C and above
//
// So the bodies below C suffice, with C taken as at rest in its own axes.

#include <vector>

namespace momenta {

enum class OnWay : char {
  no,
  at_rest,  ///< ways end here and none goes on: described in its own axes
  moved     ///< a way goes on to its parent
};

class RelativeWays {
 public:
  /// `parents` in depth-first order, −1 for roots.
  explicit RelativeWays(std::vector<int> parents);

  /// Adds the way from a body up to one of its ancestors, or −1, the ground; none from the ground.
  void up(int from, int ancestor);
  /// Adds the ways of two bodies up to their lowest common ancestor. O(their length).
  void between(int a, int b);

  /// For each body, whether ways pass or end there. O(bodies).
  std::vector<OnWay> found() const;

 private:
  std::vector<int> parents_;
  std::vector<int> ends_;  ///< by body: end nearest to the ground of the ways from it
  std::vector<OnWay> found_;
};

}  // namespace momenta
