// Bodies 10⁻¹² to 10¹² times as heavy as their neighbours, at every place of a loop: wherever the
// plan leaves a mechanism to the sweeps, they agree with themselves in quadruple precision.

#include "equations/linkages.h"
#include "equations/parts.h"
#include "equations/quad_loops.h"

#include <gtest/gtest.h>
#include <momenta/dae/kkt/factor/faded_pivot.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/kkt/saddle_point_factor.h>
#include <momenta/dae/kkt/solver_choice.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>

namespace momenta::dae_light_bodies {
namespace {

using Eigen::VectorXd;

/// How far u is off, and how far an ω of most_elimination_error lets it be, both relative to the
/// largest rate.
struct Off {
  double error = 0, allowed = 0;
};

/// ω is a backward error: of A x = b, A of (7), x = (u, σ), the residual is at most ω times the
/// terms of each row, and u off by ω |A⁺| terms at most, A⁺ of rank tol (rows may depend on
/// others). Source: Skeel, J. ACM 26 (1979) 494. In long doubles; rows and columns of unit
/// diagonal.
class Conditioned {
 public:
  Conditioned(const Mechanism& mechanism, Evaluation<double>& e)
      : nv_(mechanism.nv()), size_(nv_ + mechanism.m()), matrix_(Matrix::Zero(size_, size_)) {
    const KktPattern& pattern = mechanism.kkt_pattern();
    std::vector<double> mass(pattern.mass.size()), constraint(pattern.constraint.size());
    e.mass_entries(mass.data());
    e.constraint_entries(constraint.data());
    const auto put = [&](int i, int j, double value) {
      matrix_(i, j) = matrix_(j, i) = static_cast<long double>(value);
    };
    for (std::size_t k = 0; k < mass.size(); ++k)
      put(pattern.mass[k].row, pattern.mass[k].column, mass[k]);
    for (std::size_t k = 0; k < constraint.size(); ++k)
      put(nv_ + pattern.constraint[k].row, pattern.constraint[k].column, constraint[k]);
    Vector scale(size_);
    for (int i = 0; i < nv_; ++i) scale[i] = 1 / std::sqrt(matrix_(i, i));
    for (int k = nv_; k < size_; ++k)
      scale[k] = 1 / matrix_.row(k).head(nv_).cwiseProduct(scale.head(nv_).transpose()).norm();
    const Matrix scaled = scale.asDiagonal() * matrix_ * scale.asDiagonal();
    inverse_ = scale.asDiagonal() *
               Eigen::CompleteOrthogonalDecomposition<Matrix>(scaled).pseudoInverse() *
               scale.asDiagonal();
  }

  /// Of u for an ω of 1, relative to the largest of `u`; the right-hand side is M v.
  double condition(const VectorXd& u, const VectorXd& sigma, const VectorXd& v) const {
    Vector x(size_);
    x << (u.cwiseAbs() + v.cwiseAbs()).cast<long double>(), sigma.cwiseAbs().cast<long double>();
    Vector terms = matrix_.cwiseAbs() * x;
    for (int i = 0; i < nv_; ++i)  // of M the diagonal alone, as ω has it
      terms[i] =
          matrix_(i, i) * x[i] + matrix_.row(i).tail(size_ - nv_).cwiseAbs() * x.tail(size_ - nv_);
    const Vector off = (inverse_.cwiseAbs() * terms).head(nv_);
    return static_cast<double>(off.maxCoeff()) / u.cwiseAbs().maxCoeff();
  }

