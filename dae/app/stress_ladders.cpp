#include "stress_ladders.h"

#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/core/text/number_text.h>
#include <momenta/dae/form/form.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "built_in_scenes.h"

namespace momenta::program {
namespace {

using Factors = std::vector<double>;
const Factors upwards{1e3, 1e6, 1e9, 1e12}, downwards{1e-3, 1e-6, 1e-9, 1e-12};

std::string power(double x) {
  return x >= 1e-3 && x < 1e5 ? compact(x, 5) : scientific(x, 1);
}

/// A built-in scene, with an end that leaves time for all forms.
Scene built_in(std::string_view text, double end) {
  Scene scene = parse_scene(text, "built-in scene");
  scene.run.end_time = end;
  scene.run.samples = 200;
  return scene;
}
Scene four_bar() {
  return built_in(embedded::four_bar(), 10);
}

JointSpec& joint(Scene& scene, const std::string& name) {
  return *std::find_if(scene.joints.begin(), scene.joints.end(),
                       [&](const JointSpec& j) { return j.name == name; });
}
void weigh(Scene& scene, const std::string& body, double factor) {
  for (BodySpec& b : scene.bodies)
    if (b.name == body) {
      b.mass *= factor;
      b.inertia *= factor;
    }
}

/// A ladder of scenes: `set` makes that of a value.
template <class Set>
Ladder along(const std::string& name, const Factors& values, const std::string& unit, Set&& set) {
  Ladder ladder{name, {}, true};
  for (const double value : values) ladder.rungs.push_back({power(value) + unit, set(value), {}});
  return ladder;
}

Ladder stiff_pendulum() {
  return along("spring of a pendulum", {1e2, 1e4, 1e6, 1e8, 1e10}, " N/m", [](double k) {
    Scene s = built_in(embedded::spring_pendulum(), 10);
    joint(s, "spring").stiffness = k;
    return s;
  });
}
Ladder stiff_loop() {
  return along("spring in a loop", {1e2, 1e4, 1e6, 1e8, 1e10}, " N m/rad", [](double k) {
    Scene s = four_bar();
    JointSpec& rocker = joint(s, "C");
    rocker.stiffness = k;
    rocker.rest = rocker.position[0];
    return s;
  });
}
Ladder damped_loop() {
  return along("damper in a loop", {1, 1e2, 1e4, 1e6, 1e8}, " N m s/rad", [](double c) {
    Scene s = four_bar();
    joint(s, "C").damping = c;
    return s;
  });
}
Ladder weighed(const std::string& name, std::string_view text, double end, const std::string& body,
               const Factors& factors) {
  return along(name, factors, "", [&](double f) {
    Scene s = built_in(text, end);
    weigh(s, body, f);
    return s;
  });
}
Ladder light_cart() {
  return along("cart under a pole of 1 kg", {1e-3, 1e-6, 1e-9, 1e-12}, " kg", [](double m) {
    Scene s = built_in(embedded::light_cart(), 10);
    s.bodies.front().mass = m;
    return s;
  });
}
Ladder sized(const std::string& name, const Factors& factors) {
  Ladder ladder = ladder_of(four_bar(), Extreme::size, factors);
  ladder.name = name;
  return ladder;
}
Ladder spun_loop() {
  return along("speed of a crank", {10, 1e2, 1e3, 1e4, 1e5}, " rad/s", [](double rate) {
    Scene s = four_bar();
    joint(s, "O").velocity = {rate};
    s.run.end_time = 100 / rate;
    if (s.run.step) *s.run.step = s.run.end_time / 2000;
    return s;
  });
}
Ladder spun_top() {
  return along("spin of a top", {150, 1e3, 1e4, 1e5}, " rad/s", [](double rate) {
    Scene s = built_in(embedded::heavy_top(), 2);
    joint(s, "O").velocity[1] = rate;
    return s;
  });
}
Ladder lasting() {
  return along("duration", {10, 100, 1000, 1e4, 86400}, " s", [](double end) {
    Scene s = four_bar();
    s.run.end_time = end;
    return s;
  });
}
Ladder long_chains() {
  return along("rods in a chain", {10, 100, 1000}, "", [](double n) {
    Scene s;
    s.name = "Chain";
    s.gravity = {0, -9.81, 0};
    for (int i = 0; i < static_cast<int>(n); ++i) {
      BodySpec rod;
      rod.name = "rod" + std::to_string(i);
      rod.mass = 1;
      rod.com = {0.5, 0, 0};
      rod.inertia = Eigen::Vector3d(0, 1. / 12, 1. / 12).asDiagonal();
      JointSpec revolute;
      revolute.name = "J" + std::to_string(i);
      revolute.child = rod.name;
      if (i > 0) {
        revolute.parent = s.bodies.back().name;
        revolute.origin_parent = {1, 0, 0};
      }
      s.bodies.push_back(std::move(rod));
      s.joints.push_back(std::move(revolute));
    }
    s.run.end_time = 0.5;
    s.run.samples = 50;
    return s;
  });
}

/// The first cells of the row of four-bars, whose bodies and joints are numbered.
Scene row_of_four_bars(int cells) {
  Scene s = built_in(embedded::n_four_bar(), 10);
  const auto beyond = [&](const std::string& body) {
    return body != "ground" && std::stoi(body.substr(body.find_first_of("0123456789"))) > cells;
  };
  std::erase_if(s.bodies, [&](const BodySpec& b) { return beyond(b.name); });
  std::erase_if(s.joints, [&](const JointSpec& j) { return beyond(j.child); });
  std::erase_if(s.loops, [&](const LoopSpec& l) { return beyond(l.child) || beyond(l.parent); });
  return s;
}
const Eigen::Quaterniond tilt(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));

Ladder redundant() {
  const MechanismOptions in_space{Algebra::spatial, KktChoice::automatic};
  Scene twice = four_bar();
  twice.loops.push_back(twice.loops.front());
  twice.loops.back().name = "B again";
  return {"redundant loops",
          {{"three cranks", built_in(embedded::three_cranks(), 10), {}},
           {"four-bar on hinges in space", four_bar(), in_space},
           {"the same, tilted", turned(four_bar(), tilt), in_space},
           {"one loop twice", std::move(twice), {}},
           {"Bricard", built_in(embedded::bricard(), 10), {}},
           {"Bricard, tilted", turned(built_in(embedded::bricard(), 10), tilt), {}}},
          false};
}
Ladder singular() {
  Scene flat = row_of_four_bars(1);
  for (JointSpec& j : flat.joints) j.position = {0};
  return {"singular poses",
          {{"1 four-bar", row_of_four_bars(1), {}},
           {"2 four-bars, tilted", turned(row_of_four_bars(2), tilt), {}},
           {"40 four-bars", row_of_four_bars(40), {}},
           {"slider-crank, equal links", built_in(embedded::slider_crank(), 10), {}},
           {"the same, tilted", turned(built_in(embedded::slider_crank(), 10), tilt), {}},
           {"start at one", std::move(flat), {}}},
          false};
}
Ladder trivial() {
  Scene weightless = four_bar(), still = four_bar(), massless = four_bar();
  weightless.gravity.setZero();
  joint(weightless, "O").velocity = {1};
  still.gravity.setZero();
  for (BodySpec& b : massless.bodies)
    if (b.name == "coupler") {
      b.mass = 0;
      b.inertia.setZero();
    }
  return {"next to nothing",
          {{"no gravity", std::move(weightless), {}},
           {"no motion", std::move(still), {}},
           {"massless coupler", std::move(massless), {}}},
          false};
}
Ladder by_nature() {
  Scene pendulum = built_in(embedded::five_rods(), 10);
  pendulum.bodies.resize(2);
  pendulum.joints.resize(2);
  for (JointSpec& j : pendulum.joints) j.position = {0};
  joint(pendulum, "J1").position = {std::numbers::pi / 4};
  return {"known for it",
          {{"flyball governor", built_in(embedded::governor(), 10), {}},
           {"light cart, 10 s", built_in(embedded::light_cart(), 10), {}},
           {"chaotic double pendulum", std::move(pendulum), {}}},
          false};
}

}  // namespace

