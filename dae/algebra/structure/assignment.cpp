#include <momenta/dae/algebra/structure/assignment.h>

#include <algorithm>

namespace momenta::structure {
namespace {

/// Augmenting path from an equation; `seen`: variables on it.
bool augment(const Signature& s, int equation, std::vector<char>& seen, std::vector<int>& variable,
             std::vector<int>& equation_of) {
  // Depth first, without recursion: paths may be long.
  struct Place {
    int equation, next;
  };
  std::vector<Place> way{{equation, 0}};
  std::vector<int> taken;
  while (!way.empty()) {
    auto& [i, j] = way.back();
    while (j < s.size() && (!s.has(i, j) || seen[at(j)])) ++j;
    if (j == s.size()) {
      way.pop_back();
      if (!taken.empty()) taken.pop_back();
      continue;
    }
    seen[at(j)] = 1;
    taken.push_back(j);
    if (equation_of[at(j)] < 0) {
      for (std::size_t k = 0; k < way.size(); ++k) {
        variable[at(way[k].equation)] = taken[k];
        equation_of[at(taken[k])] = way[k].equation;
      }
      return true;
    }
    way.push_back({equation_of[at(j)], 0});
  }
  return false;
}

}  // namespace

std::optional<std::vector<int>> highest_assignment(const Signature& s) {
  // Costs −σ; an absent entry costs more than any complete assignment.
  const int n = s.size();
  long largest = 1;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      if (s.has(i, j)) largest = std::max(largest, std::abs(static_cast<long>(s(i, j))));
  const long none = 4 * largest * (n + 1);
  const auto cost = [&](int i, int j) { return s.has(i, j) ? -static_cast<long>(s(i, j)) : none; };
  // Dual variables u of equations, v of variables, with cost(i, j) ≥ u_i + v_j; numbered from 1, 0:
  // none.
  std::vector<long> u(at(n + 1)), v(at(n + 1));
  std::vector<int> equation_of(at(n + 1)), from(at(n + 1));
  for (int i = 1; i <= n; ++i) {
    equation_of[0] = i;
    int j0 = 0;
    std::vector<long> least(at(n + 1), std::numeric_limits<long>::max());
    std::vector<char> done(at(n + 1));
    do {
      done[at(j0)] = 1;
      const int i0 = equation_of[at(j0)];
      long step = std::numeric_limits<long>::max();
      int next = 0;
      for (int j = 1; j <= n; ++j) {
        if (done[at(j)]) continue;
        const long slack = cost(i0 - 1, j - 1) - u[at(i0)] - v[at(j)];
        if (slack < least[at(j)]) least[at(j)] = slack, from[at(j)] = j0;
        if (least[at(j)] < step) step = least[at(j)], next = j;
      }
      for (int j = 0; j <= n; ++j)
        if (done[at(j)])
          u[at(equation_of[at(j)])] += step, v[at(j)] -= step;
        else if (j > 0)
          least[at(j)] -= step;
      j0 = next;
    } while (equation_of[at(j0)] != 0);
    for (; j0 != 0; j0 = from[at(j0)]) equation_of[at(j0)] = equation_of[at(from[at(j0)])];
  }
  std::vector<int> variable(at(n));
  for (int j = 1; j <= n; ++j) {
    const int i = equation_of[at(j)] - 1;
    if (!s.has(i, j - 1)) return std::nullopt;
    variable[at(i)] = j - 1;
  }
  return variable;
}

std::vector<int> largest_matching(const Signature& s) {
  std::vector<int> variable(at(s.size()), -1), equation_of(at(s.size()), -1);
  for (int i = 0; i < s.size(); ++i) {
    std::vector<char> seen(at(s.size()));
    augment(s, i, seen, variable, equation_of);
  }
  return variable;
}

Deficiency deficiency(const Signature& s) {
  const int n = s.size();
  const std::vector<int> variable = largest_matching(s);
  std::vector<int> equation_of(at(n), -1);
  for (int i = 0; i < n; ++i)
    if (variable[at(i)] >= 0) equation_of[at(variable[at(i)])] = i;
  Deficiency found;
  std::vector<char> equation(at(n)), of_them(at(n));
  for (int i = 0; i < n; ++i)
    if (variable[at(i)] < 0) found.equations.push_back(i), equation[at(i)] = 1;
  for (std::size_t k = 0; k < found.equations.size(); ++k)
    for (int j = 0; j < n; ++j) {
      if (!s.has(found.equations[k], j) || of_them[at(j)]) continue;
      of_them[at(j)] = 1;
      found.their_variables.push_back(j);
      const int i = equation_of[at(j)];  // a path to a free variable would augment the matching
      if (!equation[at(i)]) equation[at(i)] = 1, found.equations.push_back(i);
    }
  std::vector<char> free_variable(at(n)), met(at(n));
  for (int j = 0; j < n; ++j)
    if (equation_of[at(j)] < 0) found.variables.push_back(j), free_variable[at(j)] = 1;
  for (std::size_t k = 0; k < found.variables.size(); ++k)
    for (int i = 0; i < n; ++i) {
      if (!s.has(i, found.variables[k]) || met[at(i)]) continue;
      met[at(i)] = 1;
      found.their_equations.push_back(i);
      const int j = variable[at(i)];
      if (!free_variable[at(j)]) free_variable[at(j)] = 1, found.variables.push_back(j);
    }
  for (auto* list :
       {&found.equations, &found.their_variables, &found.variables, &found.their_equations})
    std::sort(list->begin(), list->end());
  return found;
}

}  // namespace momenta::structure
