#pragma once
// Scenes of examples/ in the program, for `momenta stress` without a scene.

#include <string_view>

namespace momenta::embedded {

std::string_view four_bar();
std::string_view slider_crank();
std::string_view n_four_bar();
std::string_view bricard();
std::string_view spring_pendulum();
std::string_view governor();
std::string_view heavy_top();
std::string_view five_rods();
std::string_view light_cart();
std::string_view three_cranks();

}  // namespace momenta::embedded
