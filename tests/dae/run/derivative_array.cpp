// The index from the derivative array: DAEs written by hand whose index is known, ranks against
// exact elimination in whole numbers, derivatives against those of known solutions.

#include <gtest/gtest.h>
#include <momenta/dae/run/measure/derivative_array.h>

#include <Eigen/LU>

#include <random>

namespace momenta::dae_derivative_array {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

template <class F>
IndexFound index_of(int size, const VectorXd& y, const VectorXd& ydot, double t, F&& rows) {
  const CurveSystem system{size,
                           [&](double, const Jet* a, const Jet* b, Jet* r) { rows(a, b, r); }};
  return find_index(system, t, y, ydot, 1.0);
}

VectorXd vector(std::initializer_list<double> x) {
  return Eigen::Map<const VectorXd>(x.begin(), static_cast<Eigen::Index>(x.size()));
}

std::vector<int> free_of(const IndexFound& found) {
  std::vector<int> all;
  for (const auto& level : found.levels) all.push_back(level.undetermined);
  return all;
}
std::vector<int> constraints_of(const IndexFound& found) {
  std::vector<int> all;
  for (const auto& level : found.levels) all.push_back(level.constraints);
  return all;
}

// ---- linear equations with constant coefficients, E y' + A y = 0 --------------------------------

using Whole = std::vector<std::vector<__int128>>;

/// The rank by elimination without fractions (Bareiss): every number stays whole, so nothing is
/// rounded.
int exact_rank(Whole a) {
  const std::size_t rows = a.size(), columns = a[0].size();
  __int128 before = 1;
  std::size_t rank = 0;
  for (std::size_t column = 0; column < columns && rank < rows; ++column) {
    std::size_t pivot = rank;
    while (pivot < rows && a[pivot][column] == 0) ++pivot;
    if (pivot == rows) continue;
    std::swap(a[pivot], a[rank]);
    for (std::size_t i = rank + 1; i < rows; ++i) {
      for (std::size_t j = column + 1; j < columns; ++j)
        a[i][j] = (a[rank][column] * a[i][j] - a[i][column] * a[rank][j]) / before;
      a[i][column] = 0;
    }
    before = a[rank][column];
    ++rank;
  }
  return static_cast<int>(rank);
}

/// G_ν of E y' + A y = 0 from column `from` of the unknowns (y_1, y_2, …) on, in plain derivatives
/// y^(j): row i is E y^(i+1) + A y^(i).
Whole array_of(const MatrixXd& E, const MatrixXd& A, int nu, int from) {
  const auto n = static_cast<int>(E.rows());
  Whole g(static_cast<std::size_t>((nu + 1) * n),
          std::vector<__int128>(static_cast<std::size_t>((nu + 1 - from) * n), 0));
  for (int i = 0; i <= nu; ++i)
    for (int row = 0; row < n; ++row)
      for (int column = 0; column < n; ++column) {
        auto& line = g[static_cast<std::size_t>(i * n + row)];
        if (i >= from)
          line[static_cast<std::size_t>((i - from) * n + column)] +=
              static_cast<long>(E(row, column));
        if (i - 1 >= from)
          line[static_cast<std::size_t>((i - 1 - from) * n + column)] +=
              static_cast<long>(A(row, column));
      }
  return g;
}

/// Whole numbers with determinant 1.
MatrixXd unimodular(int n, std::mt19937& random) {
  std::uniform_int_distribution<int> any(-1, 1);
  MatrixXd lower = MatrixXd::Identity(n, n), upper = lower;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < i; ++j) {
      lower(i, j) = any(random);
      upper(j, i) = any(random);
    }
  return lower * upper;
}

TEST(DerivativeArray, IndexOfAPencilIsItsNilpotency) {
  std::mt19937 random(5);
  for (int index = 0; index <= 4; ++index)
    for (int trial = 0; trial < 6; ++trial) {
      // Kronecker's form: an ODE of two unknowns, a chain of `index` and one of length one or two.
      const int shorter = std::min(index, 1 + trial % 2), n = 2 + index + shorter;
      MatrixXd E = MatrixXd::Zero(n, n), A = MatrixXd::Identity(n, n);
      E.topLeftCorner(2, 2).setIdentity();
      A.topLeftCorner(2, 2) << 1, 2, -1, 1;
      for (int i = 0; i + 1 < index; ++i) E(2 + i, 3 + i) = 1;
      for (int i = 0; i + 1 < shorter; ++i) E(2 + index + i, 3 + index + i) = 1;
      const MatrixXd P = unimodular(n, random), Q = unimodular(n, random);
      E = P * E * Q;
      A = P * A * Q;
      // The solution through the pencil's own unknowns z = Q y: z of the chains is zero.
      const VectorXd z0 = VectorXd::Unit(n, 0);
      VectorXd zdot = VectorXd::Zero(n);
      zdot.head(2) << -1, 1;
      const VectorXd y = Q.partialPivLu().solve(z0), ydot = Q.partialPivLu().solve(zdot);
      const IndexFound found = index_of(n, y, ydot, 0, [&](const Jet* a, const Jet* b, Jet* r) {
        for (int i = 0; i < n; ++i) {
          r[i] = Jet(0.0);
          for (int j = 0; j < n; ++j) r[i] += E(i, j) * b[j] + A(i, j) * a[j];
        }
      });
      ASSERT_TRUE(found.decided) << found.why;
      EXPECT_EQ(found.index, index) << "trial " << trial;
      for (const ArrayLevel& level : found.levels) {
        const int nu = level.differentiations, rank = exact_rank(array_of(E, A, nu, 0)),
                  rest = nu == 0 ? 0 : exact_rank(array_of(E, A, nu, 1));
        EXPECT_EQ(level.rank, rank) << index << " " << nu;
        EXPECT_EQ(level.undetermined, n - (rank - rest)) << index << " " << nu;
        EXPECT_GT(level.gap, 1e6);
      }
    }
}

