#include <momenta/dae/structure/assignment.h>
#include <momenta/dae/structure/sigma_method.h>

#include <algorithm>
#include <numeric>

namespace momenta::structure {

std::optional<Offsets> sigma_method(const Signature& s) {
  const int n = s.size();
  auto transversal = highest_assignment(s);
  if (!transversal) return std::nullopt;
  Offsets o;
  o.transversal = *std::move(transversal);
  o.equation.assign(at(n), 0);
  o.variable.assign(at(n), 0);
  // From c = 0 upwards, the first solution is the least. It ends, as T has the highest value.
  for (bool moved = true; moved;) {
    moved = false;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        if (s.has(i, j))
          o.variable[at(j)] = std::max(o.variable[at(j)], s(i, j) + o.equation[at(i)]);
    for (int i = 0; i < n; ++i) {
      const int j = o.transversal[at(i)], c = o.variable[at(j)] - s(i, j);
      moved |= c != o.equation[at(i)];
      o.equation[at(i)] = c;
    }
  }
  if (n == 0) return o;
  o.index = *std::max_element(o.equation.begin(), o.equation.end()) +
            (*std::min_element(o.variable.begin(), o.variable.end()) == 0 ? 1 : 0);
  o.freedom = std::accumulate(o.variable.begin(), o.variable.end(), 0) -
              std::accumulate(o.equation.begin(), o.equation.end(), 0);
  return o;
}

}  // namespace momenta::structure
