// The verb `make`: the list of families of scenes, printed as TOML.

#include <algorithm>
#include <array>

#include "families.h"
#include "verb.h"

namespace momenta::program {

std::span<const Family> families() {
  // A scene file holds at most 4 million values.
  constexpr int many = 100'000, more = 1'000'000;
  static constexpr std::array all{
      Family{"chain", "N rods of 1 m in a plane, level", 1, more, 10, nullptr, print_chain},
      Family{"random-chain", "N blocks on revolute joints at random", 1, many, 10,
             print_random_chain},
      Family{"rope", "N links of 0.1 m, pinned across by turns", 1, many, 10, print_rope},
      Family{"spherical-chain", "N links on spherical joints", 1, many, 10, print_spherical_chain},
      Family{"tree", "binary, N bodies on revolute joints", 1, many, 10, print_tree},
      Family{"star", "a free sphere with N legs of six revolute joints", 1, many / 5, 10,
             print_star},
      Family{"humanoid", "a free pelvis and 30 hinges", 30, 30, 30, print_humanoid},
      Family{"n-four-bar", "N four-bars in a row", 1, more / 10, 10, nullptr, print_n_four_bar},
      Family{"scissor-ladder", "N pairs of crossed bars", 2, more / 10, 10, nullptr,
             print_scissor_ladder},
      Family{"closed-chain", "N rods between two fixed points", 3, more / 2, 10, nullptr,
             print_closed_chain},
      Family{"grid", "N rows of N hanging parallelograms", 1, 250, 5, nullptr, print_grid},
      Family{"jansen-legs", "N walking legs on one crank", 1, many / 10, 2, nullptr,
             print_jansen_legs},
      Family{"stewart", "a platform on N sprung legs", 3, many / 10, 6, print_stewart},
  };
  return all;
}

namespace {

int make(const std::string& family, std::optional<int> n, bool turned) {
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
  if (turned && found->print)
    throw std::invalid_argument(
        "family '" + family + "' (" + found->what +
        "): found --turned, which is for planar mechanisms alone, expected it "
        "there");
  if (found->print)
    found->print(size);
  else
    found->print_in(size, turned ? Plane{{0.3, -0.5, 0.7}} : Plane{});
  return done;
}

}  // namespace

Verb declare_make(CLI::App& app, Options&) {
  struct Arguments {
    std::string family;
    std::optional<int> n;
    bool turned = false;
  };
  const auto own = std::make_shared<Arguments>();
  CLI::App& verb = add_verb(app, "make", "Prints a scene of a family",
                            "momenta make stewart --n 6 > stewart.toml");
  verb.add_option("family", own->family, "Which mechanism")->required()->type_name("FAMILY");
  verb.add_option("--n", own->n, "Size (each family has its own default)")->type_name("N");
  verb.add_flag("--turned", own->turned, "Planar families: in a plane oblique to all axes");
  return {&verb, [own] { return make(own->family, own->n, own->turned); }};
}

}  // namespace momenta::program
