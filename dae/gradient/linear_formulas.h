#pragma once
// Formulas of neighbouring scenes. A formula f(x; θ) of a force, a drive, a loop or a Lagrangian is
// a formula of θ too, with an exact derivative (core/expression/gradient.cpp): in the scene of θ +
// d,
//
//   f(x; θ) + d ∂f/∂θ (x; θ)
//
// takes its place. Differences then have ∂f/∂θ to rounding, however often f turns between θ and θ +
// d. At corners of abs, max, if(…) the piece is that of x at θ.

#include <momenta/core/expression/expression.h>
#include <momenta/core/scene/scene.h>

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace momenta {

/// Names for a parser: any name is a variable.
class AnyNames final : public FormulaNames {
 public:
  /// Known names are numbered in this order, others follow.
  explicit AnyNames(std::vector<std::string> known = {}) : names(std::move(known)) {
    for (std::size_t i = 0; i < names.size(); ++i) places_.emplace(names[i], static_cast<int>(i));
  }
  std::optional<Meaning> meaning(std::string_view name, std::size_t) override {
    const auto [found, is_new] = places_.emplace(name, static_cast<int>(names.size()));
    if (is_new) names.emplace_back(name);
    return Meaning{found->second, 0};
  }
  std::string expected(std::string_view) const override { return ""; }
  std::vector<std::string> names;

 private:
  std::unordered_map<std::string, int> places_;
};

/// Makes linear all formulas in which scenes at θ + k h differ, laws of drives but tables among
/// them; order of sixth_order::points, `own` that of θ. Formulas that call functions by points of
/// what θ changes stay. O(text) for each
void make_formulas_linear(const Scene& own, double h, std::vector<Scene>& near);

}  // namespace momenta
