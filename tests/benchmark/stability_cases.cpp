#include "stability_cases.h"

#include <cmath>
#include <random>

#include "models.h"

namespace momenta::stability {
namespace {

constexpr double any_angle = 3.14, nearly_straight = 0.02;

/// Mass and inertia of body i times factor(i), density and shape of no concern.
template <class Factor>
Scene weighed(Scene scene, Factor&& factor) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const double f = factor(static_cast<double>(i) / static_cast<double>(scene.bodies.size() - 1));
    scene.bodies[i].mass *= f;
    scene.bodies[i].inertia *= f;
  }
  return scene;
}

Scene heavy_to_light(unsigned) {
  return weighed(benchmark_models::random_chain(12),
                 [](double at) { return std::pow(10, 9 - 18 * at); });
}
Scene light_to_heavy(unsigned) {
  return weighed(benchmark_models::random_chain(12),
                 [](double at) { return std::pow(10, 18 * at - 9); });
}
Scene heavy_tip(unsigned) {
  return weighed(benchmark_models::random_chain(12), [](double at) { return at == 1 ? 1e9 : 1; });
}
Scene random_masses(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> exponent(-9, 9);
  return weighed(benchmark_models::random_chain(12),
                 [&](double) { return std::pow(10, exponent(random)); });
}
/// The last body: a rod along its own revolute joint, of no thickness but for 1e-14 kg m².
Scene thin_tip(unsigned) {
  Scene scene = benchmark_models::random_chain(12);
  BodySpec& tip = scene.bodies.back();
  JointSpec& revolute = scene.joints.back();
  revolute.axis = Eigen::Vector3d::UnitZ();
  tip.com = {0, 0, 0.2};
  tip.inertia = Eigen::Vector3d(0.02, 0.02, 1e-14).asDiagonal();
  return scene;
}
Scene at_1_km(Scene scene) {
  scene.joints.front().origin_parent = {600, -800, 0};
  return scene;
}

}  // namespace

std::vector<Case> cases() {
  using namespace benchmark_models;
  std::vector<Case> all;
  for (const int n : {7, 100, 1000, 10000})
    all.push_back(
        {"coil", n, n <= 100 ? 1024 : 0, any_angle, [n](unsigned) { return random_chain(n); }});
  for (const int n : {30, 100, 1000, 10000})
    all.push_back(
        {"rope", n, n <= 100 ? 2048 : 0, nearly_straight, [n](unsigned) { return rope(n); }});
  using Named = std::pair<const char*, Scene (*)(unsigned)>;
  for (const auto& [name, scene] :
       {Named{"masses 1e9 ... 1e-9, base to tip", heavy_to_light},
        Named{"masses 1e-9 ... 1e9, base to tip", light_to_heavy},
        Named{"tip 1e9, rest 1", heavy_tip}, Named{"masses 1e-9 to 1e9 at random", random_masses},
        Named{"inertia 1e-14 about the last revolute joint", thin_tip}})
    all.push_back({name, 12, 1024, any_angle, scene});
  all.push_back({"coil, base at 1 km", 7, 1024, any_angle,
                 [](unsigned) { return at_1_km(random_chain(7)); }});
  all.push_back({"rope, base at 1 km", 30, 2048, nearly_straight,
                 [](unsigned) { return at_1_km(rope(30)); }});
  return all;
}

}  // namespace momenta::stability
