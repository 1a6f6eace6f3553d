#pragma once
// Four bodies of any masses, without joints: "a", "b", "d", "e".

#include <string>

namespace momenta::equations {

inline const std::string four_bodies = R"toml(
[[body]]
name = "a"
mass = 2
com = [0.1, 0.2, -0.1]
inertia = [0.3, 0.4, 0.5, 0.02, 0.01, -0.03]
[[body]]
name = "b"
mass = 1
com = [0.2, 0, 0.1]
inertia = [0.2, 0.3, 0.25]
[[body]]
name = "d"
mass = 1.5
com = [0, 0.3, 0]
inertia = [0.1, 0.2, 0.15]
[[body]]
name = "e"
mass = 0.7
com = [0, 0.1, 0.2]
inertia = [0.1, 0.1, 0.05]
)toml";

}  // namespace momenta::equations
