// The coefficients of the explicit methods against the conditions they were solved from: row sums
// Σ_j a_ij = c_i, and the order conditions of all rooted trees, for the end value, the embedded
// methods and the dense output.
//
// A tree t with the subtrees t_1, …, t_m at its root has
//
//   Φ_i(t) = Π_k Σ_j a_ij Φ_j(t_k),   γ(t) = |t| Π_k γ(t_k),
//
// and y + h Σ_i w_i k_i is y(t + θh) up to order p when Σ_i w_i Φ_i(t) = θ^|t|/γ(t) for all trees
// of up to p nodes. Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I,
// II.2 (theorem 2.13), II.6 (dense output).

#include <gtest/gtest.h>
#include <momenta/dae/integrator/tableau_dop853.h>
#include <momenta/dae/integrator/tableau_dp5.h>
#include <momenta/dae/integrator/tableau_rk4.h>
#include <momenta/dae/integrator/tableau_vern9.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace momenta::dae_solver_tableaux {
namespace {

using namespace momenta::explicit_rk;
using Vector = std::vector<long double>;

// Coefficients up to 40 in size, each rounded to half an ulp, sums of up to 16 of them.
constexpr double rounding = 2e-14;

Vector sum(Vector u, long double factor, const Vector& v) {
  for (std::size_t i = 0; i < v.size(); ++i) u[i] += factor * v[i];
  return u;
}
/// A row of a tableau over all stages.
template <class Row>
Vector weights(const Row& row, std::size_t stages) {
  Vector w(row.begin(), row.end());
  w.resize(stages, 0);
  return w;
}

struct Tree {
  int nodes;
  long double density;  ///< γ
  Vector weight;        ///< Φ
  Vector below;         ///< Σ_j a_ij Φ_j, what it gives as a subtree
};

/// The rooted trees of up to `order` nodes as a method's stages see them, those for dense output
/// included.
template <class Tableau>
class OrderConditions {
 public:
  static constexpr std::size_t stages = Tableau::a.size();

  explicit OrderConditions(int order) {
    for (int nodes = 1; nodes <= order; ++nodes)
      graft({nodes, static_cast<long double>(nodes), Vector(stages, 1), {}}, nodes - 1,
            trees_.size());
  }

  /// Largest |Σ_i w_i Φ_i - target θ^|t|/γ| over the trees of so many nodes; target is 0 for
  /// differences of methods.
  double defect(int nodes, const Vector& w, double target, double theta = 1) const {
    long double largest = 0;
    for (const Tree& t : trees_) {
      if (t.nodes != nodes) continue;
      long double left = 0;
      for (std::size_t i = 0; i < stages; ++i) left += w[i] * t.weight[i];
      const long double right = target * std::pow(theta, nodes) / t.density;
      largest = std::max(largest, std::abs(left - right));
    }
    return static_cast<double>(largest);
  }

  std::vector<int> counts() const {
    std::vector<int> n;
    for (const Tree& t : trees_) {
      n.resize(static_cast<std::size_t>(t.nodes));
      ++n.back();
    }
    return n;
  }

