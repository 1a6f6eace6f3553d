#pragma once
// Families of `momenta make` by how many bodies they have, and their texts.

#include <array>
#include <cmath>
#include <cstdio>
#include <span>
#include <stdexcept>
#include <string>

namespace momenta::benchmark_models {

struct Family {
  const char* name;
  int (*size)(int bodies);  ///< N of `momenta make` for about so many bodies
};
inline constexpr std::array families{
    Family{"n-four-bar", [](int bodies) { return (bodies - 1) / 2; }},
    Family{"scissor-ladder", [](int bodies) { return bodies / 2; }},
    Family{"closed-chain", [](int bodies) { return bodies; }},
    Family{
        "grid",
        [](int bodies) { return static_cast<int>(std::lround(std::sqrt(bodies / 2.0) - 0.25)); }},
    Family{"chain", [](int bodies) { return bodies; }},
    Family{"tree", [](int bodies) { return bodies; }},
};

inline constexpr std::span families_with_loops = std::span(families).first<4>();

/// The text of `momenta make`. @throws std::runtime_error where the program fails
inline std::string made_scene(const std::string& family, int n) {
  const std::string command =
      std::string("'") + MOMENTA_PROGRAM + "' make " + family + " --n " + std::to_string(n);
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) throw std::runtime_error(command + " cannot be run");
  std::string text;
  std::array<char, 65536> part{};
  for (std::size_t size; (size = fread(part.data(), 1, part.size(), pipe)) > 0;)
    text.append(part.data(), size);
  if (pclose(pipe) != 0) throw std::runtime_error(command + " failed");
  return text;
}

}  // namespace momenta::benchmark_models
