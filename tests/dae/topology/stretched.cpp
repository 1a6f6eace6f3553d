// Chains stretched between two points of the ground, longer or shorter than the way between them by
// any part of it: the loop closes, by bending where it is longer, or it is refused as too short.
// Never is it called redundant: its equations contradict nothing.

#include "equations/large_scenes.h"
#include "equations/linkages.h"

#include <gtest/gtest.h>
#include <momenta/core/scene/scene.h>
#include <momenta/dae/kkt/loop_units.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <cmath>

namespace momenta::dae_stretched {
namespace {

using namespace equations;

enum class Guess { straight, bent };

class Stretched : public testing::TestWithParam<std::tuple<int, bool, Guess>> {
 protected:
  Scene scene(double reach) const {
    const auto [n, spherical, guess] = GetParam();
    Scene s = stretched_chain(n, reach, spherical);
    if (guess == Guess::bent)
      for (int i = 0; i < n; ++i)
        s.joints[static_cast<std::size_t>(i)].position = {i % 2 == 0 ? 0.3 : -0.6};
    return s;
  }
};

TEST_P(Stretched, ClosesOrIsTooShort) {
  const int n = std::get<0>(GetParam());
  int closed = 0, refused = 0;
  for (int digits = 6; digits <= 14; ++digits)
    for (const double part : {1.0, 3.0})
      for (const int sign : {-1, 1}) {
        const double short_by = sign * part * std::pow(10.0, -digits) * n;
        SCOPED_TRACE(testing::Message() << n << " rods, too short by " << short_by << " m");
        const Mechanism mechanism(scene(n + short_by));
        const double least = std::max(1e-12, LoopUnits(mechanism).rounding) *
                             length_of(mechanism.scene());  // [m] that count as closed
        // At that border either is right.
        if (short_by > 0.3 * least && short_by < 3 * least) continue;
        try {
          const Assembly a = assemble(mechanism, Assembled::rates);
          EXPECT_LT(short_by, least) << "closed";
          EXPECT_EQ(a.residue, "");
          EXPECT_LT(a.position_residual, 1.01 * least);
          ++closed;
        } catch (const SceneError& error) {
          const std::string what = error.what();
          if (what.find("cannot move at its start: ") != std::string::npos) {
            EXPECT_LT(std::abs(short_by), 3 * least) << what;  // closed, and straight
            ++closed;
            continue;
          }
          EXPECT_GT(short_by, least) << what;
          EXPECT_NE(what.find("loop 'tip' stays open by "), std::string::npos) << what;
          EXPECT_NE(what.find(", stretched: no motion closes it further"), std::string::npos)
              << what;
          ++refused;
        }
      }
  EXPECT_GT(closed, 18);
  EXPECT_GT(refused, 6);
}
INSTANTIATE_TEST_SUITE_P(Chains, Stretched,
                         testing::Combine(testing::Values(2, 3, 5, 10), testing::Values(false),
                                          testing::Values(Guess::straight, Guess::bent)));
INSTANTIATE_TEST_SUITE_P(ChainsInSpace, Stretched,
                         testing::Combine(testing::Values(2, 3, 5, 10), testing::Values(true),
                                          testing::Values(Guess::straight)));

}  // namespace
}  // namespace momenta::dae_stretched
