#pragma once
// A system without bodies: coordinates, a Lagrangian, forces and constraints as formulas. Plain
// data, as its author wrote it.

#include <momenta/core/scene/location.h>

#include <string>
#include <vector>

namespace momenta {

/// A formula as text (core/expression/expression.h).
struct FormulaSpec {
  std::string text;  ///< empty: none
  Location at;       ///< place of its opening quote in the file
};

/// d/dt ∂L/∂q̇ − ∂L/∂q = Q − Φ_qᵀλ, Φ(q, t) = 0. Formulas name coordinates, rates `x.dot`, the time
/// `t` and the scene's parameters.
struct LagrangianSpec {
  /// A coordinate and its start, a first guess where there are constraints.
  struct Coordinate {
    std::string name;     ///< name in formulas
    std::string unit;     ///< for columns and axes; any text
    double position = 0;  ///< at the start [unit]
    double velocity = 0;  ///< at the start [unit/s]
  };
  /// A generalised force: Q times the rate of its coordinate is its power.
  struct Force {
    std::string coordinate;  ///< coordinate on which it acts
    FormulaSpec value;       ///< Q of q, q̇, t [J/unit]
    Location at;             ///< where the file has it
  };
  /// A holonomic constraint Φ(q, t) = 0.
  struct Constraint {
    std::string name;      ///< name of its multipliers
    FormulaSpec equation;  ///< Φ
    bool angle = false;    ///< Φ is an angle [rad], else a length [m]
    Location at;           ///< where the file has it
  };

  std::vector<Coordinate> coordinates;  ///< at least one
  FormulaSpec lagrangian;     ///< L, quadratic in the rates; empty where the next two are given
  FormulaSpec kinetic;        ///< T: L = T − V
  FormulaSpec potential;      ///< V; empty: 0
  std::vector<Force> forces;  ///< at most one for each coordinate
  std::vector<Constraint> constraints;  ///< in the order of Φ
  Location at;                          ///< where the file has it
};

}  // namespace momenta