TEST(DerivativeArray, APencilThatIsSingularHasNoIndex) {
  // y_1 + y_2 = 0 twice: their difference is free for ever.
  const IndexFound found =
      index_of(2, vector({1, -1}), vector({0, 0}), 0, [](const Jet* y, const Jet*, Jet* r) {
        r[0] = y[0] + y[1];
        r[1] = 2.0 * y[0] + 2.0 * y[1];
      });
  EXPECT_EQ(found.index, -1);
  EXPECT_TRUE(found.decided);
  EXPECT_EQ(free_of(found), (std::vector<int>{2, 1, 1, 1, 1}));
  EXPECT_NE(found.why.find("1 direction of y' not determined"), std::string::npos) << found.why;
}

// ---- the pendulum by hand: x² + y² = 1, gravity g along −y
// ---------------------------------------

constexpr double g = 9.81, angle = 0.3, rate = 1.7;

struct Pendulum {
  double x = std::sin(angle), y = -std::cos(angle);
  double u = rate * std::cos(angle), v = rate * std::sin(angle);
  // Φ = (x² + y² − 1)/2, λ of u' = −x λ, v' = −y λ − g: Φ̈ = 0 gives u² + v² − λ − g y = 0.
  double lambda = rate * rate - g * y;
  double udot = -x * lambda, vdot = -y * lambda - g;
  double lambdadot = -3 * g * v;  // d/dt (u² + v² − g y) = 2(u u' + v v') − g v = −3 g v
};

TEST(DerivativeArray, PendulumWithForces) {
  const Pendulum p;
  const VectorXd state = vector({p.x, p.y, p.u, p.v, p.lambda});
  const VectorXd rates = vector({p.u, p.v, p.udot, p.vdot, p.lambdadot});
  const auto level = [&](int derivative) {
    return index_of(5, state, rates, 0, [&](const Jet* y, const Jet* ydot, Jet* r) {
      r[0] = ydot[0] - y[2];
      r[1] = ydot[1] - y[3];
      r[2] = ydot[2] + y[0] * y[4];
      r[3] = ydot[3] + y[1] * y[4] + Jet(g);
      if (derivative == 0) r[4] = 0.5 * (y[0] * y[0] + y[1] * y[1]) - Jet(0.5);
      if (derivative == 1) r[4] = y[0] * y[2] + y[1] * y[3];
      if (derivative == 2)
        r[4] = y[2] * y[2] + y[3] * y[3] - (y[0] * y[0] + y[1] * y[1]) * y[4] - g * y[1];
    });
  };
  const IndexFound three = level(0), two = level(1), one = level(2);
  EXPECT_EQ(three.index, 3);
  EXPECT_EQ(constraints_of(three), (std::vector<int>{1, 2, 3, 3}));
  EXPECT_EQ(two.index, 2);
  EXPECT_EQ(constraints_of(two), (std::vector<int>{1, 2, 2}));
  EXPECT_EQ(one.index, 1);
  EXPECT_EQ(constraints_of(one), (std::vector<int>{1, 1}));
  // λ' is what comes last; x', y' stand in the equations.
  EXPECT_EQ(three.levels[0].determined, (std::vector<bool>{true, true, true, true, false}));
  EXPECT_EQ(three.levels[2].determined, (std::vector<bool>{true, true, true, true, false}));
  EXPECT_EQ(three.appears, (std::vector<bool>{true, true, true, true, false}));
}