std::vector<Ladder> built_in_ladders() {
  return {stiff_pendulum(),
          stiff_loop(),
          damped_loop(),
          weighed("coupler made heavy", embedded::four_bar(), 10, "coupler", upwards),
          weighed("coupler made light", embedded::four_bar(), 10, "coupler", downwards),
          weighed("first of five rods made heavy", embedded::five_rods(), 2, "rod1", upwards),
          weighed("last of five rods made heavy", embedded::five_rods(), 2, "rod5", upwards),
          light_cart(),
          sized("links made small", {1e-2, 1e-4, 1e-6}),
          sized("links made large", {1e2, 1e4, 1e6}),
          spun_loop(),
          spun_top(),
          lasting(),
          long_chains(),
          redundant(),
          singular(),
          trivial(),
          by_nature()};
}

std::vector<Ladder> ladders_of(const Scene& scene, const std::vector<std::string>& along) {
  struct Direction {
    Extreme extreme;
    const char* suffix;
    Factors factors;
  };
  const std::vector<Direction> all{{Extreme::stiffness, "", {1e2, 1e4, 1e6, 1e8}},
                                   {Extreme::damping, "", {1, 1e2, 1e4, 1e6, 1e8}},
                                   {Extreme::mass_ratio, ", up", upwards},
                                   {Extreme::mass_ratio, ", down", downwards},
                                   {Extreme::size, ", up", {1e2, 1e4, 1e6}},
                                   {Extreme::size, ", down", {1e-2, 1e-4, 1e-6}},
                                   {Extreme::speed, "", {10, 1e2, 1e3, 1e4}},
                                   {Extreme::duration, "", {1, 10, 100}}};
  for (const std::string& name : along)
    if (std::none_of(all.begin(), all.end(),
                     [&](const Direction& d) { return name == name_of(d.extreme); }))
      throw std::invalid_argument("--along '" + name +
                                  "' is not known; expected stiffness, damping, mass ratio, size, "
                                  "speed or duration");
  std::vector<Ladder> ladders;
  for (const Direction& d : all) {
    const std::string name = name_of(d.extreme);
    if (!along.empty() && std::find(along.begin(), along.end(), name) == along.end()) continue;
    if (const std::string missing = lacks(scene, d.extreme); !missing.empty()) {
      if (!along.empty())
        throw std::invalid_argument("--along " + name + ": the scene has " + missing +
                                    ", expected one that has");
      continue;
    }
    ladders.push_back(ladder_of(scene, d.extreme, d.factors));
    ladders.back().name = name + d.suffix;
  }
  return ladders;
}

std::vector<Contestant> usual_contestants() {
  std::vector<Contestant> all;
  for (const std::string& form : form_names()) {
    if (form == "acceleration") continue;  // with correction after each step: `projected`
    all.push_back({form, ""});
    if (form == "momentum" || form == "baumgarte") all.push_back({form, "bdf"});
    if (form == "momentum-index2" || form == "stabilised-index2") all.push_back({form, "radau5"});
  }
  // The acceleration forms without loops.
  all.push_back({"acceleration", ""});
  all.push_back({"acceleration", "bdf"});
  return all;
}

}  // namespace momenta::program
