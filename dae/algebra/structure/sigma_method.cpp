#include <momenta/dae/algebra/structure/assignment.h>
#include <momenta/dae/algebra/structure/sigma_method.h>

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

// The algorithm in Pantelides' terms: growing sets of nodes for variables and equations with their
// derivatives. Only highest derivatives may be matched.

namespace {

class Graph {
 public:
  explicit Graph(const Signature& s) {
    const auto n = static_cast<std::size_t>(s.size());
    // x_j has number j; x_j' has a node of its own if it occurs.
    derivative_.assign(n, none);
    for (int j = 0; j < s.size(); ++j)
      for (int i = 0; i < s.size(); ++i)
        if (s.has(i, j) && s(i, j) > 0 && derivative_[static_cast<std::size_t>(j)] == none)
          add_derivative(static_cast<std::size_t>(j));
    matched_.resize(derivative_.size(), none);
    for (int i = 0; i < s.size(); ++i) {
      std::vector<std::size_t> variables;
      for (int j = 0; j < s.size(); ++j) {
        if (!s.has(i, j)) continue;
        const auto v = static_cast<std::size_t>(j);
        variables.push_back(s(i, j) > 0 ? derivative_[v] : v);
      }
      add_equation(std::move(variables), static_cast<std::size_t>(i), 0);
    }
  }

  std::vector<int> run() {
    const std::size_t given = variables_.size();
    std::vector<int> differentiations(given);
    for (std::size_t k = 0; k < given; ++k) {
      std::size_t equation = k;
      for (;;) {
        variable_seen_.assign(derivative_.size(), false);
        equation_seen_.assign(variables_.size(), false);
        if (augment(equation)) break;
        differentiate();
        equation = differentiated_[equation];
      }
    }
    for (std::size_t e = 0; e < variables_.size(); ++e) {
      int& most = differentiations[root_[e]];
      if (order_[e] > most) most = order_[e];
    }
    return differentiations;
  }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  std::size_t add_derivative(std::size_t variable) {
    derivative_[variable] = derivative_.size();
    derivative_.push_back(none);
    matched_.resize(derivative_.size(), none);
    return derivative_[variable];
  }
  void add_equation(std::vector<std::size_t> variables, std::size_t root, int order) {
    variables_.push_back(std::move(variables));
    differentiated_.push_back(none);
    root_.push_back(root);
    order_.push_back(order);
  }

  bool augment(std::size_t e) {
    equation_seen_[e] = true;
    for (const std::size_t v : variables_[e])
      if (derivative_[v] == none && matched_[v] == none) {
        matched_[v] = e;
        return true;
      }
    for (const std::size_t v : variables_[e]) {
      if (derivative_[v] != none || variable_seen_[v]) continue;
      variable_seen_[v] = true;
      if (!augment(matched_[v])) continue;
      matched_[v] = e;
      return true;
    }
    return false;
  }

  void differentiate() {
    const std::size_t variables = variable_seen_.size(), equations = equation_seen_.size();
    for (std::size_t v = 0; v < variables; ++v)
      if (variable_seen_[v]) add_derivative(v);
    for (std::size_t e = 0; e < equations; ++e) {
      if (!equation_seen_[e]) continue;
      std::vector<std::size_t> of_derivative = variables_[e];
      for (const std::size_t v : variables_[e]) {
        if (derivative_[v] == none) add_derivative(v);
        of_derivative.push_back(derivative_[v]);
      }
      differentiated_[e] = variables_.size();
      add_equation(std::move(of_derivative), root_[e], order_[e] + 1);
    }
    for (std::size_t v = 0; v < variables; ++v)
      if (variable_seen_[v]) matched_[derivative_[v]] = differentiated_[matched_[v]];
  }

  std::vector<std::size_t> derivative_, matched_;    ///< variables' x', assigned equation
  std::vector<std::vector<std::size_t>> variables_;  ///< equations' variables
  std::vector<std::size_t> differentiated_, root_;
  std::vector<int> order_;
  std::vector<bool> variable_seen_, equation_seen_;
};

}  // namespace

std::vector<int> pantelides(const Signature& s) {
  return Graph(s).run();
}

}  // namespace momenta::structure
