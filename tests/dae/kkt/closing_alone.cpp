// A loop beside which no other is open closes on its own rows alone (dae/kkt/sweeps/front.h): what
// it adds to M* and D, and its impulses for a motion of the closing body, against W solved as a
// whole,
//
//   M* += C W⁻¹ Cᵀ,  D += C W⁻¹ d,  σ = W⁻¹ (CᵀΩ + d),
//
// and against the same front closed as if others were open: the same pivots, one by one. Of one
// state in registers and with slots apart; of the ground, which does not move, σ = W⁻¹ d.

#include "equations/random_tree.h"

#include <gtest/gtest.h>
#include <momenta/core/kernel/revolute.h>
#include <momenta/core/scalar/pack.h>
#include <momenta/dae/kkt/sweeps/spatial_columns.h>

#include <Eigen/Dense>

#include <vector>

namespace momenta::dae_closing_alone {
namespace {

using equations::RandomTree;
using Matrix = Eigen::MatrixXd;

struct Given {
  int slot, points, others;
  Matrix C;  ///< 6 × rows
  Matrix W;
  Eigen::VectorXd d;
  int rows() const { return points + others; }
};

Given random_loop(RandomTree& random, int slots) {
  Given g;
  const int rows = 1 + random.below(std::min(slots, 6));
  g.points = random.below(std::min(rows, 3) + 1);
  g.others = rows - g.points;
  g.slot = random.below(slots - rows + 1);
  const auto any = [&](Matrix& x) {
    for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] = random.uniform(-1, 1);
  };
  Matrix half(rows, rows + 2), d(rows, 1);
  g.C.resize(6, rows);
  any(g.C), any(half), any(d);
  g.W = half * half.transpose() + 0.1 * Matrix::Identity(rows, rows);
  g.d = d;
  return g;
}

template <class S, int Rows>
Front<S, Rows, 6> front_of(const Given& g) {
  Front<S, Rows, 6> front{};
  for (int i = 0; i < g.rows(); ++i) {
    for (int j = 0; j < 6; ++j) front.C[j].add(g.slot + i, S(g.C(j, i)));
    front.d.add(g.slot + i, S(g.d[i]));
    front.scale.add(g.slot + i, S(g.W(i, i)));
    for (int j = Slots<S, Rows>::apart ? i : 0; j < g.rows(); ++j)
      front.W[g.slot + i].add(g.slot + j, S(g.W(i, j)));
  }
  return front;
}

struct Found {
  Matrix M = Matrix::Zero(6, 6);
  Eigen::VectorXd D = Eigen::VectorXd::Zero(6), sigma;
  std::vector<double> pivots;
};

/// Of a pack the first.
template <class S>
double number(const S& x) {
  return x.lane(0);
}

template <Beside beside, class S, int Rows>
Found closed(const Given& g, const Eigen::VectorXd& omega) {
  Front<S, Rows, 6> front = front_of<S, Rows>(g);
  std::vector<ClosedRow<S, Rows, 6>> records(static_cast<std::size_t>(g.rows()));
  Articulated<S> a{};
  close_loop<beside>(front, g.slot, g.points, g.others, S(0.0), 1e-8, records.data(),
                     SpatialWeight<S, Articulated<S>>{a});
  Found found;
  const Full<S>& m = a.M;
  const S upper[6][6] = {
      {m.Axx, m.Axy, m.Axz, m.Hxx, m.Hxy, m.Hxz}, {m.Axy, m.Ayy, m.Ayz, m.Hyx, m.Hyy, m.Hyz},
      {m.Axz, m.Ayz, m.Azz, m.Hzx, m.Hzy, m.Hzz}, {m.Hxx, m.Hyx, m.Hzx, m.Ixx, m.Ixy, m.Ixz},
      {m.Hxy, m.Hyy, m.Hzy, m.Ixy, m.Iyy, m.Iyz}, {m.Hxz, m.Hyz, m.Hzz, m.Ixz, m.Iyz, m.Izz}};
  const S D[6] = {a.Dfx, a.Dfy, a.Dfz, a.Dnx, a.Dny, a.Dnz};
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) found.M(i, j) = number(upper[i][j]);
    found.D[i] = number(D[i]);
  }
  S motion[6];
  for (int i = 0; i < 6; ++i) motion[i] = S(omega[i]);
  Slots<S, Rows> sigma{};
  for (int i = 0; i < Rows; ++i) sigma.set(i, S(7.0));  // of loops above that had these slots
  found.sigma.resize(g.rows());
  for (int k = g.rows(); k-- > 0;) {
    const auto& row = records[static_cast<std::size_t>(k)];
    const S s = beside == Beside::none_at_ground ? row.impulse_at_ground(sigma)
                                                 : row.impulse(motion, sigma);
    sigma.set(row.slot, s);
    found.sigma[row.slot - g.slot] = number(s);
  }
  for (const auto& row : records) found.pivots.push_back(number(row.w));
  if constexpr (!Slots<S, Rows>::apart)
    for (int i = 0; i < Rows; ++i) {  // as the body goes on with it
      double left = std::abs(number(front.d[i])) + std::abs(number(front.scale[i]));
      for (int j = 0; j < 6; ++j) left += std::abs(number(front.C[j][i]));
      for (int j = 0; j < Rows; ++j) left += std::abs(number(front.W[i][j]));
      EXPECT_EQ(left, 0) << "slot " << i;
    }
  return found;
}

