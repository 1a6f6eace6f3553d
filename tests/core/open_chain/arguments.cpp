// What public calls are given: wrong sizes are thrown and numbers that are none told, by call and
// name, before anything is read or written.
#include <gtest/gtest.h>
#include <momenta/core/open_chain/open_chain.h>
#include <momenta/core/scalar/all_finite.h>

#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "equations/random_tree.h"
#include "equations/refusal.h"

namespace momenta::core_arguments {
namespace {

using Eigen::VectorXd;

class Arguments : public testing::Test {
 protected:
  equations::RandomTree random_{7};
  OpenChain chain_{random_.scene({.bodies = 6})};
  Eigen::Index nq_ = chain_.nq(), nv_ = chain_.nv();
  VectorXd q_ = chain_.tree().q0, u_ = VectorXd::Zero(nv_), p_ = u_, qdot_ = q_, pdot_ = u_;
};

TEST_F(Arguments, OfWrongSizeAreThrown) {
  const VectorXd few(2);
  VectorXd out(3);
  const std::string nq = std::to_string(nq_), nv = std::to_string(nv_);
  const auto expect = [](const std::function<void()>& call, const std::string& sentence) {
    EXPECT_EQ(equations::thrown<std::invalid_argument>(call), sentence);
  };
  expect([&] { chain_.rates(0, few, p_, qdot_, pdot_); }, "rates: q has 2 numbers, expected " + nq);
  expect([&] { chain_.rates(0, q_, p_, out, pdot_); }, "rates: qdot has 3 numbers, expected " + nq);
  expect([&] { chain_.velocities(0, q_, few, out); },
         "velocities: p has 2 numbers, expected " + nv);
  expect([&] { chain_.accelerations(0, q_, u_, out); },
         "accelerations: udot has 3 numbers, expected " + nv);
  expect([&] { chain_.inverse_mass_times(0, q_, few, pdot_); },
         "inverse_mass_times: x has 2 numbers, expected " + nv);
  expect([&] { chain_.momenta(0, q_, u_, out); }, "momenta: p has 3 numbers, expected " + nv);
  expect([&] { chain_.coordinate_rates(q_, u_, out); },
         "coordinate_rates: qdot has 3 numbers, expected " + nq);
  expect([&] { chain_.jacobian_times(0, q_, p_, few, p_, qdot_, pdot_); },
         "jacobian_times: dq has 2 numbers, expected " + nq);
  Eigen::MatrixXd J(nq_, nq_);
  expect([&] { chain_.jacobian(0, q_, p_, MatrixRef(J)); },
         "jacobian: a row of J has " + nq + " numbers, expected " + std::to_string(nq_ + nv_));
  expect([&] { chain_.energies(0, few, u_); }, "energies: q has 2 numbers, expected " + nq);
  expect([&] { chain_.reactions(0, q_, few); }, "reactions: u has 2 numbers, expected " + nv);
  expect([&] { chain_.mass_matrix(0, few); }, "mass_matrix: q has 2 numbers, expected " + nq);
  expect([&] { chain_.poses(0, few); }, "poses: q has 2 numbers, expected " + nq);
  Centroidal all;
  expect([&] { chain_.centroidal(0, few, p_, all); },
         "velocities: q has 2 numbers, expected " + nq);
  StateMatrix q(nq_, 4), p(nv_, 4), qdot(nq_, 3), pdot(nv_, 4);
  expect([&] { chain_.rates_of_states(0, q, p, qdot, pdot); },
         "rates_of_states: a row of qdot has 3 numbers, expected 4");
  expect([&] { chain_.accelerations_of_states(0, q, qdot, pdot); },
         "accelerations_of_states: a column of u has " + nq + " numbers, expected " + nv);
}

TEST_F(Arguments, ThatAreNoNumbersAreTold) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = HUGE_VAL;
  VectorXd bad_q = q_, bad = p_;
  bad_q[1] = nan;
  bad[2] = -infinite;
  const std::string of_q = "q[1] is not a number, expected a finite number",
                    of_p = "p[2] is minus infinite, expected a finite number";
  EXPECT_FALSE(chain_.rates(0, bad_q, p_, qdot_, pdot_));
  EXPECT_EQ(chain_.failure(), of_q);
  EXPECT_FALSE(chain_.rates(0, q_, bad, qdot_, pdot_));
  EXPECT_EQ(chain_.failure(), of_p);
  EXPECT_FALSE(chain_.rates(nan, q_, p_, qdot_, pdot_));
  EXPECT_EQ(chain_.failure(), "t is not finite, expected a time in seconds");
  EXPECT_FALSE(chain_.velocities(0, q_, bad, pdot_));
  EXPECT_EQ(chain_.failure(), of_p);
  EXPECT_FALSE(chain_.accelerations(0, q_, bad, pdot_));
  EXPECT_EQ(chain_.failure(), "u[2] is minus infinite, expected a finite number");
  EXPECT_FALSE(chain_.jacobian_times(0, q_, p_, qdot_, bad, qdot_, pdot_));
  EXPECT_EQ(chain_.failure(), "dp[2] is minus infinite, expected a finite number");
  EXPECT_FALSE(chain_.jacobian_times(0, q_, p_, bad_q, p_, qdot_, pdot_));
  EXPECT_EQ(chain_.failure(), "dq[1] is not a number, expected a finite number");
  EXPECT_FALSE(chain_.rates(0, q_, p_, bad, qdot_, pdot_));
  EXPECT_EQ(chain_.failure(), "tau[2] is minus infinite, expected a finite number");
  EXPECT_FALSE(chain_.accelerations(0, q_, u_, bad, pdot_));
  EXPECT_EQ(chain_.failure(), "tau[2] is minus infinite, expected a finite number");
  EXPECT_EQ(chain_.jacobian(0, bad_q, p_).size(), 0);
  EXPECT_EQ(chain_.failure(), of_q);
  EXPECT_EQ(equations::thrown<std::invalid_argument>([&] { chain_.momenta(0, bad_q, u_, p_); }),
            "momenta: " + of_q);
  EXPECT_EQ(equations::thrown<std::invalid_argument>([&] { chain_.energies(0, bad_q, u_); }),
            "energies: " + of_q);
  EXPECT_EQ(equations::thrown<std::invalid_argument>([&] { chain_.mass_matrix(0, bad_q); }),
            "mass_matrix: " + of_q);
  EXPECT_EQ(equations::thrown<std::invalid_argument>([&] { chain_.poses(0, bad_q); }),
            "poses: " + of_q);
  // The next good call is good again.
  EXPECT_TRUE(chain_.rates(0, q_, p_, qdot_, pdot_)) << chain_.failure();
  EXPECT_EQ(chain_.failure(), "");
}

TEST(AllFinite, IsTheQuestionAskedOfEachNumber) {
  const double limits[] = {
      0.0, -0.0, 5e-324, -1.0, 1.7976931348623157e308, -1.7976931348623157e308};
  for (const double none : {std::numeric_limits<double>::quiet_NaN(),
                            -std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, -HUGE_VAL})
    for (std::size_t n = 0; n < 9; ++n) {
      std::vector<double> x(n);
      for (std::size_t i = 0; i < n; ++i) x[i] = limits[i % 6];
      EXPECT_TRUE(all_finite(x.data(), n));
      for (std::size_t i = 0; i < n; ++i) {
        const double was = std::exchange(x[i], none);
        EXPECT_FALSE(all_finite(x.data(), n)) << i << " of " << n << ", " << none;
        x[i] = was;
      }
    }
}

}  // namespace
}  // namespace momenta::core_arguments
