// Families of scenes, printed as TOML: which there are, and those in a plane.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "families.h"
#include "options.h"

namespace momenta::program {
namespace {

void revolute(const char* table, const char* name, int number, const std::string& parent,
              const std::string& child, double x, double y) {
  std::printf("\n[[%s]]\nname = \"%s%d\"\nkind = \"revolute\"\nparent = \"%s\"\nchild = \"%s\"\n",
              table, name, number, parent.c_str(), child.c_str());
  std::printf("origin = { parent = [%.17g, %.17g, 0] }\naxis = [0, 0, 1]\n", x, y);
}

void rod(const std::string& name) {
  std::printf(
      "\n[[body]]\nname = \"%s\"\nmass = 1.0\nshape = { kind = \"rod\", length = 1.0, axis = \"x\" "
      "}\n",
      name.c_str());
}

}  // namespace

void print_chain(int n) {
  std::printf("# A chain of %d uniform rods of 1 m and 1 kg, horizontal, at rest.\n", n);
  std::printf(
      "name = \"Chain of %d rods\"\ngravity = [0.0, -9.81, 0.0]\n\n[run]\nend = 5.0\nsamples = "
      "500\n",
      n);
  for (int i = 1; i <= n; ++i) rod("rod" + std::to_string(i));
  for (int i = 1; i <= n; ++i)
    revolute("joint", "J", i, i == 1 ? "ground" : "rod" + std::to_string(i - 1),
             "rod" + std::to_string(i), i == 1 ? 0 : 1, 0);
  std::printf("\n[[marker]]\nname = \"tip\"\nbody = \"rod%d\"\npoint = [1.0, 0.0, 0.0]\n", n);
}

/// 2N + 1 rods: verticals hinged to ground at (i, 0), horizontals joining their tops. Tree: ground
/// - vertical 0 - horizontal 1, and every other vertical on the ground, carrying the next
/// horizontal; N loops close at the far ends.
void print_n_four_bar(int n) {
  const double up = std::acos(0.0);
  std::printf(
      "# %d four-bars in a row: %d rods of 1 m and 1 kg. All rods lie on one line twice a turn.\n",
      n, 2 * n + 1);
  std::printf("name = \"N-four-bar, N = %d\"\ngravity = [0.0, -9.81, 0.0]\n", n);
  std::printf(
      "\n[run]\nend = 10.0\nleak = 3.0\nsamples = 1000\nproject = true   # passes singular "
      "poses\n");
  for (int i = 0; i <= n; ++i) {
    rod("vertical" + std::to_string(i));
    if (i > 0) rod("horizontal" + std::to_string(i));
  }
  for (int i = 0; i <= n; ++i) {
    const std::string vertical = "vertical" + std::to_string(i);
    revolute("joint", "O", i, "ground", vertical, i, 0);
    std::printf("position = %.17g\nvelocity = -1.0\n", up);
    if (i == n) break;
    revolute("joint", "B", i, vertical, "horizontal" + std::to_string(i + 1), 1, 0);
    std::printf("position = %.17g\nvelocity = 1.0\n", -up);
  }
  for (int i = 1; i <= n; ++i)
    std::printf(
        "\n[[loop]]\nname = \"C%d\"\nkind = \"revolute\"\nparent = \"vertical%d\"\nchild = "
        "\"horizontal%d\"\n"
        "origin = { parent = [1.0, 0.0, 0.0], child = [1.0, 0.0, 0.0] }\naxis = [0, 0, 1]\n",
        i, i, i);
  std::printf("\n[[marker]]\nname = \"B0\"\nbody = \"vertical0\"\npoint = [1.0, 0.0, 0.0]\n");
}

std::span<const Family> families() {
  // A scene file holds at most 4 million values.
  constexpr int many = 100'000, more = 1'000'000;
  static constexpr std::array all{
      Family{"chain", "N rods of 1 m in a plane, level", 1, more, 10, print_chain},
      Family{"random-chain", "N blocks on pins at random", 1, many, 10, print_random_chain},
      Family{"rope", "N links of 0.1 m, pinned across by turns", 1, many, 10, print_rope},
      Family{"spherical-chain", "N links on ball joints", 1, many, 10, print_spherical_chain},
      Family{"tree", "binary, N bodies on pins", 1, many, 10, print_tree},
      Family{"star", "a free ball with N legs of six pins", 1, many / 5, 10, print_star},
      Family{"humanoid", "a free pelvis and 30 hinges", 30, 30, 30, print_humanoid},
      Family{"n-four-bar", "N four-bars in a row", 1, more, 10, print_n_four_bar},
  };
  return all;
}

int make(const std::string& family, std::optional<int> n) {
  const auto all = families();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Family& f) { return family == f.name; });
  if (found == all.end()) {
    std::string names;
    for (const Family& f : all) names += (names.empty() ? "" : ", ") + std::string(f.name);
    throw std::invalid_argument("family '" + family.substr(0, 60) + "' is not known; expected " +
                                names);
  }
  const int size = n.value_or(found->usual);
  if (size < found->least || size > found->most)
    throw std::invalid_argument(
        "family '" + family + "' (" + found->what + "): found --n " + std::to_string(size) +
        ", expected " +
        (found->least == found->most
             ? std::to_string(found->least) + ", its number of hinges, or no --n"
             : std::to_string(found->least) + " to " + std::to_string(found->most)));
  found->print(size);
  return done;
}

}  // namespace momenta::program
