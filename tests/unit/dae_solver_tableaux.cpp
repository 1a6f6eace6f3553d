// The coefficients of the explicit methods against the conditions they were solved from: row sums
// Σ_j a_ij = c_i, the order conditions of rooted trees (Hairer, Norsett, Wanner I, II.2),
// quadrature conditions Σ b_i c_i^k = 1/(k+1), and the simplifying conditions of the method of
// order 8.

#include <gtest/gtest.h>
#include <momenta/dae/solver/tableau_dop853.h>
#include <momenta/dae/solver/tableau_dp5.h>
#include <momenta/dae/solver/tableau_rk4.h>

#include <cmath>
#include <vector>

namespace {

using namespace momenta::explicit_rk;
using Vector = std::vector<long double>;

// Coefficients up to 40 in size, each rounded to half an ulp, sums of up to 16 of them.
constexpr double rounding = 2e-14;

template <class Tableau>
struct Conditions {
  Vector c, b;
  std::vector<Vector> a;
  Conditions() {
    for (std::size_t i = 0; i < Tableau::stages; ++i) {
      c.push_back(Tableau::c[i]);
      b.push_back(Tableau::a[Tableau::stages][i]);
      a.emplace_back(Tableau::a[i].begin(), Tableau::a[i].begin() + Tableau::stages);
    }
  }
  Vector times_a(const Vector& v) const {
    Vector r(v.size(), 0);
    for (std::size_t i = 0; i < v.size(); ++i)
      for (std::size_t j = 0; j < v.size(); ++j) r[i] += a[i][j] * v[j];
    return r;
  }
};

Vector product(Vector u, const Vector& v) {
  for (std::size_t i = 0; i < u.size(); ++i) u[i] *= v[i];
  return u;
}
Vector power(const Vector& c, int k) {
  Vector r(c.size(), 1);
  while (k-- > 0) r = product(r, c);
  return r;
}
double dot(const Vector& u, const Vector& v) {
  long double sum = 0;
  for (std::size_t i = 0; i < u.size(); ++i) sum += u[i] * v[i];
  return static_cast<double>(sum);
}

/// The 17 trees up to order 5; conditions beyond `order` are left out.
template <class Tableau>
void expect_order(const Vector& b, int order) {
  const Conditions<Tableau> m;
  const Vector &c = m.c, one(c.size(), 1);
  const auto A = [&](const Vector& v) { return m.times_a(v); };
  const Vector c2 = power(c, 2), c3 = power(c, 3), Ac = A(c);
  const auto expect = [&](int p, const Vector& tree, double density) {
    if (p > order) return;
    EXPECT_NEAR(dot(b, tree), 1 / density, rounding) << "order " << p << ", density " << density;
  };
  expect(1, one, 1);
  expect(2, c, 2);
  expect(3, c2, 3);
  expect(3, Ac, 6);
  expect(4, c3, 4);
  expect(4, product(c, Ac), 8);
  expect(4, A(c2), 12);
  expect(4, A(Ac), 24);
  expect(5, power(c, 4), 5);
  expect(5, product(c2, Ac), 10);
  expect(5, product(Ac, Ac), 20);
  expect(5, product(c, A(c2)), 15);
  expect(5, A(c3), 20);
  expect(5, product(c, A(Ac)), 30);
  expect(5, A(product(c, Ac)), 40);
  expect(5, A(A(c2)), 60);
  expect(5, A(A(Ac)), 120);
}

template <class Tableau>
void expect_row_sums() {
  for (std::size_t i = 0; i < Tableau::a.size(); ++i) {
    long double sum = 0;
    for (const double a : Tableau::a[i]) sum += a;
    EXPECT_NEAR(static_cast<double>(sum), Tableau::c[i], rounding) << "row " << i;
    for (std::size_t j = i; j < Tableau::a[i].size(); ++j) EXPECT_EQ(Tableau::a[i][j], 0);
  }
}

TEST(Tableaux, RowSums) {
  expect_row_sums<TableauRk4>();
  expect_row_sums<TableauDp5>();
  expect_row_sums<TableauDop853>();
}

TEST(Tableaux, OrderConditions) {
  expect_order<TableauRk4>(Conditions<TableauRk4>().b, 4);
  expect_order<TableauDp5>(Conditions<TableauDp5>().b, 5);
  expect_order<TableauDop853>(Conditions<TableauDop853>().b, 5);
}

TEST(Tableaux, EmbeddedOrderOfDp5) {
  // b^ = b - e has seven stages, the last at c = 1 with row b: quadrature and trees of order 4.
  const Conditions<TableauDp5> m;
  Vector b_hat(7), c(7, 1), ac(7, 0);
  for (std::size_t i = 0; i < 7; ++i) b_hat[i] = (i < 6 ? m.b[i] : 0) - TableauDp5::e[0][i];
  for (std::size_t i = 0; i < 7; ++i) {
    c[i] = TableauDp5::c[i];
    for (std::size_t j = 0; j < 6; ++j) ac[i] += TableauDp5::a[i][j] * TableauDp5::c[j];
  }
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(dot(b_hat, power(c, k)), 1.0 / (k + 1), rounding);
  EXPECT_NEAR(dot(b_hat, ac), 1.0 / 6, rounding);
  EXPECT_NEAR(dot(b_hat, product(c, ac)), 1.0 / 8, rounding);
  EXPECT_GT(std::abs(dot(b_hat, power(c, 4)) - 0.2), 1e-4) << "it would be no estimate";
}

TEST(Tableaux, QuadratureOfDop853) {
  const Conditions<TableauDop853> m;
  for (int k = 0; k < 8; ++k)
    EXPECT_NEAR(dot(m.b, power(m.c, k)), 1.0 / (k + 1), rounding) << "power " << k;
  // D(1): Σ_i b_i a_ij = b_j (1 - c_j).
  for (std::size_t j = 0; j < 12; ++j) {
    long double sum = 0;
    for (std::size_t i = 0; i < 12; ++i) sum += m.b[i] * m.a[i][j];
    EXPECT_NEAR(static_cast<double>(sum), static_cast<double>(m.b[j] * (1 - m.c[j])), rounding);
  }
  // C(3) from stage 6 on, the ones b weighs: Σ_j a_ij c_j^k = c_i^(k+1)/(k+1).
  for (int k = 1; k <= 3; ++k) {
    const Vector left = m.times_a(power(m.c, k)), right = power(m.c, k + 1);
    for (std::size_t i = 5; i < 12; ++i)
      EXPECT_NEAR(static_cast<double>(left[i]), static_cast<double>(right[i]) / (k + 1), rounding);
  }
}

TEST(Tableaux, EstimatesOfDop853) {
  Vector high(TableauDop853::e[0].begin(), TableauDop853::e[0].end());
  Vector low(TableauDop853::e[1].begin(), TableauDop853::e[1].end());
  Vector c(TableauDop853::c.begin(), TableauDop853::c.begin() + 13);
  for (int k = 0; k < 5; ++k) EXPECT_NEAR(dot(high, power(c, k)), 0, rounding) << "power " << k;
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(dot(low, power(c, k)), 0, rounding) << "power " << k;
  EXPECT_GT(std::abs(dot(high, power(c, 5))), 1e-5);
  EXPECT_GT(std::abs(dot(low, power(c, 3))), 1e-5);
}

/// What d adds to the Hermite cubic vanishes where the cubic is exact, for y of degree 3 and below:
/// Σ_j d_j c_j^k = 0 for k = 0, 1, 2. A wrong digit anywhere in d shows here.
template <class Tableau>
void expect_dense_output_above_the_cubic() {
  for (const auto& row : Tableau::d) {
    Vector d(row.begin(), row.end()), c(Tableau::c.begin(), Tableau::c.end());
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(dot(d, power(c, k)), 0, 1e-12) << "power " << k;  // d up to 528, rounded
    EXPECT_GT(std::abs(dot(d, power(c, 7))), 0.1);
  }
}

TEST(Tableaux, DenseOutput) {
  expect_dense_output_above_the_cubic<TableauDp5>();
  expect_dense_output_above_the_cubic<TableauDop853>();
}

}  // namespace
