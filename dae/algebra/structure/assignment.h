#pragma once
// Equations assigned to variables.

#include <momenta/dae/algebra/structure/sigma_method.h>

#include <optional>
#include <vector>

namespace momenta::structure {

/// Variable of each equation, each variable once, with the greatest sum of σ: a highest-value
/// transversal. Nothing where the system is structurally singular: no assignment takes every
/// equation to one of its variables. Successive shortest paths, O(n³).
std::optional<std::vector<int>> highest_assignment(const Signature& signature);

/// A largest matching: variable of each equation, −1: left over. O(n · entries)
std::vector<int> largest_matching(const Signature& signature);

/// Obstacles to an assignment, by Dulmage and Mendelsohn: more equations than variables in them,
/// and the reverse. Empty where there is an assignment.
struct Deficiency {
  std::vector<int> equations, their_variables;  ///< overdetermined part
  std::vector<int> variables, their_equations;  ///< underdetermined part
};

/// Found by alternating paths from the rest of a largest matching. O(n²)
/// Source: Dulmage, Mendelsohn, Coverings of bipartite graphs, Canadian J. Math. 10 (1958).
Deficiency deficiency(const Signature& signature);

}  // namespace momenta::structure
