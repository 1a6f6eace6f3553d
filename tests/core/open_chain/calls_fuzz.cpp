// Any sequence of public calls with any arguments: finite results, false and one sentence, or
// std::invalid_argument with one; never another outcome. MOMENTA_CALLS=n makes n thousand of them.

#include "equations/random_tree.h"
#include "equations/wild.h"

#include <gtest/gtest.h>
#include <momenta/core/open_chain/open_chain.h>

#include <cstdlib>
#include <functional>

namespace momenta::core_calls_fuzz {
namespace {

using namespace equations;
using Eigen::MatrixXd;
using Eigen::VectorXd;

class Caller {
 public:
  Caller(unsigned seed, Scene scene)
      : wild_(seed),
        chain_(scene, Algebra::automatic, 0, seed % 2 == 0),
        nq_(chain_.nq()),
        nv_(chain_.nv()) {}

  /// One call, and whether it gave a result.
  bool call() {
    const double t = wild_.chance(0.9) ? wild_.sound() : wild_.wild();
    const VectorXd q = coordinates(), x = wild_.vector(nv_);
    VectorXd of_q(wild_.size(nq_)), of_v(wild_.size(nv_));
    switch (wild_.below(14)) {
      case 0:
        return told(
            "rates", [&] { return chain_.rates(t, q, x, of_q, of_v); }, of_q, of_v);
      case 1:
        return told(
            "velocities", [&] { return chain_.velocities(t, q, x, of_v); }, of_v);
      case 2:
        return told(
            "accelerations", [&] { return chain_.accelerations(t, q, x, of_v); }, of_v);
      case 3:
        return told(
            "inverse_mass_times",
            [&] {
              return wild_.chance(0.5) ? chain_.inverse_mass_times(t, q, x, of_v)
                                       : chain_.inverse_mass_times(x, of_v);
            },
            of_v);
      case 4: {
        const VectorXd dq = wild_.vector(nq_), dp = wild_.vector(nv_);
        return told(
            "jacobian_times", [&] { return chain_.jacobian_times(t, q, x, dq, dp, of_q, of_v); },
            of_q, of_v);
      }
      case 5: {
        MatrixXd J(wild_.size(nq_ + nv_), wild_.size(nq_ + nv_));
        return told(
            "jacobian", [&] { return chain_.jacobian(t, q, x, MatrixRef(J)); }, J);
      }
      case 6: {
        MatrixXd J;
        return told(
            "jacobian, new",
            [&] {
              J = chain_.jacobian(t, q, x);
              return J.size() > 0 || nq_ + nv_ == 0;
            },
            J);
      }
      case 7:
        return told(
            "momenta", [&] { return chain_.momenta(t, q, x, of_v), true; }, of_v);
      case 8:
        return told(
            "coordinate_rates", [&] { return chain_.coordinate_rates(q, x, of_q), true; }, of_q);
      case 9: {
        VectorXd e(3);
        return told(
            "energies",
            [&] {
              const Energies all = chain_.energies(t, q, x);
              e << all.kinetic, all.potential, all.hamiltonian;
              return true;
            },
            e);
      }
      case 10: {
        VectorXd all(10);
        return told(
            "centroidal",
            [&] {
              Centroidal c;
              if (!chain_.centroidal(t, q, x, c)) return false;
              all << c.mass, c.centre, c.linear_momentum, c.angular_momentum;
              return true;
            },
            all);
      }
      case 11: {
        MatrixXd all(6, nv_ + nq_ + 20);
        all.setZero();
        return told(
            "reactions",
            [&] {
              Eigen::Index i = 0;
              for (const Reaction& r : chain_.reactions(t, q, x)) all.col(i++) << r.force, r.torque;
              return true;
            },
            all);
      }
      case 12: {
        MatrixXd M;
        return told(
            "mass_matrix", [&] { return M = chain_.mass_matrix(t, q), true; }, M);
      }
      default: {
        MatrixXd all = MatrixXd::Zero(12, 100);
        return told(
            "poses",
            [&] {
              Eigen::Index i = 0;
              for (const auto& pose : chain_.poses(t, q))
                all.col(i++) =
                    Eigen::Map<const VectorXd>(pose.matrix().topRows(3).eval().data(), 12);
              return true;
            },
            all);
      }
    }
  }