template <class S, int Rows>
void closes_as_a_whole() {
  for (unsigned seed = 0; seed < 100; ++seed) {
    RandomTree random(seed);
    const Given g = random_loop(random, Rows);
    Eigen::VectorXd omega(6);
    for (Eigen::Index i = 0; i < 6; ++i) omega[i] = random.uniform(-1, 1);
    const Eigen::LDLT<Matrix> solve(g.W);
    const Matrix back = solve.solve(g.C.transpose());
    const Eigen::VectorXd at_ground = solve.solve(g.d);
    const double size = 1 + g.W.inverse().cwiseAbs().maxCoeff();
    const Found alone = closed<Beside::none, S, Rows>(g, omega),
                beside = closed<Beside::others, S, Rows>(g, omega),
                ground = closed<Beside::none_at_ground, S, Rows>(g, omega);
    const auto near = [&](const Matrix& x, const Matrix& y) {
      return (x - y).cwiseAbs().maxCoeff() < 1e-12 * size;
    };
    ASSERT_TRUE(near(alone.M, g.C * back)) << "seed " << seed;
    ASSERT_TRUE(near(alone.D, g.C * at_ground)) << "seed " << seed;
    ASSERT_TRUE(near(alone.sigma, back * omega + at_ground)) << "seed " << seed;
    ASSERT_TRUE(near(ground.sigma, at_ground)) << "seed " << seed;
    ASSERT_EQ(ground.M.cwiseAbs().maxCoeff(), 0) << "seed " << seed;
    for (std::size_t k = 0; k < alone.pivots.size(); ++k) {
      ASSERT_NEAR(alone.pivots[k], beside.pivots[k], 1e-13) << "seed " << seed << ", pivot " << k;
      ASSERT_NEAR(ground.pivots[k], beside.pivots[k], 1e-13) << "seed " << seed << ", pivot " << k;
    }
    ASSERT_TRUE(near(alone.sigma, beside.sigma)) << "seed " << seed;
  }
}

TEST(ClosingAlone, IsClosingAsAWhole) {
  closes_as_a_whole<Pack<1, 1>, 4>();
  closes_as_a_whole<Pack<1, 1>, 8>();
  closes_as_a_whole<Pack<1, 1>, 16>();
  closes_as_a_whole<Pack<2, 1>, 4>();
  closes_as_a_whole<Pack<2, 1>, 8>();
}

}  // namespace
}  // namespace momenta::dae_closing_alone
