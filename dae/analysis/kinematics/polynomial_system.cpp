#include <momenta/dae/analysis/kinematics/polynomial_system.h>

#include <algorithm>
#include <map>
#include <utility>

namespace momenta {
Polynomial gathered(const Polynomial& p) {
  std::map<std::vector<int>, Complex> sums;
  for (const Monomial& m : p) {
    std::vector<int> sorted = m.variables;
    std::sort(sorted.begin(), sorted.end());
    sums[std::move(sorted)] += m.factor;
  }
  double largest = 0;
  for (const auto& [variables, factor] : sums) largest = std::max(largest, std::abs(factor));
  constexpr double rounding = 1e-14;  // relative to the largest factor
  Polynomial result;
  for (const auto& [variables, factor] : sums)
    if (std::abs(factor) > rounding * largest) result.push_back({factor / largest, variables});
  return result;
}

Polynomial operator+(Polynomial a, const Polynomial& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Polynomial operator*(const Polynomial& a, const Polynomial& b) {
  Polynomial product;
  for (const Monomial& x : a)
    for (const Monomial& y : b) {
      Monomial m{x.factor * y.factor, x.variables};
      m.variables.insert(m.variables.end(), y.variables.begin(), y.variables.end());
      product.push_back(std::move(m));
    }
  return product;
}

Polynomial scaled(Polynomial a, Complex c) {
  for (Monomial& m : a) m.factor *= c;
  return a;
}

PolynomialSystem::PolynomialSystem(std::vector<Polynomial> equations, const std::vector<int>& of) {
  variables_ = static_cast<int>(of.size());
  const int groups = of.empty() ? 0 : *std::max_element(of.begin(), of.end()) + 1;
  groups_.resize(static_cast<std::size_t>(groups));
  for (int x = 0; x < variables_; ++x)
    groups_[static_cast<std::size_t>(of[static_cast<std::size_t>(x)])].variables.push_back(x);
  std::vector<int> group_of = of;
  for (int g = 0; g < groups; ++g) {
    groups_[static_cast<std::size_t>(g)].variables.push_back(variables_);
    groups_[static_cast<std::size_t>(g)].proper = {{variables_}};
    group_of.push_back(g);
    ++variables_;
  }
  for (const Polynomial& p : equations) {
    Polynomial whole = gathered(p);
    for (int g = 0; g < groups; ++g) {
      const auto degree_of = [&](const Monomial& m) {
        return std::count_if(m.variables.begin(), m.variables.end(),
                             [&](int x) { return group_of[static_cast<std::size_t>(x)] == g; });
      };
      std::ptrdiff_t degree = 0;
      for (const Monomial& m : whole) degree = std::max(degree, degree_of(m));
      const int one = groups_[static_cast<std::size_t>(g)].proper[0][0];
      for (Monomial& m : whole)
        for (std::ptrdiff_t k = degree_of(m); k < degree; ++k) m.variables.push_back(one);
    }
    equations_.push_back(std::move(whole));
  }
  find_degrees();
}

PolynomialSystem::PolynomialSystem(std::vector<Polynomial> equations,
                                   std::vector<VariableGroup> groups)
    : groups_(std::move(groups)) {
  for (const Polynomial& p : equations) equations_.push_back(gathered(p));
  for (const VariableGroup& g : groups_) variables_ += static_cast<int>(g.variables.size());
  find_degrees();
}

void PolynomialSystem::find_degrees() {
  for (const Polynomial& p : equations_) {
    std::vector<int> degrees;
    for (const VariableGroup& g : groups_) {
      int degree = 0;
      if (!p.empty())
        for (const int x : p[0].variables)
          degree += std::find(g.variables.begin(), g.variables.end(), x) != g.variables.end();
      degrees.push_back(degree);
    }
    degrees_.push_back(std::move(degrees));
  }
}

long PolynomialSystem::bezout(long most) const {
  // Coefficients by exponents, none beyond n_g, equation by equation.
  std::map<std::vector<int>, long> sums{{std::vector<int>(groups_.size(), 0), 1}};
  for (const std::vector<int>& degrees : degrees_) {
    std::map<std::vector<int>, long> next;
    for (const auto& [exponents, count] : sums)
      for (std::size_t g = 0; g < groups_.size(); ++g) {
        if (degrees[g] == 0) continue;
        std::vector<int> more = exponents;
        if (++more[g] >= static_cast<int>(groups_[g].variables.size())) continue;
        long& sum = next[more];
        sum = std::min(most + 1, sum + count * degrees[g]);
      }
    sums = std::move(next);
  }
  long all = 0;
  for (const auto& [exponents, count] : sums) all = std::min(most + 1, all + count);
  return all;
}

void PolynomialSystem::evaluate(const Eigen::VectorXcd& x, Eigen::VectorXcd& values,
                                Eigen::MatrixXcd& slopes) const {
  values.setZero(equations());
  slopes.setZero(equations(), variables_);
  for (Eigen::Index i = 0; i < values.size(); ++i)
    for (const Monomial& m : equations_[static_cast<std::size_t>(i)]) {
      Complex product = m.factor;
      for (const int v : m.variables) product *= x[v];
      values[i] += product;
      for (std::size_t k = 0; k < m.variables.size(); ++k) {
        Complex others = m.factor;
        for (std::size_t j = 0; j < m.variables.size(); ++j)
          if (j != k) others *= x[m.variables[j]];
        slopes(i, m.variables[k]) += others;
      }
    }
}

}  // namespace momenta