 private:
  /// All ways to hang `rest` more nodes on the root: subtrees from the first `candidates` trees,
  /// in descending order, so that each tree comes once.
  void graft(Tree t, int rest, std::size_t candidates) {
    if (rest == 0) {
      t.below.assign(stages, 0);
      for (std::size_t i = 0; i < stages; ++i)
        for (std::size_t j = 0; j < i; ++j) t.below[i] += Tableau::a[i][j] * t.weight[j];
      trees_.push_back(std::move(t));
      return;
    }
    for (std::size_t k = candidates; k-- > 0;) {
      if (trees_[k].nodes > rest) continue;
      Tree more = t;
      more.density *= trees_[k].density;
      for (std::size_t i = 0; i < stages; ++i) more.weight[i] *= trees_[k].below[i];
      graft(std::move(more), rest - trees_[k].nodes, k + 1);
    }
  }
  std::vector<Tree> trees_;
};

template <class Tableau>
Vector end_weights() {
  return weights(Tableau::a[Tableau::stages], Tableau::a.size());
}

/// Weights of y(θ), from the form in explicit_step.h.
template <class Tableau>
Vector dense_weights(double theta) {
  const std::size_t s = Tableau::stages, all = Tableau::a.size();
  const Vector b = end_weights<Tableau>();
  Vector first(all, 0), last(all, 0);
  first[0] = last[s] = 1;
  std::vector<Vector> r{b, sum(first, -1, b)};
  r.push_back(sum(sum(b, -1, last), -1, r[1]));
  for (std::size_t row = 0; row < Tableau::dense_rows; ++row)
    r.push_back(weights(Tableau::d[row], all));
  Vector w(all, 0);
  long double factor = 1;
  for (std::size_t j = 0; j < r.size(); ++j)
    w = sum(w, factor *= (j % 2 == 0 ? theta : 1 - theta), r[j]);
  return w;
}

template <class Tableau>
void expect_row_sums() {
  for (std::size_t i = 0; i < Tableau::a.size(); ++i) {
    long double row = 0;
    for (const double a : Tableau::a[i]) row += a;
    EXPECT_NEAR(static_cast<double>(row), Tableau::c[i], rounding) << "row " << i;
    for (std::size_t j = i; j < Tableau::a[i].size(); ++j) EXPECT_EQ(Tableau::a[i][j], 0);
  }
}

/// Order `order` and no more.
template <class Tableau>
void expect_order(const Vector& w, int order, double target = 1) {
  const OrderConditions<Tableau> conditions(order + 1);
  for (int p = 1; p <= order; ++p)
    EXPECT_LT(conditions.defect(p, w, target), rounding) << Tableau::name << ", order " << p;
  EXPECT_GT(conditions.defect(order + 1, w, target), 1e-6) << Tableau::name;
}

template <class Tableau>
void expect_dense_order(int order) {
  const OrderConditions<Tableau> conditions(order + 1);
  for (const double theta : {0.2, 0.5, 0.9}) {
    const Vector w = dense_weights<Tableau>(theta);
    for (int p = 1; p <= order; ++p)
      EXPECT_LT(conditions.defect(p, w, 1, theta), rounding) << "θ " << theta << ", order " << p;
    EXPECT_GT(conditions.defect(order + 1, w, 1, theta), 1e-8) << "θ " << theta;
  }
}

TEST(Tableaux, RowSums) {
  expect_row_sums<TableauRk4>();
  expect_row_sums<TableauDp5>();
  expect_row_sums<TableauDop853>();
  expect_row_sums<TableauVern9>();
}

TEST(Tableaux, AllTreesAreTried) {
  EXPECT_EQ(OrderConditions<TableauRk4>(9).counts(),
            (std::vector<int>{1, 1, 2, 4, 9, 20, 48, 115, 286}));
}

TEST(Tableaux, OrderOfTheEndValue) {
  expect_order<TableauRk4>(end_weights<TableauRk4>(), 4);
  expect_order<TableauDp5>(end_weights<TableauDp5>(), 5);
  expect_order<TableauDop853>(end_weights<TableauDop853>(), 8);
  expect_order<TableauVern9>(end_weights<TableauVern9>(), 9);
}

TEST(Tableaux, OrderOfTheErrorEstimates) {
  // Differences of two methods vanish up to the lower order.
  const auto e = [](const auto& row, const auto& a) { return weights(row, a.size()); };
  expect_order<TableauDp5>(e(TableauDp5::e[0], TableauDp5::a), 4, 0);
  expect_order<TableauDop853>(e(TableauDop853::e[0], TableauDop853::a), 5, 0);
  expect_order<TableauDop853>(e(TableauDop853::e[1], TableauDop853::a), 3, 0);
  expect_order<TableauVern9>(e(TableauVern9::e[0], TableauVern9::a), 8, 0);
}

TEST(Tableaux, OrderOfTheDenseOutput) {
  expect_dense_order<TableauRk4>(3);
  expect_dense_order<TableauDp5>(4);
  expect_dense_order<TableauDop853>(7);
  expect_dense_order<TableauVern9>(8);
}

}  // namespace

}  // namespace momenta::dae_solver_tableaux
