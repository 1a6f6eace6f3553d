#pragma once
// A system whose L, Q and Φ are one class of the user, each a template over its number type:
//
//   struct Bead {
//     double m = 1, g = 9.81, c = 0.1;
//     template <class S> S lagrangian(const S* q, const S* v, const S& t) const;
//     template <class S> void forces(const S* q, const S* v, const S& t, S* tau) const;   // optional
//     template <class S> void constraints(const S* q, const S& t, S* phi) const;          // optional
//   };
//
// The class is called once, with numbers that record operations (core/expression/traced.h): the
// result is a Lagrangian of formulas, as if typed, to the last bit where no definitions were
// needed; it may be written to a file.

#include <momenta/core/expression/traced.h>
#include <momenta/core/scene/lagrangian.h>

#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// The Lagrangian of a class as above. `coordinates` are those of q, in order, with units and
/// start. `constraints`: name and kind (angle or length) of each value of system.constraints(), in
/// order; `equation` is not read. tau and phi come zeroed; a force that stays 0 is none. @throws
/// std::logic_error: a constraint and a class without constraints(), or the reverse. Other checks
/// are those of validate() and Mechanism. One call of each function, O(tape)
template <class System>
LagrangianSpec lagrangian_of(const System& system,
                             std::vector<LagrangianSpec::Coordinate> coordinates,
                             std::vector<LagrangianSpec::Constraint> constraints = {});

/// Whether a class has forces, or constraints, as above.
template <class System>
concept WithForces = requires(const System& s, const Traced* x, Traced* y) {
  s.forces(x, x, *x, y);
};
template <class System>
concept WithConstraints = requires(const System& s, const Traced* x, Traced* y) {
  s.constraints(x, *x, y);
};

/// The names of q, q̇ and t in formulas.
std::vector<std::string> formula_names(const std::vector<LagrangianSpec::Coordinate>& coordinates);
/// Refuses constraints without names or functions. @throws std::logic_error
void expect_constraints(bool has_function, std::size_t names);

template <class System>
LagrangianSpec lagrangian_of(const System& system,
                             std::vector<LagrangianSpec::Coordinate> coordinates,
                             std::vector<LagrangianSpec::Constraint> constraints) {
  expect_constraints(WithConstraints<System>, constraints.size());
  const std::size_t n = coordinates.size();
  const std::vector<Traced> x = Traced::variables(2 * static_cast<int>(n) + 1);  // q, q̇, t
  const Traced* const q = x.data();
  const Traced *const v = q + n, *const t = v + n;
  LagrangianSpec spec;
  const std::vector<std::string> names = formula_names(coordinates);
  const Traced lagrangian = system.lagrangian(q, v, *t);
  spec.lagrangian.text = lagrangian.text(names);
  if constexpr (WithForces<System>) {
    std::vector<Traced> tau(n);
    system.forces(q, v, *t, tau.data());
    for (std::size_t i = 0; i < n; ++i)
      if (!tau[i].is(0)) spec.forces.push_back({coordinates[i].name, {tau[i].text(names), {}}, {}});
  }
  if constexpr (WithConstraints<System>) {
    std::vector<Traced> phi(constraints.size());
    system.constraints(q, *t, phi.data());
    for (std::size_t i = 0; i < phi.size(); ++i) constraints[i].equation.text = phi[i].text(names);
  }
  spec.coordinates = std::move(coordinates);
  spec.constraints = std::move(constraints);
  return spec;
}

}  // namespace momenta