TEST(DerivativeArray, PendulumOfThePaper) {
  // m = 1: p = (u, v) in (5a)-(5c), and p = (u, v) + Φ_qᵀσ in (7), (8); any σ will do.
  const Pendulum p;
  const IndexFound five =
      index_of(5, vector({p.x, p.y, p.u, p.v, p.lambda}), vector({p.u, p.v, p.udot, p.vdot, 0}), 0,
               [](const Jet* y, const Jet* ydot, Jet* r) {
                 r[0] = ydot[0] - y[2];  // q̇ = ∂H/∂p
                 r[1] = ydot[1] - y[3];
                 r[2] = ydot[2] + y[0] * y[4];  // ṗ = −∂H/∂q − Φ_qᵀλ
                 r[3] = ydot[3] + y[1] * y[4] + Jet(g);
                 r[4] = 0.5 * (y[0] * y[0] + y[1] * y[1]) - Jet(0.5);
               });
  EXPECT_EQ(five.index, 3) << "the paper says 2";
  const double sigma = 0.4;
  const VectorXd state = vector({p.x, p.y, p.u + p.x * sigma, p.v + p.y * sigma, sigma});
  const VectorXd rates = vector({p.u, p.v, p.u * sigma, p.v * sigma - g, p.lambda});
  const auto with_impulse = [&](bool of_positions) {
    return index_of(5, state, rates, 0, [&](const Jet* y, const Jet* ydot, Jet* r) {
      r[0] = ydot[0] + y[0] * y[4] - y[2];  // M q̇ + Φ_qᵀσ = p
      r[1] = ydot[1] + y[1] * y[4] - y[3];
      r[2] = ydot[2] - ydot[0] * y[4];  // ṗ = L_q + Φ̇_qᵀσ
      r[3] = ydot[3] - ydot[1] * y[4] + Jet(g);
      r[4] = of_positions ? 0.5 * (y[0] * y[0] + y[1] * y[1]) - Jet(0.5)
                          : y[0] * ydot[0] + y[1] * ydot[1];
    });
  };
  const IndexFound two = with_impulse(true), one = with_impulse(false);
  EXPECT_EQ(two.index, 2);
  EXPECT_EQ(constraints_of(two), (std::vector<int>{1, 2, 2}));
  EXPECT_EQ(one.index, 1);
  EXPECT_EQ(constraints_of(one), (std::vector<int>{1, 1}));
}

TEST(DerivativeArray, AWrongGuessOfUndeterminedRatesIsCorrected) {
  // λ' guessed as 100 where −3 g v is right: the third level finds derivatives that fit.
  const Pendulum p;
  const IndexFound found =
      index_of(5, vector({p.x, p.y, p.u, p.v, p.lambda}), vector({p.u, p.v, p.udot, p.vdot, 100}),
               0, [](const Jet* y, const Jet* ydot, Jet* r) {
                 r[0] = ydot[0] - y[2];
                 r[1] = ydot[1] - y[3];
                 r[2] = ydot[2] + y[0] * y[4];
                 r[3] = ydot[3] + y[1] * y[4] + Jet(g);
                 r[4] = 0.5 * (y[0] * y[0] + y[1] * y[1]) - Jet(0.5);
               });
  EXPECT_EQ(found.index, 3);
  EXPECT_GE(found.levels.size(), 3u);
  for (const auto& level : found.levels) EXPECT_LT(level.residual, 1e-12);
}

TEST(DerivativeArray, APointThatHiddenConstraintsForbidIsRefused) {
  // On the circle, but moving off it: Φ̇ ≠ 0, and no derivatives meet the differentiated equations.
  const Pendulum p;
  const IndexFound found =
      index_of(5, vector({p.x, p.y, p.x, p.y, p.lambda}), vector({p.x, p.y, 0, 0, 0}), 0,
               [](const Jet* y, const Jet* ydot, Jet* r) {
                 r[0] = ydot[0] - y[2];
                 r[1] = ydot[1] - y[3];
                 r[2] = ydot[2] + y[0] * y[4];
                 r[3] = ydot[3] + y[1] * y[4] + Jet(g);
                 r[4] = 0.5 * (y[0] * y[0] + y[1] * y[1]) - Jet(0.5);
               });
  EXPECT_EQ(found.index, -1);
  EXPECT_FALSE(found.decided);
  EXPECT_NE(found.why.find("residual"), std::string::npos) << found.why;
}

TEST(DerivativeArray, RanksThatAreNotClearAreNotDecided) {
  // y_1' + y_2' twice but for `apart`: two equations, one, or neither here nor there.
  const auto found = [](double apart) {
    return index_of(2, vector({0, 0}), vector({0, 0}), 0,
                    [apart](const Jet* y, const Jet* ydot, Jet* r) {
                      r[0] = ydot[0] + ydot[1] - y[0];
                      r[1] = ydot[0] + (1 + apart) * ydot[1] - y[1];
                    });
  };
  EXPECT_EQ(found(1e-3).index, 0);
  EXPECT_EQ(found(0).index, 1);
  EXPECT_FALSE(found(1e-7).decided);
  EXPECT_EQ(found(1e-7).why.rfind("not decided: the gap", 0), 0u) << found(1e-7).why;
}

TEST(DerivativeArray, RanksByGap) {
  EXPECT_EQ(rank_by_gap(vector({1, 1e-4, 1e-17}), 1).rank, 2);
  EXPECT_EQ(rank_by_gap(vector({1, 0.5, 0.1}), 1).rank, 3);
  EXPECT_EQ(rank_by_gap(vector({1e-18, 1e-19}), 1).rank, 0);
  EXPECT_EQ(rank_by_gap(vector({0, 0}), 0).rank, 0);
  EXPECT_NEAR(rank_by_gap(vector({1, 1e-3, 1e-9, 1e-10}), 1).gap(), 1e6, 1);
}

}  // namespace
}  // namespace momenta::dae_derivative_array