 private:
  using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
  int nv_, size_;
  Matrix matrix_, inverse_;
};

/// For three momenta of random motions, that which is nearest to what is allowed.
Off error_of(const Mechanism& mechanism) {
  const auto e = mechanism.evaluation<double>();
  const auto solver = make_loop_solver(mechanism, *e);
  const VectorXd& q = mechanism.tree().q0;
  e->place(0, q.data());
  const Conditioned conditioned(mechanism, *e);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  VectorXd v(mechanism.nv()), p(mechanism.nv()), u(mechanism.nv()), sigma(mechanism.m());
  Off worst;
  for (int motion = 0; motion < 3; ++motion) {
    for (double& x : v) x = any(random);
    e->place(0, q.data());
    e->move(v.data());
    e->momenta(nullptr, p.data());
    EXPECT_TRUE(solver->momentum(0, q.data(), p.data(), nullptr, fade_evaluation, 0, u.data(),
                                 sigma.data(), nullptr));
    const VectorXd exact = quad_rates(mechanism, q, p, v, 0, 1e-22).u;
    const Off here{(u - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff(),
                   most_elimination_error * conditioned.condition(u, sigma, v)};
    if (motion == 0 || here.error * worst.allowed > worst.error * here.allowed) worst = here;
  }
  return worst;
}

/// Each body in turn, by each power of ten. Returns how many of these the sweeps carry.
int swept_of(const Scene& scene) {
  int swept = 0;
  for (std::size_t body = 0; body < scene.bodies.size(); ++body)
    for (int power = -12; power <= 12; power += 3) {
      Scene other = scene;
      other.bodies[body].mass *= std::pow(10, power);
      other.bodies[body].inertia *= std::pow(10, power);
      const Mechanism mechanism(other);
      if (mechanism.solver().kkt() != KktChoice::sweeps) {
        EXPECT_NE(power, 0);
        continue;
      }
      ++swept;
      const Off off = error_of(mechanism);
      EXPECT_LT(off.error, off.allowed)
          << scene.name << ", " << scene.bodies[body].name << " 10^" << power;
    }
  return swept;
}

TEST(LightBodies, SweepsAgreeWithQuadruplePrecision) {
  EXPECT_GT(swept_of(equations::row_of_four_bars(2, 1.2)), 30);
  EXPECT_GT(swept_of(equations::bricard()), 30);
  EXPECT_GT(swept_of(equations::platform(5)), 50);  // six legs are folded, which have no quad
}

/// Pairs of crossed bars, one on another, held at one end of the first; the other end on a slide.
Scene ladder_on_a_slide(int pairs, double foot) {
  using std::numbers::pi;
  Scene s;
  s.gravity = {0, -9.81, 0};
  const double tilt = 0.6, cross = pi - 2 * tilt;
  const auto bar = [&](const std::string& name, double centre) {
    BodySpec b = equations::rod(name);
    b.com = {centre, 0, 0};
    b.inertia = Eigen::Vector3d(0, 4.0 / 12, 4.0 / 12).asDiagonal();
    s.bodies.push_back(b);
  };
  for (int i = 0; i < pairs; ++i) {
    const std::string n = std::to_string(i), below = std::to_string(i - 1);
    bar("a" + n, 1);
    bar("b" + n, 0);
    s.joints.push_back(i == 0 ? equations::hinge("A0", "ground", "a0", {0, 0, 0}, tilt)
                              : equations::hinge("A" + n, "b" + below, "a" + n, {1, 0, 0}, -cross));
    s.joints.push_back(equations::hinge("B" + n, "a" + n, "b" + n, {1, 0, 0}, cross));
    if (i == 0) continue;
    s.loops.push_back(equations::make_loop(LoopKind::revolute, "C" + n, "a" + below, "b" + n,
                                           {2, 0, 0}, {-1, 0, 0}));
  }
  BodySpec slide;
  slide.name = "foot";
  slide.mass = foot;
  s.bodies.push_back(slide);
  s.joints.push_back(equations::make_joint(JointKind::prismatic, "S", "ground", "foot", {0, 0, 0},
                                           {1, 0, 0}, {2 * std::cos(tilt)}));
  s.loops.push_back(
      equations::make_loop(LoopKind::revolute, "F", "foot", "b0", {0, 0, 0}, {-1, 0, 0}));
  return s;
}

TEST(LightBodies, ALightSlideUnderALadderIsSwept) {
  for (const double foot : {0.2, 2e5}) {
    const Mechanism mechanism(ladder_on_a_slide(200, foot));
    ASSERT_EQ(mechanism.solver().kkt(), KktChoice::sweeps) << foot;
    const Off off = error_of(mechanism);
    EXPECT_LT(off.error, off.allowed) << foot;
  }
}

}  // namespace
}  // namespace momenta::dae_light_bodies
