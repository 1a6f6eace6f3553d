#pragma once
// A solution of a file of equations in quadruple precision, for references: collocation of Radau
// IIA with nine stages (solver/radau_dae_collocation.h), from a start that is consistent to the
// last digits too. Numbers of the file stay the doubles that they are read as. Two tolerances give
// an estimate of the error.

#include <momenta/core/scalar/quad.h>
#include <momenta/dae/analysis/equations/equation_start.h>

#include <functional>
#include <string>
#include <vector>

namespace momenta {

struct QuadReference {
  double t = 0;
  std::vector<Quad> values;
  std::vector<double> apart;  ///< by variable: distance of the two solutions over scale + |value|
  double accuracy = 0;        ///< largest of apart over the judged variables
  long steps = 0;             ///< at the tighter tolerance
};

/// The solution at `t`. `going_on` (may be empty) takes the time reached; false stops. @throws
/// std::runtime_error with one sentence
QuadReference quad_reference(const EquationFile& file, const EquationStart& start, double t,
                             const std::function<bool(double)>& going_on = {});

/// y and y' at the start, consistent with hidden constraints to quadruple precision. @throws
/// std::runtime_error
void refine_start(const EquationFile& file, const EquationStart& start, std::vector<Quad>& y,
                  std::vector<Quad>& ydot);

/// `x` in decimals: "1.15079492066170241032e-1".
std::string decimals_of(const Quad& x, int digits);

}  // namespace momenta
