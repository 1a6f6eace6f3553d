// Families of scenes, printed as TOML.

#include <cmath>
#include <cstdio>

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

int chain(int n) {
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
  return done;
}

/// 2N + 1 rods: verticals hinged to ground at (i, 0), horizontals joining their tops. Tree: ground
/// - vertical 0 - horizontal 1, and every other vertical on the ground, carrying the next
/// horizontal; N loops close at the far ends.
int n_four_bar(int n) {
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
  return done;
}

}  // namespace

int make(const std::string& family, int n) {
  return family == "chain" ? chain(n) : n_four_bar(n);
}

}  // namespace momenta::program
