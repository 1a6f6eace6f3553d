#pragma once
// The formulas of a Lagrangian, read. Their variables are
//
//   q_0 … q_(n−1),  q̇_0 … q̇_(n−1),  t,  the parameters of the scene.

#include <momenta/core/expression/expression.h>
#include <momenta/core/scene/scene.h>

#include <optional>
#include <string>
#include <vector>

namespace momenta {

struct LagrangianFormulas {
  /// @pre the scene has a Lagrangian. @throws SceneError: the place, the formula and its fault
  explicit LagrangianFormulas(const Scene& scene);

  /// The name of a coordinate's rate in formulas.
  static std::string rate_name(const std::string& coordinate) { return coordinate + ".dot"; }

  std::vector<std::string> names;  ///< names of the variables
  std::optional<Expression> lagrangian, kinetic, potential;
  std::vector<Expression> forces, constraints, events;  ///< in the order of the scene
  std::vector<bool> uses_parameter;                     ///< by parameter of the scene
};

}  // namespace momenta
