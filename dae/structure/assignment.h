#pragma once
// Equations assigned to variables.

#include <momenta/dae/structure/signature.h>

#include <optional>
#include <vector>

namespace momenta::structure {

/// The variable of each equation, each variable once, with the greatest sum of σ: a highest-value
/// transversal. Nothing where no assignment takes every equation to a variable that it has: the
/// system is structurally singular. Successive shortest paths, O(n³).
std::optional<std::vector<int>> highest_assignment(const Signature& signature);

/// A largest matching: the variable of each equation, −1 for equations left over. O(n · entries)
std::vector<int> largest_matching(const Signature& signature);

/// What keeps a system from an assignment, by Dulmage and Mendelsohn: equations that have fewer
/// variables than they are, and variables that stand in fewer equations than they are. All empty
/// where there is an assignment.
struct Deficiency {
  std::vector<int> equations, their_variables;  ///< overdetermined: more equations than variables
  std::vector<int> variables, their_equations;  ///< underdetermined: more variables than equations
};

/// From a largest matching, by alternating paths from what it leaves over. O(n²)
/// Source: Dulmage, Mendelsohn, Coverings of bipartite graphs, Canadian J. Math. 10 (1958).
Deficiency deficiency(const Signature& signature);

}  // namespace momenta::structure
