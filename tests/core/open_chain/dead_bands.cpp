// Springs with a dead band: the force is minus the slope of the energy, none within the band, that
// of a spring at either end outside, with rounded corners between; along a coordinate, between
// points, in the plane and in space.

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/open_chain/open_chain.h>

#include <cmath>

namespace momenta::core_dead_bands {
namespace {

constexpr double k = 30, rest = 0.5, band = 0.4, corner = band / 20;

/// A slide whose q is the length of its spring; `tilted` leaves every plane of two axes.
Scene sprung(const std::string& kind, bool tilted, double dead = band, double from = rest) {
  const std::string axis = tilted ? "[0.48, 0.6, 0.64]" : "[1, 0, 0]";
  const std::string ends = kind == "spring-damper" ? "child = 'a'" : "joints = ['A']\nratios = [1]";
  return parse_scene(
      "[[body]]\nname = 'a'\nmass = 2\nshape = { kind = 'sphere', radius = 0.1 }\n"
      "[[joint]]\nname = 'A'\nkind = 'prismatic'\nchild = 'a'\naxis = " +
          axis + "\n[[force]]\nkind = '" + kind + "'\n" + ends +
          "\nstiffness = " + std::to_string(k) + "\nrest = " + std::to_string(from) +
          "\ndead_band = " + std::to_string(dead) + "\n",
      "band.toml");
}

struct Spring {
  explicit Spring(const Scene& scene)
      : chain(scene, scene.joints[0].axis.z() == 0 ? Algebra::planar : Algebra::spatial) {}
  double force(double q) {
    Eigen::VectorXd at(1), p(1), qdot(1), pdot(1);
    at << q;
    p << 0;
    EXPECT_TRUE(chain.rates(0, at, p, qdot, pdot));
    return pdot[0];
  }
  double energy(double q) {
    Eigen::VectorXd at(1), u(1);
    at << q;
    u << 0;
    return chain.energies(0, at, u).potential;
  }
  OpenChain chain;
};

class DeadBands : public testing::TestWithParam<std::tuple<const char*, bool>> {
 protected:
  Scene scene(double dead = band, double from = rest) const {
    return sprung(std::get<0>(GetParam()), std::get<1>(GetParam()), dead, from);
  }
};

TEST_P(DeadBands, AreTwoSpringsWithNothingBetween) {
  Spring spring(scene()), low(scene(0)), high(scene(0, rest + band));
  for (const double q : {rest + corner, rest + 0.5 * band, rest + band - corner})
    EXPECT_NEAR(spring.force(q), 0, 1e-14) << q;
  for (const double q : {0.1, 0.3, rest - corner})
    EXPECT_NEAR(spring.force(q), low.force(q), 1e-13);
  for (const double q : {rest + band + corner, 1.4, 3.0})
    EXPECT_NEAR(spring.force(q), high.force(q), 1e-12);
  // at the corners k w/4, the farthest from either
  EXPECT_NEAR(spring.force(rest), k * corner / 4, 1e-13);
  EXPECT_NEAR(spring.force(rest + band), -k * corner / 4, 1e-13);
}

TEST_P(DeadBands, ForceIsTheSlopeOfTheEnergyAndHasASlopeItself) {
  Spring spring(scene());
  constexpr double h = 1e-5;
  for (double q = 0.303; q < 1.2; q += 0.0037) {
    const double slope = (spring.energy(q + h) - spring.energy(q - h)) / (2 * h);
    EXPECT_NEAR(spring.force(q), -slope, 1e-6 * k) << q;
    const double bend = (spring.force(q + h) - spring.force(q)) / h,
                 before = (spring.force(q) - spring.force(q - h)) / h;
    EXPECT_NEAR(bend, before, k * h / corner) << q;  // f'' is k/2w at most
  }
  EXPECT_EQ(spring.energy(rest + 0.5 * band), 0);
  for (const double x : {corner, 0.1, 0.3}) {  // where the corner is passed, w²/3 more than x²
    const double energy = 0.5 * k * (x * x + corner * corner / 3);
    EXPECT_NEAR(spring.energy(rest - x), energy, 1e-13);
    EXPECT_NEAR(spring.energy(rest + band + x), energy, 1e-13);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, DeadBands,
                         testing::Combine(testing::Values("spring-damper", "coordinate-spring"),
                                          testing::Bool()));

}  // namespace
}  // namespace momenta::core_dead_bands
