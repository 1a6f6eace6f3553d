#pragma once
// A solution of a file of equations in quadruple precision, for references: collocation of Radau
// IIA with nine stages (solver/radau_dae_collocation.h), from a start that is consistent to the
// last digits too. Numbers of the file stay the doubles that they are read as. Two tolerances give
// an estimate of its error.

#include <momenta/core/scalar/quad.h>
#include <momenta/dae/equations/equation_start.h>

#include <functional>
#include <string>
#include <vector>

namespace momenta {

struct QuadReference {
  double t = 0;
  std::vector<Quad> values;
  std::vector<double> apart;  ///< of each, distance of the two solutions over scale + |value|
  double accuracy = 0;        ///< the largest of them in what is judged
  long steps = 0;             ///< of the tighter one
};

/// At `t`. `going_on` (may be empty) is told the time reached; false ends it. @throws
/// std::runtime_error with one sentence where it cannot be had.
QuadReference quad_reference(const EquationFile& file, const EquationStart& start, double t,
                             const std::function<bool(double)>& going_on = {});

/// y and y' at the start with the residuals of hidden constraints at rounding of quadruple
/// precision. @throws std::runtime_error
void refine_start(const EquationFile& file, const EquationStart& start, std::vector<Quad>& y,
                  std::vector<Quad>& ydot);

/// Digits of a number of quadruple precision: "1.15079492066170241032e-1".
std::string decimals_of(const Quad& x, int digits);

}  // namespace momenta
