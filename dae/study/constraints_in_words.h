#pragma once
// The constraints that the equations of each form put on its unknowns, in words, in the order in
// which differentiation finds them. Their numbers come independently from the derivative array
// (dae/measure/derivative_array.h); a test compares the two counts.

#include <string>
#include <vector>

namespace momenta {

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

struct FormInWords {
  std::string x, s;        ///< symbols of the second block of unknowns and of its multipliers
  std::string solved;      ///< ODE forms: system solved at each evaluation
  bool penalised = false;  ///< ODE forms: with M + Φ_qᵀαΦ_q in place of (M Φ_qᵀ; Φ_q 0)
  std::vector<Constraint> constraints;
};

/// Words for a form; empty for an unknown one.
FormInWords in_words(const std::string& form);

const char* name_of(Constraint::Origin origin);

}  // namespace momenta
