#pragma once
// What the file of a form says of it, for options, studies, pages and `momenta check`: its kind,
// the constraints that its equations put on its unknowns, in words, and how it is made. form.cpp
// lists all forms.

#include <momenta/dae/form/form.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace momenta {

/// A constraint, in the order in which differentiation finds them. The number of its equations
/// comes independently from the derivative array (dae/run/measure/derivative_array.h); a test
/// compares the two counts.
struct Constraint {
  enum class Origin {
    given,     ///< stands in the equations, ν = 0
    hidden,    ///< shown by ν ≥ 1 differentiations
    invariant  ///< kept by solutions, asked by no equation: the start alone sees to it
  };
  Origin origin = Origin::given;
  int differentiations = 0;            ///< least ν that shows it
  int per_rate = 0, per_loop_row = 0;  ///< equations: per_rate · nv + per_loop_row · m
  std::string equation;
  std::string gives;  ///< the unknown it determines; empty: none
};
const char* name_of(Constraint::Origin origin);

inline Constraint given(const std::string& equation, const std::string& gives = "") {
  return {Constraint::Origin::given, 0, 0, 1, equation, gives};
}
inline Constraint hidden(int differentiations, const std::string& equation,
                         const std::string& gives) {
  return {Constraint::Origin::hidden, differentiations, 0, 1, equation, gives};
}
inline Constraint invariant(const std::string& equation) {
  return {Constraint::Origin::invariant, 0, 0, 1, equation, ""};
}

/// Equations of constraints that several forms have.
namespace equation {
inline constexpr const char* positions = "Φ(q, t) = 0";
inline constexpr const char* velocities = "Φ̇ = Φ_q v + Φ_t = 0";
inline constexpr const char* rates = "Φ̇ = Φ_q u + Φ_t = 0";
inline constexpr const char* accelerations = "Φ̈ = Φ_q v̇ + Φ̇_q v + Φ̇_t = 0 with v̇ from (1a)";
inline constexpr const char* of_momenta = "Φ̇ = Φ_q M⁻¹(p − Φ_qᵀσ) + Φ_t = 0";
inline constexpr const char* of_stabilised = "Φ̇ = Φ_q(v − Φ_qᵀμ) + Φ_t = 0, that is Φ_qΦ_qᵀμ = 0";
}  // namespace equation

struct FormInWords {
  std::string x = {}, s = {};  ///< symbols of the second block of unknowns and of its multipliers
  std::string solved = {};     ///< ODE forms: system solved at each evaluation
  bool penalised = false;  ///< ODE forms: with M + Φ_qᵀαΦ_q in place of (M Φ_qᵀ; Φ_q 0)
  std::vector<Constraint> constraints = {};
};
/// `solved` of augmented Lagrangians.
inline constexpr const char* penalised_mass = "M + Φ_qᵀαΦ_q, regular whatever the rank of Φ_q";

struct FormEntry {
  enum class Kind { ode, ode_one_step, dae };

  std::string name;
  Kind kind = Kind::ode;
  bool impulses = false;   ///< σ among its unknowns or solved for: takes a gauge
  bool positions = false;  ///< Φ = 0 among its equations, or met after each step
  bool bearings = false;  ///< u̇ and forces of loops are found, as friction by reaction needs them
  /// Whether it has index lower by one where rows A u = b stand in place of all of Φ = 0.
  bool lower_on_rates = false;
  /// Colour of its curves on all pages; negative: one that is free.
  int colour = -1;
  /// Its place where forms choose colours: the first of a colour has it alone.
  int place = 100;
  FormInWords words = {};
  std::function<std::unique_ptr<Form>(const Mechanism&, const FormOptions&, const Start&)> make =
      {};

  /// Differentiation index; 0: an ODE.
  int index() const;
};

/// `make` of a form of this class.
template <class Made>
std::unique_ptr<Form> made(const Mechanism& mechanism, const FormOptions& options,
                           const Start& start) {
  return std::make_unique<Made>(mechanism, options, start);
}

/// All forms, in the order of the tables.
const std::vector<FormEntry>& all_forms();
/// Null for an unknown name.
const FormEntry* find_form(const std::string& name);

}  // namespace momenta
