#pragma once
// Formulas of neighbouring scenes. A formula f(x; θ) that a run evaluates, of a force, a drive, a
// loop, a Lagrangian, is known as a formula of θ too, so that its derivative is exact (core/
// expression/gradient.cpp): in the scene of θ + d,
//
//   f(x; θ) + d ∂f/∂θ (x; θ)
//
// takes its place, whose differences have ∂f/∂θ to rounding however often f turns between θ and
// θ + d, and wherever it has corners: of abs, max, if(…) that of the piece which x is on at θ.

#include <momenta/core/expression/expression.h>
#include <momenta/core/scene/scene.h>

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace momenta {

/// Any name is a variable by its own name.
class AnyNames final : public FormulaNames {
 public:
  /// Variables are numbered in this order, others follow.
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

/// Of scenes at θ + k h, in the order of sixth_order::points, `own` that of θ: all formulas in
/// which they differ, laws of drives of every kind but tables among them. Those stay that call
/// functions by points of what θ changes. O(text) for each
void make_formulas_linear(const Scene& own, double h, std::vector<Scene>& near);

}  // namespace momenta