  /// Many states: those without a result are NaN, all others as by themselves.
  void call_many() {
    const double t = wild_.chance(0.9) ? wild_.sound() : wild_.wild();
    const int count = wild_.below(30);
    StateMatrix q(wild_.size(nq_), count), x(wild_.size(nv_), wild_.size(count)),
        of_q(wild_.size(nq_), count), of_v(wild_.size(nv_), count);
    for (Eigen::Index i = 0; i < q.cols(); ++i)
      q.col(i) = q.rows() == nq_ ? coordinates_of(nq_) : wild_.numbers(static_cast<int>(q.rows()));
    for (Eigen::Index i = 0; i < x.cols(); ++i)
      x.col(i) = wild_.numbers(static_cast<int>(x.rows()));
    const int threads = wild_.chance(0.9) ? 1 + wild_.below(3) : wild_.below(5) - 3;
    const bool by_momenta = wild_.chance(0.5);
    bool ok = false;
    try {
      ok = by_momenta ? chain_.rates_of_states(t, q, x, of_q, of_v, threads)
                      : chain_.accelerations_of_states(t, q, x, of_v, threads);
    } catch (const std::invalid_argument& e) {
      EXPECT_TRUE(is_sentence(e.what())) << e.what();
      return;
    }
    EXPECT_EQ(chain_.failure().empty(), ok) << chain_.failure();
    if (!ok) {
      EXPECT_TRUE(is_sentence(chain_.failure())) << chain_.failure();
    }
    Eigen::Index first = -1;
    for (Eigen::Index i = 0; i < count; ++i) {
      const bool none =
          of_v.col(i).array().isNaN().all() && (!by_momenta || of_q.col(i).array().isNaN().all());
      const bool all = of_v.col(i).allFinite() && (!by_momenta || of_q.col(i).allFinite());
      EXPECT_TRUE(none || all) << "state " << i << ": " << of_v.col(i).transpose();
      EXPECT_TRUE(all || !ok) << "state " << i;
      if (!all && first < 0) first = i;
    }
    if (!ok && nv_ > 0) {
      EXPECT_NE(chain_.failure().find("state " + std::to_string(first) + ": "), std::string::npos)
          << chain_.failure() << ", expected state " << first;
    }
  }

 private:
  VectorXd coordinates_of(int n) {
    VectorXd q = wild_.numbers(n);
    if (wild_.chance(0.7)) chain_.tree().normalise(q);
    return q;
  }
  VectorXd coordinates() {
    const int n = wild_.size(nq_);
    return n == nq_ ? coordinates_of(n) : wild_.numbers(n);
  }

  template <class... Result>
  bool told(const char* name, const std::function<bool()>& call, const Result&... results) {
    SCOPED_TRACE(name);
    try {
      if (call()) {
        EXPECT_TRUE((results.allFinite() && ...));
        return true;
      }
      EXPECT_TRUE(is_sentence(chain_.failure())) << "'" << chain_.failure() << "'";
      EXPECT_EQ(chain_.failure().find("state "), std::string::npos) << chain_.failure();
    } catch (const std::invalid_argument& e) {
      EXPECT_TRUE(is_sentence(e.what())) << e.what();
    }
    return false;
  }

  Wild wild_;
  OpenChain chain_;
  int nq_, nv_;
};

TEST(CallsFuzz, OfOpenChains) {
  const char* thousands = std::getenv("MOMENTA_CALLS");  // NOLINT: tests have one thread
  const int chains = 40 * (thousands ? std::atoi(thousands) : 8);
  int results = 0;
  for (int i = 0; i < chains; ++i) {
    SCOPED_TRACE("seed " + std::to_string(i));
    RandomTree random(static_cast<unsigned>(i));
    TreeRecipe recipe{.bodies = 1 + i % 9};
    recipe.body_forces = i % 3 == 0;
    recipe.joint_forces = i % 2 == 0;
    if (i % 5 == 0) recipe.kinds = {JointKind::revolute};
    Caller caller(static_cast<unsigned>(i), random.scene(recipe));
    for (int k = 0; k < 20; ++k) results += caller.call();
    for (int k = 0; k < 5; ++k) {
      caller.call_many();
      results += caller.call();
    }
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(results, chains * 5);
}

}  // namespace
}  // namespace momenta::core_calls_fuzz
